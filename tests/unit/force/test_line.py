"""The line over actuators against statsmodels and closed forms, and the error rates of its test and interval by simulation."""

from __future__ import annotations

import numpy as np
import pandas
import pytest
import statsmodels.formula.api as smf
from scipy.stats import linregress
from scipy.stats import t as t_distribution
from statsmodels.stats.anova import anova_lm

from benchlab.force.line import fit_line

P = np.round(0.035 * np.arange(1, 11), 3)


def forces(rng: np.random.Generator, m: int = 3, bow_N: float = 0.0, relative: bool = False) -> np.ndarray:
    """Lines that differ by actuator in height and slope, and means that scatter about them."""
    scatter = rng.normal(0, 0.3, (m, len(P))) * (P / P.mean() if relative else 1.0)
    bow = bow_N * (1 - ((P - P.mean()) / np.ptp(P) * 2) ** 2)
    return rng.normal(0, 0.5, (m, 1)) + rng.normal(107, 5, (m, 1)) * P + bow + scatter


@pytest.mark.filterwarnings("ignore:The design matrix is rank-deficient")  # a line lies within the means
def test_lack_of_fit_is_that_of_nested_models_in_statsmodels() -> None:
    force = forces(np.random.default_rng(3), m=4, bow_N=0.4)
    table = pandas.DataFrame({"force": force.ravel(), "p": np.tile(P, 4), "actuator": np.repeat(list("abcd"), len(P))})
    lines = smf.ols("force ~ C(actuator) + C(actuator):p", table).fit()
    means = smf.ols("force ~ C(actuator) + C(actuator):p + C(p)", table).fit()
    row = anova_lm(lines, means).iloc[1]
    found = fit_line(P, force).linearity
    assert found is not None
    assert (found.F, found.p) == pytest.approx((row["F"], row["Pr(>F)"]), rel=1e-9)
    assert found.df == (row["df_diff"], means.df_resid) == (8, 24)


def test_line_and_interval_are_those_of_the_actuators_own_lines() -> None:
    force = forces(np.random.default_rng(5))
    found = fit_line(P, force, 0.9)
    own = [linregress(P, row) for row in force]
    slopes, starts = np.array([one.slope for one in own]), np.array([one.intercept for one in own])
    assert found.slopes_N_per_MPa == pytest.approx(slopes)
    half = t_distribution.ppf(0.95, 2) * slopes.std(ddof=1) / np.sqrt(3)
    assert (found.slope_N_per_MPa.low, found.slope_N_per_MPa.high) == pytest.approx(
        (slopes.mean() - half, slopes.mean() + half)
    )
    whole = linregress(np.tile(P, 3), force.ravel())
    assert (found.slope_N_per_MPa.value, found.intercept_N.value) == pytest.approx((whole.slope, whole.intercept))
    assert found.r_squared == pytest.approx(whole.rvalue**2)
    mean, low, high = found.at(np.array([0.0, 0.2]))
    at = starts + 0.2 * slopes
    assert mean == pytest.approx([starts.mean(), at.mean()])
    assert high[1] - low[1] == pytest.approx(2 * t_distribution.ppf(0.95, 2) * at.std(ddof=1) / np.sqrt(3))


def test_through_the_origin_and_residual_sd_by_hand() -> None:
    p, force = np.array([1.0, 2.0, 3.0]), np.array([[1.0, 3.0, 3.0], [2.0, 4.0, 8.0]])
    found = fit_line(p, force)
    assert found.through_origin_N_per_MPa.value == pytest.approx(((1 + 6 + 9) / 14 + (2 + 8 + 24) / 14) / 2)
    # Own lines: slopes 1 and 3, residuals (-1, 2, -1)/3 each way: 6/9 and 6/9 of squares, two degrees of freedom.
    assert found.residual_sd_N == pytest.approx(np.sqrt((6 / 9 + 6 / 9) / 2))


def test_bow_is_the_height_of_a_parabola_over_its_chord() -> None:
    p = np.linspace(0.0, 0.4, 5)
    parabola = np.array([slope * p + 0.5 * (1 - ((p - 0.2) / 0.2) ** 2) for slope in (100, 105, 112)])
    found = fit_line(p, parabola + np.random.default_rng(0).normal(0, 1e-6, parabola.shape)).linearity
    assert found is not None
    assert found.bow_N.value == pytest.approx(0.5, abs=1e-5)
    assert max(found.p, found.bow_p) < 1e-6


@pytest.mark.parametrize("m", [3, 5])
def test_a_straight_line_is_rejected_in_5_percent_though_lines_differ_by_actuator(m: int) -> None:
    rng = np.random.default_rng(m)
    lines = [fit_line(P, forces(rng, m)) for _ in range(3000)]
    assert np.mean([one.linearity.p < 0.05 for one in lines if one.linearity]) == pytest.approx(0.05, abs=0.013)
    assert np.mean([one.linearity.bow_p < 0.05 for one in lines if one.linearity]) == pytest.approx(0.05, abs=0.013)
    assert np.mean([one.slope_N_per_MPa.low < 107 < one.slope_N_per_MPa.high for one in lines]) == pytest.approx(
        0.95, abs=0.013
    )


def test_scatter_that_grows_with_pressure_makes_the_test_reject_more_but_not_the_bow() -> None:
    rng = np.random.default_rng(9)
    found = [fit_line(P, forces(rng, relative=True)).linearity for _ in range(3000)]
    assert np.mean([one.p < 0.05 for one in found if one]) == pytest.approx(0.09, abs=0.02)
    assert np.mean([one.bow_p < 0.05 for one in found if one]) == pytest.approx(0.05, abs=0.013)


def test_counting_actuator_means_as_independent_would_not_hold_the_slope() -> None:
    """What the intervals are for: least squares over all m·K means covers the true slope in seven of ten cases, not in 95 %."""
    rng = np.random.default_rng(2)
    covered = 0
    for _ in range(1000):
        one = linregress(np.tile(P, 3), forces(rng).ravel())
        covered += abs(one.slope - 107) < t_distribution.ppf(0.975, 28) * one.stderr
    assert covered < 780


def test_a_bow_of_one_newton_is_found() -> None:
    rng = np.random.default_rng(4)
    assert np.mean([fit_line(P, forces(rng, bow_N=1.0)).linearity.p < 0.05 for _ in range(300)]) > 0.95


def test_one_actuator_and_two_pressures_have_no_intervals_and_no_test() -> None:
    alone = fit_line(P, forces(np.random.default_rng(1), 1))
    assert alone.linearity is None and np.isnan(alone.slope_N_per_MPa.low)
    assert np.isfinite(alone.residual_sd_N)
    two = fit_line(P[:2], forces(np.random.default_rng(1))[:, :2])
    assert two.linearity is None and np.isnan(two.residual_sd_N) and np.isfinite(two.slope_N_per_MPa.low)
