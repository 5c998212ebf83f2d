"""Variance components: a textbook's nested ANOVA, statsmodels, simulation; and what comes out negative."""

import numpy as np
import pytest
from scipy import optimize, stats

from benchlab.stats.anova import one_way
from benchlab.stats.components import find_components
from benchlab.stats.groups import groups_of
from benchlab.stats.measurements import Measurements, measurements_of
from benchlab.stats.reml import reml_variances
from tests.unit.stats.samples import MOSQUITO_WINGS, PLANT_GROWTH, grouped, nested


def test_mosquito_wings_of_sokal_and_rohlf() -> None:
    """Biometry, Box 10.1: F 1.741 of cages over females; s² 1.30, s²(females in cages) 94.94, s²(cages) 17.71."""
    measured = nested(MOSQUITO_WINGS)
    groups = groups_of(measured)
    anova = one_way(groups)
    assert round(anova.F or 0, 3) == 1.741 and anova.df == (2, 9)
    assert 2 * anova.ss_between == pytest.approx(665.68, abs=0.005)
    assert 2 * anova.ss_within == pytest.approx(1720.68, abs=0.005)
    found = find_components(groups, measured.cycles())
    assert found.method == "EMS" and found.cycle is not None
    assert found.cycle.variance == pytest.approx(1.30, abs=0.005) and found.cycle.df == 12
    assert found.sample.variance == pytest.approx(94.94, abs=0.005)
    assert found.design.variance == pytest.approx(17.71, abs=0.005)


def test_williams_interval_of_the_wings() -> None:
    """As Searle, Casella and McCulloch give it (Variance Components, table 3.2): SSA·(1 − F_U/F)/(n·χ²_U) to SSA·(1 − F_L/F)/(n·χ²_L)."""
    measured = nested(MOSQUITO_WINGS)
    found = find_components(groups_of(measured), measured.cycles()).sample
    ms, within = 191.18638, 1.3016667
    for end, q in ((found.low, 0.975), (found.high, 0.025)):
        variance = 9 * ms * (1 - stats.f.ppf(q, 9, 12) / (ms / within)) / (2 * stats.chi2.ppf(q, 9))
        assert end == pytest.approx(variance**0.5, rel=1e-6)


def test_reml_is_ems_where_samples_have_as_many_cycles() -> None:
    measured = nested(MOSQUITO_WINGS)
    found = find_components(groups_of(measured), measured.cycles())
    assert found.cycle is not None
    assert reml_variances(measured.cycles()) == (
        pytest.approx(found.cycle.variance, rel=1e-4),
        pytest.approx(found.sample.variance, rel=1e-4),
    )


def test_unlike_numbers_of_cycles_lie_at_the_top_of_the_likelihood() -> None:
    """Searle, Casella and McCulloch 1992, Variance Components, 6.6: the restricted likelihood of two variances, without constants."""
    measured = drawn(1, (3, 7))
    found = find_components(groups_of(measured), measured.cycles())
    assert found.method == "REML" and found.cycle is not None
    assert found.sample.variance > 0

    def misfit(within: float, between: float) -> float:
        total = 0.0
        for samples in measured.cycles().values():
            n = np.array([len(row) for row in samples.values()])
            mean = np.array([row.mean() for row in samples.values()])
            w = 1 / (between + within / n)
            about = mean - (w * mean).sum() / w.sum()
            total += float((w * about**2).sum() - np.log(w).sum() + np.log(w.sum()))
            total += sum(
                float(((row - row.mean()) ** 2).sum()) / within + (len(row) - 1) * np.log(within)
                for row in samples.values()
            )
        return total

    best = optimize.minimize(
        lambda x: misfit(*np.exp(x)), [0.0, 0.0], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-10}
    )
    assert (found.cycle.variance, found.sample.variance) == pytest.approx(tuple(np.exp(best.x)), rel=1e-4)


