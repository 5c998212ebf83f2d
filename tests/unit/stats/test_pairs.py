"""Tukey's HSD and Games–Howell against R's published output, scipy, and closed forms."""

from decimal import Decimal

import numpy as np
import pytest
from scipy import stats

from benchlab.stats.groups import groups_of, groups_of_summaries
from benchlab.stats.measurements import measurements_of
from benchlab.stats.pairs import Pair, games_howell, tukey
from benchlab.stats.wording import stars
from tests.unit.stats.samples import INSECT_SPRAYS, PLANT_GROWTH, WARP_BREAKS, grouped

# R: TukeyHSD(aov(weight ~ group, PlantGrowth)), diff lwr upr p adj
PLANT_GROWTH_R = {
    ("trt1", "ctrl"): (-0.371, -1.0622161, 0.3202161, 0.3908711),
    ("trt2", "ctrl"): (0.494, -0.1972161, 1.1852161, 0.1979960),
    ("trt2", "trt1"): (0.865, 0.1737839, 1.5562161, 0.0120064),
}
# R: TukeyHSD(aov(breaks ~ tension, warpbreaks))
WARP_BREAKS_R = {
    ("M", "L"): (-10.000000, -19.55982, -0.4401756, 0.0384598),
    ("H", "L"): (-14.722222, -24.28205, -5.1623978, 0.0014315),
    ("H", "M"): (-4.722222, -14.28205, 4.8376022, 0.4630831),
}
# R: TukeyHSD(aov(count ~ spray, InsectSprays))
INSECT_SPRAYS_R = {
    ("B", "A"): (0.8333333, -3.866075, 5.532742, 0.9951810),
    ("C", "A"): (-12.4166667, -17.116075, -7.717258, 0.0000000),
    ("D", "A"): (-9.5833333, -14.282742, -4.883925, 0.0000014),
    ("F", "A"): (2.1666667, -2.532742, 6.866075, 0.7542147),
    ("D", "B"): (-10.4166667, -15.116075, -5.717258, 0.0000002),
    ("D", "C"): (2.8333333, -1.866075, 7.532742, 0.4920707),
    ("E", "C"): (1.4166667, -3.282742, 6.116075, 0.9488669),
    ("E", "D"): (-1.4166667, -6.116075, 3.282742, 0.9488669),
}


@pytest.mark.parametrize(
    ("data", "published"),
    [(PLANT_GROWTH, PLANT_GROWTH_R), (WARP_BREAKS, WARP_BREAKS_R), (INSECT_SPRAYS, INSECT_SPRAYS_R)],
    ids=["PlantGrowth", "warpbreaks", "InsectSprays"],
)
def test_as_r_prints_them(data: dict[str, str], published: dict[tuple[str, str], tuple[float, ...]]) -> None:
    found = {(pair.b, pair.a): pair for pair in tukey(grouped(data))}
    assert len(found) == len(data) * (len(data) - 1) // 2
    for names, (difference, low, high, p) in published.items():
        pair = found[names]
        assert pair.difference == pytest.approx(difference, abs=6e-7)
        assert (pair.low, pair.high) == (pytest.approx(low, abs=6e-6), pytest.approx(high, abs=6e-6))
        assert pair.p == pytest.approx(p, abs=6e-8)


@pytest.mark.parametrize(("test", "equal"), [(tukey, True), (games_howell, False)])
@pytest.mark.parametrize("confidence", [0.95, 0.99])
def test_unbalanced_groups_as_scipy_finds_them(test, equal: bool, confidence: float) -> None:
    rng = np.random.default_rng(3)
    data = [rng.normal(m, s, n) for m, s, n in ((10, 1, 3), (11, 2, 8), (13, 0.5, 5))]
    names = [str(i) for i, row in enumerate(data) for _ in row]
    groups = groups_of(measurements_of(names, np.concatenate(data).tolist()))
    reference = stats.tukey_hsd(*data, equal_var=equal)
    interval = reference.confidence_interval(confidence)
    for pair in test(groups, confidence):
        a, b = int(pair.a), int(pair.b)
        assert pair.difference == pytest.approx(reference.statistic[b, a], rel=1e-12)
        assert pair.p == pytest.approx(reference.pvalue[b, a], rel=1e-7, abs=1e-12)
        assert pair.low == pytest.approx(interval.low[b, a], rel=1e-6)
        assert pair.high == pytest.approx(interval.high[b, a], rel=1e-6)


