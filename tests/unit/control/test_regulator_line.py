"""A regulator's line: what was put in is found, and readings that pressure should not rest on are refused."""

import math

import numpy as np
import pytest

from benchlab.control.regulator_line import fit_regulator
from benchlab.errors import InputError

LEVELS = np.linspace(0.35, 3.4, 8)
VOLTS = np.concatenate([LEVELS, LEVELS[-2::-1]])
RISING = np.arange(len(VOLTS)) < len(LEVELS)


def readings(gain: float = 0.0965, offset: float = -0.002, sd: float = 0.0004, loop: float = 0.0) -> np.ndarray:
    noise = np.random.default_rng(4).normal(0, sd, len(VOLTS))
    return gain * VOLTS + offset + noise + np.where(RISING, -loop / 2, loop / 2)


def test_what_was_put_in_is_found() -> None:
    fit = fit_regulator(VOLTS, readings(), RISING, "regulator")
    assert fit.line.gain.low < 0.0965 < fit.line.gain.high
    assert fit.line.offset.low < -0.002 < fit.line.offset.high
    assert fit.line.sd == pytest.approx(0.0004, rel=0.5)
    assert fit.residual_MPa.std() == pytest.approx(fit.line.sd, rel=0.1)
    assert fit.warnings == ()


def test_hysteresis_is_stated_and_told_when_large() -> None:
    fit = fit_regulator(VOLTS, readings(loop=0.005), RISING, "regulator")
    assert fit.hysteresis_MPa == pytest.approx(0.005, abs=0.0004)
    assert "between falling and rising" in fit.warnings[0]
    up = fit_regulator(LEVELS, 0.096 * LEVELS, np.ones(8, dtype=bool), "regulator")
    assert math.isnan(up.hysteresis_MPa)


def test_a_bow_is_told_with_its_height() -> None:
    middle = (VOLTS.max() + VOLTS.min()) / 2
    bow = 0.004 * (1 - ((VOLTS - middle) / (np.ptp(VOLTS) / 2)) ** 2)
    fit = fit_regulator(VOLTS, readings() + bow, RISING, "regulator")
    assert any("not straight, +4" in w or "not straight, +3.9" in w for w in fit.warnings)


@pytest.mark.parametrize("off", [0.0025, -0.0025])
def test_what_a_gauge_may_err_by_is_told_and_not_refused(off: float) -> None:
    """3 kPa: class 0.5 of 0.6 MPa."""
    typed = readings(sd=0.0002)
    typed[4] += off
    (told,) = fit_regulator(VOLTS, typed, RISING, "regulator").warnings
    assert f"reading 5, {typed[4]:.4g} MPa" in told
    typed[4] += off
    with pytest.raises(InputError, match="reading 5"):
        fit_regulator(VOLTS, typed, RISING, "regulator")


def test_a_mistyped_reading_is_named() -> None:
    typed = readings()
    typed[4] = 0.0281  # 0.2081 mistyped
    with pytest.raises(InputError, match=r"reading 5, 0\.0281 MPa at 2\.093 V"):
        fit_regulator(VOLTS, typed, RISING, "regulator")


@pytest.mark.parametrize(
    ("volts", "pressure", "named"),
    [
        (VOLTS, -readings(), "falls with the volts"),
        (VOLTS, np.minimum(readings(), 0.15), "R²"),
        (VOLTS[:3], readings()[:3], "too few"),
        (VOLTS / 10, readings(), "too few"),
        (np.where(VOLTS > 3, np.nan, VOLTS), readings(), "reading 8"),
        (VOLTS, np.full(len(VOLTS), 0.1), "nothing follows"),
    ],
    ids=["negative", "starved supply", "few", "narrow", "nan", "constant"],
)
def test_readings_that_no_pressure_should_rest_on_are_refused(
    volts: np.ndarray, pressure: np.ndarray, named: str
) -> None:
    with pytest.raises(InputError, match=named):
        fit_regulator(volts, pressure, RISING[: len(volts)], "regulator")