def test_samples_that_do_not_differ_have_no_variance_between_them() -> None:
    """Likelihood is highest at the end at which samples do not differ. At ρ = 0 the variance is that of all cycles about their design."""
    rows = [
        ("a", "1", 1.0),
        ("a", "1", 3.0),
        ("a", "2", 2.1),
        ("b", "1", 7.0),
        ("b", "1", 5.0),
        ("b", "2", 6.0),
        ("b", "2", 6.2),
    ]
    groups, samples, values = zip(*rows)
    found = find_components(
        groups_of(measurements_of(groups, values, samples)), measurements_of(groups, values, samples).cycles()
    )
    assert found.method == "REML" and found.sample.variance == 0 and found.cycle is not None
    a, b = np.array(values[:3]), np.array(values[3:])
    assert found.cycle.variance == pytest.approx((((a - a.mean()) ** 2).sum() + ((b - b.mean()) ** 2).sum()) / 5)


def test_cycles_that_hardly_scatter_beside_samples_that_do() -> None:
    """Samples 2 apart, cycles 1e-5: as good as one value a sample, whose variance is 4."""
    values = {f"s{i}": [x + 1e-5 * e for e in (-1, 1, 0)[: 2 + i % 2]] for i, x in enumerate((8.0, 10.0, 12.0))}
    rows = [("a", name, x) for name, row in values.items() for x in row] + [
        ("b", name, x + 1) for name, row in values.items() for x in row
    ]
    groups, samples, numbers = zip(*rows)
    within, between = reml_variances(measurements_of(groups, numbers, samples).cycles())
    assert between == pytest.approx(4.0, rel=1e-3) and within == pytest.approx(1e-10 * 1.5, rel=0.1)


@pytest.mark.parametrize("cycles", [(6, 6), (3, 9)])
def test_intervals_hold_the_truth(cycles: tuple[int, int]) -> None:
    """Truth 0.5 within and 3 between samples; 95 % intervals of 60 drawn studies (chance of fewer than 50: 1 in 10,000)."""
    held = np.zeros(2)
    for seed in range(60):
        measured = drawn(seed, cycles)
        found = find_components(groups_of(measured), measured.cycles())
        for index, (component, truth) in enumerate(((found.cycle, 0.5), (found.sample, 3.0))):
            assert component is not None and component.low is not None and component.high is not None
            held[index] += component.low <= truth <= component.high
    assert (held >= 50).all()


def test_without_cycles_the_lowest_component_is_that_of_samples() -> None:
    groups = grouped(PLANT_GROWTH)
    found = find_components(groups, None)
    assert found.cycle is None and found.sample.variance == one_way(groups).ms_within
    ss = one_way(groups).ss_within  # chi-square with 27 degrees of freedom: 14.573 and 43.195, as tables print them
    assert found.sample.low == pytest.approx((ss / 43.195) ** 0.5, rel=1e-4)
    assert found.sample.high == pytest.approx((ss / 14.573) ** 0.5, rel=1e-4)


def test_a_negative_component_is_set_to_zero_and_told() -> None:
    measured = nested({"a": {"1": "1 9", "2": "9 1"}, "b": {"1": "2 8.1", "2": "8 2"}})
    found = find_components(groups_of(measured), measured.cycles())
    assert found.sample.variance == 0 and found.sample.raw < 0 and found.sample.sd == 0
    assert "between samples came out negative" in found.warnings[0]


def drawn(seed: int, cycles: tuple[int, int]) -> Measurements:
    """Four designs of five samples (SD 3) with a number of cycles (SD 0.5) between these two."""
    rng = np.random.default_rng(seed)
    rows = [
        (f"d{d}", f"s{s}", value)
        for d in range(4)
        for s in range(5)
        for value in 10 * d + rng.normal(0, 3) + rng.normal(0, 0.5, rng.integers(cycles[0], cycles[1] + 1))
    ]
    groups, samples, values = zip(*rows)
    return measurements_of(groups, values, samples)
