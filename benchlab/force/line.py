"""The straight line of force against pressure over several actuators, and whether it is straight.

Actuators are the samples; each is measured at every pressure, so that its forces are alike (repeated measures), and its cycles are
no samples at all. Everything here works on one mean force an actuator and pressure.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.stats import f as f_distribution
from scipy.stats import t as t_distribution

from benchlab.units import FloatArray


@dataclass(frozen=True)
class Estimate:
    """A value with the ends of its confidence interval; NaN where one actuator cannot tell."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Linearity:
    """Lack of fit: F with its degrees of freedom and p. bow_N: how far the mean curve stands over its chord-like line in the middle of
    the pressures, as the quadratic part of it; bow_p: of its t test over actuators."""

    F: float
    df: tuple[int, int]
    p: float
    bow_N: Estimate
    bow_p: float


@dataclass(frozen=True)
class ForceLine:
    """F = intercept + slope·p of the mean actuator. through_origin: slope of F = slope·p. residual_sd_N: of an actuator's means about
    its own line, with m·(K − 2) degrees of freedom. r_squared: of the means about the common line. linearity: None for fewer than two
    actuators or three pressures. pressure_MPa: (K,) that it is from. intercepts, slopes: (m,) of each actuator's own line."""

    pressure_MPa: FloatArray
    intercept_N: Estimate
    slope_N_per_MPa: Estimate
    through_origin_N_per_MPa: Estimate
    r_squared: float
    residual_sd_N: float
    actuators: int
    confidence: float
    linearity: Linearity | None
    intercepts_N: FloatArray
    slopes_N_per_MPa: FloatArray

    def at(self, pressure_MPa: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Mean force and the pointwise confidence band (low, high) at pressures (Q,), NaN for one actuator."""
        lines = self.intercepts_N[:, None] + self.slopes_N_per_MPa[:, None] * np.asarray(pressure_MPa, dtype=float)
        return _interval(lines, self.confidence)


def fit_line(pressure_MPa: FloatArray, force_N: FloatArray, confidence: float = 0.95) -> ForceLine:
    """The line through the mean forces of m actuators at K ≥ 2 pressures. pressure_MPa: (K,) not all equal; force_N: (m, K) finite.

    Each actuator gets its own least-squares line; the line is their mean, which is the least-squares line of the mean curve, and its
    intervals are t intervals over the m lines with m − 1 degrees of freedom (summary measures: Matthews et al., BMJ 300, 230, 1990).
    They hold whether or not the lines of actuators differ in height and slope; treating m·K means as independent does not.

    Linearity is tested by lack of fit within actuators. With r the residuals of each actuator's own line, H0 "the mean curve is straight":
    F = [m·Σ_j r̄_j²/(K − 2)] / [Σ_ij (r_ij − r̄_j)²/((m − 1)(K − 2))], F distributed with K − 2 and (m − 1)(K − 2) degrees of freedom. It is
    the test of pressure as a factor beyond "a line for each actuator" against the actuator × pressure mean square, the error term of
    trend tests in randomized blocks (Winer, Statistical Principles in Experimental Design, ch. 4; lack of fit: Draper & Smith, Applied
    Regression Analysis, ch. 2). Lines that differ by actuator leave no trace in r. What it asks for is that the deviations from lines
    scatter alike at all pressures; simulated with an SD proportional to pressure, it rejects a straight line in 8 % instead of 5 %
    of cases. The bow, one contrast an actuator with its own t test, does not ask for that, and has m − 1 degrees of freedom only.

    >>> p = np.array([0.1, 0.2, 0.3, 0.4])
    >>> line = fit_line(p, np.array([10 * p + 1, 12 * p + 3]))
    >>> round(line.slope_N_per_MPa.value, 6), round(line.intercept_N.value, 6), line.slope_N_per_MPa.high > 20
    (11.0, 2.0, True)
    """
    p, force = np.asarray(pressure_MPa, dtype=float), np.atleast_2d(np.asarray(force_N, dtype=float))
    m, k = force.shape
    design = np.column_stack([np.ones(k), p])
    lines = np.linalg.lstsq(design, force.T, rcond=None)[0]
    residuals = force - (design @ lines).T
    common = force - design @ lines.mean(axis=1)
    total = float(np.square(force - force.mean()).sum())
    return ForceLine(
        pressure_MPa=p,
        intercept_N=_estimate(lines[0], confidence),
        slope_N_per_MPa=_estimate(lines[1], confidence),
        through_origin_N_per_MPa=_estimate(force @ p / (p @ p), confidence),
        r_squared=1 - float(np.square(common).sum()) / total if total else math.nan,
        residual_sd_N=math.sqrt(float(np.square(residuals).sum()) / (m * (k - 2))) if k > 2 else math.nan,
        actuators=m,
        confidence=confidence,
        linearity=_linearity(p, residuals, confidence) if m > 1 and k > 2 else None,
        intercepts_N=lines[0],
        slopes_N_per_MPa=lines[1],
    )


def _linearity(p: FloatArray, residuals: FloatArray, confidence: float) -> Linearity | None:
    """None where the forces leave nothing to test: all on straight lines to the last digits."""
    m, k = residuals.shape
    mean = residuals.mean(axis=0)
    error = float(np.square(residuals - mean).sum()) / ((m - 1) * (k - 2))
    lack = m * float(mean @ mean) / (k - 2)
    if not error > 0:
        return None
    bow = _bow(p, residuals)
    spread = float(bow.std(ddof=1)) / math.sqrt(m)
    bow_p = 2 * float(t_distribution.sf(abs(bow.mean()) / spread, m - 1)) if spread > 0 else math.nan
    F = lack / error
    df = (k - 2, (m - 1) * (k - 2))
    return Linearity(F, df, float(f_distribution.sf(F, *df)), _estimate(bow, confidence), bow_p)


def _bow(p: FloatArray, residuals: FloatArray) -> FloatArray:
    """(m,) the quadratic part of each actuator's residuals (m, K), as its height in the middle over the mean of its two ends."""
    basis = np.column_stack([np.ones(len(p)), p, p**2])
    coefficients = np.linalg.lstsq(basis, residuals.T, rcond=None)[0][2]
    return -coefficients * ((p.max() - p.min()) / 2) ** 2


def _estimate(values: FloatArray, confidence: float) -> Estimate:
    return Estimate(*(float(found) for found in _interval(np.asarray(values), confidence)))


def _interval(values: FloatArray, confidence: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mean over the first axis (m, ...) with a t interval of m − 1 degrees of freedom."""
    m = len(values)
    mean = values.mean(axis=0)
    if m < 2:
        none = np.full(np.shape(mean), np.nan)
        return mean, none, none
    half = t_distribution.ppf((1 + confidence) / 2, m - 1) * values.std(axis=0, ddof=1) / math.sqrt(m)
    return mean, mean - half, mean + half
