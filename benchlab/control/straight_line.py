"""The straight line of a sensor or a regulator over its volts, with intervals, and whether it is straight."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.stats import t as t_distribution

from benchlab.errors import InputError
from benchlab.units import FloatArray


@dataclass(frozen=True)
class Interval:
    """A value with the ends of its confidence interval, NaN where too few points tell."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class StraightLine:
    """value = gain · volts + offset. sd: of one value about the line, with n − 2 degrees of freedom. bow: by how much the values
    stand over the line in the middle of the volts, seen from the ends, as the parabola through them has it; bow_p: of its t test with
    n − 3. farthest: index of the point that is least like the others; farthest_p: that so far a point is among n like the others."""

    gain: Interval
    offset: Interval
    sd: float
    r_squared: float
    bow: Interval
    bow_p: float
    farthest: int
    farthest_p: float
    points: int
    confidence: float

    def of(self, volts: FloatArray) -> FloatArray:
        """Values at these volts, same shape."""
        return self.gain.value * np.asarray(volts, dtype=float) + self.offset.value


def fit_straight_line(volts: FloatArray, values: FloatArray, confidence: float = 0.95) -> StraightLine:
    """Least-squares line of values (n,) over volts (n,), n ≥ 4 with at least three different volts, all finite.

    Intervals are t intervals of ordinary least squares (Draper & Smith, Applied Regression Analysis, ch. 1). Straightness is the t test
    of a quadratic term, which sees a bow, the usual way in which sensors are not straight. The farthest point is tested by its
    externally studentized residual, t distributed with n − 3 degrees of freedom, times n for having been picked
    (Bonferroni; Cook & Weisberg, Residuals and Influence in Regression, section 2.2.2).
    Raises InputError for fewer points, and where all volts or all values are one.

    >>> line = fit_straight_line(np.array([1.0, 2.0, 3.0, 4.0]), np.array([2.1, 3.9, 6.1, 7.9]))
    >>> round(line.gain.value, 3), round(line.offset.value, 3), line.bow_p > 0.5
    (1.96, 0.1, True)
    """
    x, y = np.asarray(volts, dtype=float), np.asarray(values, dtype=float)
    n = len(x)
    if n < 4 or len(np.unique(x)) < 3:
        raise InputError(
            f"{n} points at {len(np.unique(x))} different volts are too few for a line that can be checked",
            hint="give at least 4 points at 3 different volts",
        )
    if np.ptp(y) == 0:
        raise InputError(f"all {n} values are {y[0]:g}: nothing follows the volts", hint="is the sensor connected?")
    design = np.column_stack([np.ones(n), x - x.mean()])
    (mean, gain), residuals = _least_squares(design, y)
    dof = n - 2
    square = float(residuals @ residuals)
    variance = square / dof
    t = float(t_distribution.ppf((1 + confidence) / 2, dof))
    sxx = float(np.square(x - x.mean()).sum())
    offset = mean - gain * x.mean()
    bow, bow_p = _bow(x, y, confidence)
    farthest, farthest_p = _farthest(x, residuals, square, sxx)
    return StraightLine(
        gain=_interval(gain, t * math.sqrt(variance / sxx)),
        offset=_interval(offset, t * math.sqrt(variance * (1 / n + x.mean() ** 2 / sxx))),
        sd=math.sqrt(variance),
        r_squared=1 - square / float(np.square(y - y.mean()).sum()),
        bow=bow,
        bow_p=bow_p,
        farthest=farthest,
        farthest_p=farthest_p,
        points=n,
        confidence=confidence,
    )


def _least_squares(design: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    found: FloatArray = np.asarray(np.linalg.lstsq(design, y, rcond=None)[0], dtype=float)
    return found, y - design @ found


def _interval(value: float, half: float) -> Interval:
    return Interval(float(value), float(value - half), float(value + half))


def _bow(x: FloatArray, y: FloatArray, confidence: float) -> tuple[Interval, float]:
    """The parabola's height in the middle over the mean of its ends, and the p of there being none."""
    half = np.ptp(x) / 2
    scaled = (x - (x.max() + x.min()) / 2) / half
    design = np.column_stack([np.ones(len(x)), scaled, scaled**2])
    found, residuals = _least_squares(design, y)
    bow, dof = -float(found[2]), len(x) - 3
    sd = math.sqrt(float(residuals @ residuals) / dof * float(np.linalg.inv(design.T @ design)[2, 2]))
    if not sd > 0:
        return Interval(bow, bow, bow), math.nan
    p = 2 * float(t_distribution.sf(abs(bow) / sd, dof))
    return _interval(bow, float(t_distribution.ppf((1 + confidence) / 2, dof)) * sd), p


def _farthest(x: FloatArray, residuals: FloatArray, square: float, sxx: float) -> tuple[int, float]:
    n = len(x)
    free = 1 - (1 / n + np.square(x - x.mean()) / sxx)
    without = np.maximum(square - np.square(residuals) / free, 0.0) / (n - 3)
    with np.errstate(divide="ignore", invalid="ignore"):
        studentized = np.abs(residuals) / np.sqrt(without * free)
    if not np.isfinite(studentized).any():
        return int(np.argmax(np.abs(residuals))), math.nan
    worst = int(np.nanargmax(studentized))
    return worst, min(1.0, n * 2 * float(t_distribution.sf(studentized[worst], n - 3)))
