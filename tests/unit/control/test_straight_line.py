"""The line against certified numbers and statsmodels, and its tests against what was put in."""

import math

import numpy as np
import pytest
import statsmodels.api as sm

from benchlab.control.straight_line import fit_straight_line
from benchlab.errors import InputError

# NIST StRD, linear regression, Norris (ozone monitors; https://www.itl.nist.gov/div898/strd/lls/data/Norris.shtml): x, y.
NORRIS = np.array([
    0.2, 0.1, 337.4, 338.8, 118.2, 118.1, 884.6, 888.0, 10.1, 9.2, 226.5, 228.1, 666.3, 668.5, 996.3, 998.5, 448.6, 449.1,
    777.0, 778.9, 558.2, 559.2, 0.4, 0.3, 0.6, 0.1, 775.5, 778.1, 666.9, 668.8, 338.0, 339.3, 447.5, 448.9, 11.6, 10.8,
    556.0, 557.7, 228.1, 228.3, 995.8, 998.0, 887.6, 888.8, 120.2, 119.6, 0.3, 0.3, 0.3, 0.6, 556.8, 557.6, 339.1, 339.3,
    887.2, 888.0, 999.0, 998.5, 779.0, 778.9, 11.1, 10.2, 118.3, 117.6, 229.2, 228.9, 669.1, 668.4, 448.9, 449.2, 0.5, 0.2,
]).reshape(-1, 2)  # fmt: skip


def test_the_certified_line_of_norris() -> None:
    line = fit_straight_line(NORRIS[:, 0], NORRIS[:, 1])
    assert line.offset.value == pytest.approx(-0.262323073774029, rel=1e-9)
    assert line.gain.value == pytest.approx(1.00211681802045, rel=1e-12)
    assert line.sd == pytest.approx(0.884796396144373, rel=1e-10)
    assert line.r_squared == pytest.approx(0.999993745883712, rel=1e-12)
    t = 2.03224450932  # qt(0.975, 34)
    assert (line.gain.high - line.gain.value) / t == pytest.approx(0.429796848199937e-03, rel=1e-8)
    assert (line.offset.value - line.offset.low) / t == pytest.approx(0.232818234301152, rel=1e-8)


def test_bow_and_farthest_point_as_statsmodels_has_them() -> None:
    rng = np.random.default_rng(3)
    x = np.linspace(0.3, 3.2, 14)
    y = 0.1 * x - 0.02 * x**2 + rng.normal(0, 0.01, 14)
    line = fit_straight_line(x, y)
    parabola = sm.OLS(y, np.column_stack([np.ones(14), x, x**2])).fit()
    assert line.bow_p == pytest.approx(parabola.pvalues[2], rel=1e-8)
    half = np.ptp(x) / 2
    assert line.bow.value == pytest.approx(-parabola.params[2] * half**2, rel=1e-8)
    assert line.bow.low == pytest.approx(-parabola.conf_int()[2, 1] * half**2, rel=1e-8)
    outliers = sm.OLS(y, sm.add_constant(x)).fit().get_influence()
    studentized = np.abs(outliers.resid_studentized_external)
    assert line.farthest == int(np.argmax(studentized))
    table = sm.OLS(y, sm.add_constant(x)).fit().outlier_test(method="bonf")
    assert line.farthest_p == pytest.approx(np.asarray(table)[line.farthest, 2], rel=1e-8)


def test_the_bow_of_a_parabola_is_its_height_over_the_chord() -> None:
    x = np.linspace(1.0, 3.0, 9)
    line = fit_straight_line(x, 2 * x + 0.5 * (1 - (x - 2.0) ** 2))  # 0.5 above the chord in the middle, 0 at the ends
    assert line.bow.value == pytest.approx(0.5)


def test_a_straight_line_without_noise_is_found_exactly() -> None:
    x = np.array([0.5, 1.0, 2.0, 3.0, 3.0])
    line = fit_straight_line(x, 0.096 * x)
    assert line.gain.value == pytest.approx(0.096, rel=1e-12) and line.sd == pytest.approx(0, abs=1e-15)
    assert line.r_squared == pytest.approx(1)


def test_one_wrong_point_is_picked() -> None:
    x = np.linspace(0.3, 3.3, 10)
    y = 0.096 * x + np.random.default_rng(1).normal(0, 0.0003, 10)
    assert fit_straight_line(x, y).farthest_p > 0.05
    y[7] += 0.01
    line = fit_straight_line(x, y)
    assert line.farthest == 7 and line.farthest_p < 1e-3


def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    rng, inside = np.random.default_rng(8), 0
    x = np.linspace(0.3, 3.3, 8)
    for _ in range(1000):
        line = fit_straight_line(x, 0.096 * x + 0.01 + rng.normal(0, 0.002, 8))
        inside += line.gain.low < 0.096 < line.gain.high and math.isfinite(line.bow_p)
    assert 0.93 < inside / 1000 < 0.97


@pytest.mark.parametrize(
    ("x", "y", "named"),
    [
        ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0], "too few"),
        ([1.0, 1.0, 2.0, 2.0], [1.0, 1.0, 2.0, 2.0], "too few"),
        ([1.0, 2.0, 3.0, 4.0], [0.0, 0.0, 0.0, 0.0], "nothing follows"),
    ],
)
def test_too_little_to_fit_is_refused(x: list[float], y: list[float], named: str) -> None:
    with pytest.raises(InputError, match=named):
        fit_straight_line(np.array(x), np.array(y))
