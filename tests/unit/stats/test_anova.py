"""Fisher's and Welch's ANOVA against R's published output, scipy, and the paper's Table I."""

from decimal import Decimal

import numpy as np
import pytest
from scipy import stats

from benchlab.stats.anova import one_way, welch
from benchlab.stats.groups import Group, groups_of, groups_of_summaries
from benchlab.stats.measurements import measurements_of
from tests.unit.stats.samples import INSECT_SPRAYS, PLANT_GROWTH, grouped


def test_plant_growth_as_r_prints_it() -> None:
    """R: summary(aov(weight ~ group, PlantGrowth)); oneway.test(weight ~ group, PlantGrowth)."""
    groups = grouped(PLANT_GROWTH)
    found, of_welch = one_way(groups), welch(groups)
    assert found.df == (2, 27)
    assert round(found.ss_between, 5) == 3.76634 and round(found.ss_within, 5) == 10.49209
    assert found.F is not None and found.p is not None and of_welch.F is not None and of_welch.df is not None
    assert (round(found.F, 3), round(found.p, 4)) == (4.846, 0.0159)
    assert (round(of_welch.F, 3), round(of_welch.df[1], 3)) == (5.181, 17.128)
    assert of_welch.p == pytest.approx(0.01739, abs=5e-6)


def test_effect_sizes_of_plant_growth() -> None:
    """η² 3.76634 / 14.25843 (rstatix::anova_test: ges 0.264); ω² (3.76634 − 2·0.388596)/(14.25843 + 0.388596); ends of the interval at
    which the noncentral F puts 2.5 % on either side."""
    found = one_way(grouped(PLANT_GROWTH))
    assert found.eta_squared is not None and found.omega_squared is not None and found.interval is not None
    assert (round(found.eta_squared, 3), round(found.omega_squared, 4)) == (0.264, 0.2041)
    for share, below in zip(found.interval, (0.975, 0.025)):
        assert stats.ncf.cdf(found.F, 2, 27, 30 * share / (1 - share)) == pytest.approx(below, rel=1e-6)


def test_insect_sprays_as_r_prints_them() -> None:
    """R: summary(aov(count ~ spray, InsectSprays)); oneway.test(count ~ spray, InsectSprays)."""
    groups = grouped(INSECT_SPRAYS)
    assert round(one_way(groups).F or 0, 1) == 34.7
    found = welch(groups)
    assert pytest.approx(36.0654, abs=5e-5) == found.F and found.df is not None
    assert found.df[1] == pytest.approx(30.043, abs=5e-4) and found.p == pytest.approx(7.999e-12, rel=1e-3)


@pytest.mark.parametrize("seed", range(4))
def test_unbalanced_groups_as_scipy_finds_them(seed: int) -> None:
    rng = np.random.default_rng(seed)
    data = [rng.normal(mean, sd, n) for mean, sd, n in zip((10, 11, 13, 12), (1, 2, 0.5, 4), rng.integers(2, 9, 4))]
    groups = _groups(data)
    for found, reference in (
        (one_way(groups), stats.f_oneway(*data)),
        (welch(groups), stats.f_oneway(*data, equal_var=False)),
    ):
        assert pytest.approx(reference.statistic, rel=1e-10) == found.F
        assert found.p == pytest.approx(reference.pvalue, rel=1e-8)


def test_the_papers_table() -> None:
    """Means and SDs of five samples each, Table I. From them: F(4, 20) = 529.46, p = 5.6e-20."""
    mean = [Decimal(x) for x in ("110.2", "125.7", "60.3", "79.9", "56.7")]
    groups = groups_of_summaries("abcde", [5] * 5, mean, [1.9, 4.0, 3.6, 1.7, 2.9])
    found, of_welch = one_way(groups), welch(groups)
    assert found.F is not None and of_welch.F is not None and of_welch.df is not None
    assert (round(found.F, 2), found.df) == (529.46, (4, 20))
    assert found.p == pytest.approx(5.6e-20, rel=0.02)
    assert round(found.eta_squared or 0, 3) == 0.991
    assert (round(of_welch.F, 1), round(of_welch.df[1], 2)) == (439.5, 9.75)
    assert round(found.ms_within**0.5, 2) == 2.96


def test_shift_scale_and_order_change_nothing() -> None:
    """Shifted by a large number that float64 could not hold, and scaled by ten, as text."""
    base = grouped(PLANT_GROWTH)
    shifted = grouped({k: " ".join(f"73000000000{float(x):.2f}" for x in v.split()) for k, v in PLANT_GROWTH.items()})
    scaled = grouped({k: " ".join(str(Decimal(x) * 10) for x in v.split()) for k, v in PLANT_GROWTH.items()})
    turned = grouped({k: " ".join(reversed(PLANT_GROWTH[k].split())) for k in reversed(PLANT_GROWTH)})
    for other in (shifted, scaled, turned):
        for test in (one_way, welch):
            assert pytest.approx(test(base).F, rel=1e-12) == test(other).F
            assert test(other).p == pytest.approx(test(base).p, rel=1e-12)


def test_no_scatter_is_said_and_not_divided_by() -> None:
    same, apart = grouped({"a": "2 2 2", "b": "2 2"}), grouped({"a": "2 2 2", "b": "3 3"})
    for groups, words in ((same, "all values are equal"), (apart, "the groups differ: exactly")):
        found = one_way(groups)
        assert found.F is None and found.p is None and found.eta_squared is None and words in (found.reason or "")
        assert "no scatter in a, b" in (welch(groups).reason or "")
    one_flat = grouped({"a": "2 2 2", "b": "3 4"})
    assert one_way(one_flat).F is not None and welch(one_flat).F is None


def test_a_group_of_one_counts_in_the_classical_test_only() -> None:
    groups = grouped({"a": "1 2 3", "b": "4 5 7", "c": "9"})
    data = [np.array([1.0, 2, 3]), np.array([4.0, 5, 7]), np.array([9.0])]
    assert pytest.approx(stats.f_oneway(*data).statistic) == one_way(groups).F
    assert welch(groups).left_out == ("c",)
    assert pytest.approx(stats.f_oneway(*data[:2], equal_var=False).statistic) == welch(groups).F


def test_cycles_taken_for_samples_find_differences_where_there_are_none() -> None:
    """Five designs alike, five samples each that differ by 3 deg, ten cycles each that differ by 0.5 deg; 600 such studies."""
    rng = np.random.default_rng(1)
    values = rng.normal(0, 3, (600, 5, 5, 1)) + rng.normal(0, 0.5, (600, 5, 5, 10))
    naive = np.mean(stats.f_oneway(*values.reshape(600, 5, 50).swapaxes(0, 1), axis=1).pvalue < 0.05)
    names = np.repeat(list("abcde"), 50).tolist()
    samples = np.tile(np.repeat(np.arange(5), 10), 5).astype(str).tolist()
    nested = [one_way(groups_of(measurements_of(names, study.ravel().tolist(), samples))).p for study in values]
    assert 0.9 < naive < 0.97
    assert 0.025 < np.mean(np.array(nested) < 0.05) < 0.08


def _groups(data: list[np.ndarray]) -> tuple[Group, ...]:
    names = [str(i) for i, row in enumerate(data) for _ in row]
    return groups_of(measurements_of(names, np.concatenate(data).tolist()))
