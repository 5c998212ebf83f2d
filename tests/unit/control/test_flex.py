"""The flex line from runs whose sensor is known."""

import numpy as np
import pytest
import statsmodels.api as sm
from scipy.signal import lfilter

from benchlab.control.flex import _lack_of_fit, calibrate_flex
from benchlab.errors import InputError

GAIN, OFFSET = -80.0, 240.0  # degrees per V, degrees: 3 V straight, 1.5 V at 120°
LEVELS = np.concatenate([np.linspace(0, 0.35, 8), np.linspace(0.3, 0, 7)])


def run(rng: np.random.Generator, noise_V: float = 0.004, bow_V: float = 0.0, loop_deg: float = 0.0, cycles: int = 2):
    """Time, command, volts, angle of `cycles` staircases at 100 Hz; noise of 0.2 s in the volts, as a slow sensor has."""
    levels = np.tile(LEVELS, cycles)
    falls = np.concatenate([[False], np.diff(levels) < 0])
    command, down = np.repeat(levels, 200), np.repeat(falls, 200)
    t = np.arange(len(command)) * 0.01
    angle = 120 * np.sqrt(command / 0.35) + lfilter([0.05], [1, -0.95], rng.normal(0, 0.3, len(t)))
    slow = lfilter([1.0], [1, -0.95], rng.normal(0, noise_V * np.sqrt(1 - 0.95**2), len(t)))
    volts = (angle + loop_deg * np.where(down, 0.5, -0.5) - OFFSET) / GAIN + slow
    return t, command, volts + bow_V * (1 - (angle / 60 - 1) ** 2), angle


def test_the_line_and_the_rate_of_its_intervals() -> None:
    """Samples of 0.2 s correlation: as independent samples the interval would hold the truth far too rarely."""
    rng, held, sample_held = np.random.default_rng(3), 0, 0
    for _ in range(200):
        t, command, volts, angle = run(rng, cycles=1)
        found = calibrate_flex(t, command, volts, t, angle)
        held += found.line.gain.low < GAIN < found.line.gain.high
        naive = sm.OLS(angle, sm.add_constant(volts)).fit().conf_int()[1]
        sample_held += naive[0] < GAIN < naive[1]
    assert 0.90 < held / 200 < 0.99
    assert sample_held / 200 < 0.6


def test_what_it_says_of_one_run() -> None:
    t, command, volts, angle = run(np.random.default_rng(5))
    found = calibrate_flex(t, command, volts, t[::3], angle[::3])
    assert len(found.volts) == 30 - 1  # the two vents in the middle are one hold
    assert found.line.gain.value == pytest.approx(GAIN, rel=0.01) and found.line.offset.value == pytest.approx(
        OFFSET, rel=0.01
    )
    assert found.sample_sd_deg == pytest.approx(80 * 0.004, rel=0.25)
    assert found.line.bow_p > 0.01 and found.lack_of_fit is not None and found.lack_of_fit.p > 0.01
    assert abs(found.hysteresis_deg) < 0.15
    assert found.bench_line.of((60 - OFFSET) / GAIN) == pytest.approx(60, abs=0.3)
    assert found.bench_line.sd == found.sd_deg > found.sample_sd_deg


def test_a_bow_is_found_by_both_tests() -> None:
    t, command, volts, angle = run(np.random.default_rng(6), bow_V=0.05)
    found = calibrate_flex(t, command, volts, t, angle)
    assert found.line.bow_p < 1e-6 and found.lack_of_fit is not None and found.lack_of_fit.p < 1e-4
    # 0.05 V of bow at -80 °/V: the angle at these volts stands 4° below the chord... seen from the line's ends.
    assert found.line.bow.value == pytest.approx(4.0, rel=0.15)