def test_two_groups_are_students_and_welchs_t() -> None:
    a, b = [4.1, 5.0, 4.6, 5.2], [6.0, 7.9, 5.1, 6.6, 9.0]
    groups = groups_of(measurements_of(["a"] * 4 + ["b"] * 5, a + b))
    for test, equal in ((tukey, True), (games_howell, False)):
        (pair,) = test(groups)
        reference = stats.ttest_ind(b, a, equal_var=equal)
        interval = reference.confidence_interval()
        assert pair.p == pytest.approx(reference.pvalue, rel=1e-9) and pair.df == pytest.approx(reference.df)
        assert (pair.low, pair.high) == (pytest.approx(interval.low), pytest.approx(interval.high))


def test_the_papers_slw_set_has_three_stars_where_its_figure_shows_four() -> None:
    """Table I, tw 3: 110.2 ± 1.9, 125.7 ± 4.0, 60.3 ± 3.6 with n 5: the pair 5–10 has p = 2.2e-5."""
    means = [Decimal("110.2"), Decimal("125.7"), Decimal("60.3")]
    found = tukey(groups_of_summaries(["5", "10", "20"], [5] * 3, means, [1.9, 4.0, 3.6]))
    assert [pair.difference for pair in found] == pytest.approx([15.5, -49.9, -65.4])
    assert found[0].p == pytest.approx(2.2e-5, abs=5e-7) and stars(found[0].p) == "***"
    assert [stars(pair.p) for pair in found[1:]] == ["****", "****"]
    assert all(pair.p_below is None for pair in found)


def test_a_probability_below_what_can_be_known_says_so() -> None:
    """Designs of the paper, had it made 25 samples of each."""
    means = [Decimal("125.7"), Decimal("56.7"), Decimal("60.3")]
    found = tukey(groups_of_summaries(["10", "15", "20"], [25] * 3, means, [4.0, 2.9, 3.6]))
    assert [pair.p_below for pair in found] == [1e-13, 1e-13, None]


def test_order_shift_and_scale() -> None:
    names, values = ["a"] * 3 + ["b"] * 4 + ["c"] * 3, [1.0, 2.5, 2, 4, 5, 4.5, 7, 3, 2, 4]
    base = _by_name(tukey(groups_of(measurements_of(names, values))))
    turned = _by_name(tukey(groups_of(measurements_of(names[::-1], values[::-1]))))
    scaled = _by_name(tukey(groups_of(measurements_of(names, [1000 + 2 * x for x in values]))))
    for (a, b), pair in base.items():
        other, wide = turned[b, a], scaled[a, b]
        assert other.difference == pytest.approx(-pair.difference) and other.p == pytest.approx(pair.p)
        assert (other.low, other.high) == (pytest.approx(-pair.high), pytest.approx(-pair.low))
        assert wide.low == pytest.approx(2 * pair.low) and wide.p == pytest.approx(pair.p)
        assert wide.g == pytest.approx(pair.g) and wide.g_low == pytest.approx(pair.g_low)


def test_a_pair_without_a_test_says_why() -> None:
    groups = groups_of(measurements_of([*list("aabbcc"), "d"], [1, 1, 2, 2, 3, 4, 9]))
    found = _by_name(games_howell(groups))
    assert found["a", "b"].reason == "no scatter in either group" and found["a", "b"].p is None
    assert found["a", "d"].reason == "one sample in d" and found["c", "d"].low is None
    assert found["a", "c"].p is not None and found["a", "c"].reason is None
    flat = tukey(groups_of(measurements_of(list("aabb"), [1, 1, 2, 2])))
    assert flat[0].reason == "no group has any scatter" and flat[0].difference == 1 and flat[0].g is None


def _by_name(pairs: tuple[Pair, ...]) -> dict[tuple[str, str], Pair]:
    return {(pair.a, pair.b): pair for pair in pairs}
