"""Figures of tracking against closed forms."""

import math

import numpy as np
import pytest
from scipy.stats import pearsonr

from benchlab.actuator import tip_position_mm
from benchlab.control.tracking import lag_s, track
from benchlab.errors import InputError

T = np.arange(0, 20, 0.01)  # four whole periods of 0.2 Hz
W = 2 * np.pi * 0.2
SINE = 60 + 45 * np.sin(W * T)


def test_a_late_sine() -> None:
    """A sine late by φ: e = 2A·sin(φ/2)·cos(…), so RMSE = √2·A·sin(φ/2), R² = 1 − 4·sin²(φ/2), Pearson's r = cos φ."""
    late = 60 + 45 * np.sin(W * (T - 0.15))
    found = track(T, SINE, late, np.full(len(T), 0.1), 0.35)
    phi = 0.15 * W
    assert found.rmse_deg == pytest.approx(math.sqrt(2) * 45 * math.sin(phi / 2), rel=1e-9)
    assert found.r_squared == pytest.approx(1 - 4 * math.sin(phi / 2) ** 2, rel=1e-9)
    assert found.correlation_squared == pytest.approx(math.cos(phi) ** 2, rel=1e-9)
    assert found.correlation_squared == pytest.approx(pearsonr(SINE, late).statistic ** 2, rel=1e-9)
    assert found.max_deg == pytest.approx(2 * 45 * math.sin(phi / 2), rel=1e-4)
    assert found.mae_deg == pytest.approx(2 / np.pi * 2 * 45 * math.sin(phi / 2), rel=1e-4)
    assert found.lag_s == pytest.approx(0.15, abs=1e-3) and found.bias_deg == pytest.approx(0, abs=1e-9)


def test_the_lag_is_found_between_samples() -> None:
    assert lag_s(T, SINE, 60 + 45 * np.sin(W * (T - 0.1537))) == pytest.approx(0.1537, abs=5e-4)


def test_the_papers_figures_belong_together() -> None:
    """R² 0.96 with RMSE 6.72° is a sine of 47.5° amplitude by this definition of R²."""
    amplitude = 6.72 * math.sqrt(2 / 0.04)
    error = 6.72 * math.sqrt(2) * np.cos(W * T)
    found = track(T, amplitude * np.sin(W * T), amplitude * np.sin(W * T) - error, np.full(len(T), 0.1), 0.35)
    assert found.r_squared == pytest.approx(0.96) and found.rmse_deg == pytest.approx(6.72)
    assert amplitude == pytest.approx(47.5, abs=0.05)


def test_an_offset_is_bias_and_no_matter_to_the_correlation() -> None:
    found = track(T, SINE, SINE - 3, np.full(len(T), 0.1), 0.35)
    assert (found.bias_deg, found.rmse_deg, found.mae_deg, found.max_deg) == pytest.approx((3, 3, 3, 3))
    assert found.correlation_squared == pytest.approx(1) and found.r_squared == pytest.approx(1 - 9 / (45**2 / 2))


def test_effort_and_saturation() -> None:
    command = np.clip(0.2 + 0.2 * np.sin(W * T), 0, 0.35)
    found = track(T, SINE, SINE, command, 0.35)
    assert found.variation_MPa == pytest.approx(4 * 2 * 0.35, rel=0.02)
    assert found.variation_MPa_per_s == pytest.approx(found.variation_MPa / T[-1])
    assert found.peak_MPa == 0.35
    assert found.at_ceiling == pytest.approx(2 * math.acos(0.75) / (2 * np.pi), abs=2e-3)
    assert found.at_zero < 0.01


def test_settling_and_missing_samples_are_left_out_and_told() -> None:
    reference = np.where(T < 2, np.nan, SINE)
    angle = np.where(T < 5, -100, SINE)
    angle[-10:] = np.nan
    found = track(T, reference, angle, np.full(len(T), 0.1), 0.35, settle_s=3.0)
    assert found.rmse_deg == 0 and found.missing == 10 and found.samples == 1500 - 10
    with pytest.raises(InputError, match="settling"):
        track(T, reference, angle, np.full(len(T), 0.1), 0.35, settle_s=30.0)


def test_the_error_of_the_tip() -> None:
    found = track(T, np.full(len(T), 90.0), np.full(len(T), 80.0), np.full(len(T), 0.1), 0.35, length_mm=180.0)
    wanted, had = (tip_position_mm(np.radians(angle), 180.0) for angle in (90.0, 80.0))
    assert found.tip_rmse_mm == pytest.approx(float(np.hypot(*(wanted - had))))
    assert math.isnan(found.r_squared) and math.isnan(found.lag_s)


@pytest.mark.parametrize("shift", [-0.2, 0.0, 0.123])
def test_lag_of_noise_that_is_followed(shift: float) -> None:
    rng = np.random.default_rng(2)
    fine = np.cumsum(rng.normal(0, 1, 3000))
    grid = np.arange(-5, 25, 0.01)
    smooth = np.convolve(fine, np.ones(50) / 50, mode="same")
    found = lag_s(T, np.interp(T, grid, smooth), np.interp(T - shift, grid, smooth))
    assert found == pytest.approx(shift, abs=0.005)


def test_a_lag_beyond_what_is_looked_at_is_not_told() -> None:
    ramp = np.clip(T - 5, 0, 1)
    assert math.isnan(lag_s(T, ramp, np.clip(T - 8, 0, 1), longest_s=1.0))