def test_lack_of_fit_of_true_replicates_as_nested_models_of_statsmodels_have_it() -> None:
    """Where the volts of a level are the same each time, the line within the model of level means."""
    rng = np.random.default_rng(7)
    levels, index = np.linspace(0, 0.35, 6), np.tile(np.arange(6), 3)
    angle = 300 * levels[index] + rng.normal(0, 0.5, 18)
    found = _lack_of_fit(sm.OLS(angle, sm.add_constant(levels[index])).fit().resid, levels[index])
    full = sm.OLS(angle, np.eye(6)[index]).fit()
    F, p, _ = full.compare_f_test(sm.OLS(angle, sm.add_constant(levels[index])).fit())
    assert found is not None and (found.F, found.p) == pytest.approx((F, p), rel=1e-9) and found.df == (4, 12)


def test_lack_of_fit_rejects_a_true_line_as_often_as_it_says() -> None:
    rng, found = np.random.default_rng(8), []
    for _ in range(300):
        fitted = calibrate_flex(*_shuffled(rng))
        found.append(fitted.lack_of_fit.p < 0.05)
    assert 0.02 < np.mean(found) < 0.09


def _shuffled(rng: np.random.Generator):
    t, command, volts, angle = run(rng, cycles=2)
    return t, command, volts, t, angle


def test_hysteresis_is_stated() -> None:
    t, command, volts, angle = run(np.random.default_rng(9), loop_deg=3.0)
    found = calibrate_flex(t, command, volts, t, angle)
    assert found.hysteresis_deg == pytest.approx(-3.0, abs=0.3)
    assert found.hysteresis_max_deg == pytest.approx(3.0, abs=0.6)


def test_a_sensor_that_is_slow_after_each_step_has_the_same_line() -> None:
    t, command, volts, angle = run(np.random.default_rng(2), noise_V=0.0)
    slow = lfilter([0.05], [1, -0.95], volts - 3.0) + 3.0  # 0.2 s
    found = calibrate_flex(t, command, slow, t, angle)
    assert found.line.gain.value == pytest.approx(GAIN, rel=2e-3) and found.line.sd < 0.1


def test_missing_volts_and_angles_are_passed_over_and_too_few_refused() -> None:
    t, command, volts, angle = run(np.random.default_rng(1))
    holes = np.where(np.arange(len(t)) % 5 == 0, np.nan, volts)
    assert calibrate_flex(t, command, holes, t, angle).line.gain.value == pytest.approx(GAIN, rel=0.01)
    with pytest.raises(InputError, match="holds at"):
        calibrate_flex(t, command, volts, t[:500], angle[:500])
    with pytest.raises(InputError, match="0 holds"):
        calibrate_flex(t, np.linspace(0, 0.3, len(t)), volts, t, angle)
    with pytest.raises(InputError, match="do not follow"):
        calibrate_flex(t, command, np.random.default_rng(0).normal(2, 0.1, len(t)), t, angle)


def test_angles_that_are_not_degrees_or_not_of_this_run_are_refused() -> None:
    t, command, volts, angle = run(np.random.default_rng(8))
    with pytest.raises(InputError, match=r"are these radians\? \(2\.09 rad are 120°\)"):
        calibrate_flex(t, command, volts, t, np.radians(angle))
    with pytest.raises(InputError, match="more than twice round"):
        calibrate_flex(t, command, volts, t, np.degrees(angle))
    with pytest.raises(InputError, match="rank correlation over 29 holds is −0"):
        calibrate_flex(t, command, volts, t, -angle)
    with pytest.raises(InputError, match="does not grow with the pressure"):
        calibrate_flex(t, command, volts, t, 60 + 50 * np.sin(t))
    stiffest = calibrate_flex(t, command, volts, t, angle * 7.8 / 120)  # slw 30 of the paper at 0.35 MPa
    assert stiffest.line.gain.value == pytest.approx(GAIN * 7.8 / 120, rel=0.01)


def test_a_line_that_explains_little_is_refused_and_holds_without_angle_are_counted() -> None:
    t, command, volts, angle = run(np.random.default_rng(9))
    loose = volts + np.repeat(np.random.default_rng(1).normal(0, 1.5, 30), 200)
    with pytest.raises(InputError, match=r"the line explains \d+ % of the angle's variance"):
        calibrate_flex(t, command, loose, t, angle)
    assert calibrate_flex(t, command, volts, t[:4000], angle[:4000]).left_out == 10
