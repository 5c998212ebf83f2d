"""A regulator's line from gauge readings, refused where pressure should not rest on it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.control.straight_line import StraightLine, fit_straight_line
from benchlab.errors import InputError
from benchlab.units import FloatArray

FEWEST_LEVELS, SMALLEST_SPAN_V = 4, 0.8
"""A line is fitted to this many different volts at least, and over this many volts."""

WORST_R_SQUARED = 0.995
OUTLIER_P, BOW_P = 0.01, 0.05
"""Below these a reading is refused as unlike the others, and a bow is told."""

TELLING_MPA = 0.001
"""Bows smaller than this are never told: it is the least that gauges of 1 MPa show."""

OUTLIER_MPA = 0.003
"""Readings closer to the line than this are never refused: a gauge of 0.6 MPa and class 0.5, the worst to calibrate with, may err by it."""


@dataclass(frozen=True)
class RegulatorFit:
    """line: pressure in MPa over volts. hysteresis_MPa: mean of falling less rising at the levels that were reached both ways, NaN where
    none was. residual_MPa: (n,) readings less the line. warnings: in words."""

    line: StraightLine
    hysteresis_MPa: float
    residual_MPa: FloatArray
    warnings: tuple[str, ...]


def fit_regulator(volts: FloatArray, pressure_MPa: FloatArray, rising: NDArray[np.bool_], what: str) -> RegulatorFit:
    """The line of gauge pressures (n,) over volts (n,). rising: (n,) whether each was reached from below. what: "regulator" or "monitor",
    for messages.

    Raises InputError for too few levels or too small a span, no rise with the volts, R² below 0.995, and naming each reading
    that is unlike the others.

    >>> volts = np.array([0.5, 1.0, 2.0, 3.0, 2.0, 1.0])
    >>> fit = fit_regulator(volts, 0.096 * volts, np.array([1, 1, 1, 1, 0, 0], dtype=bool), "regulator")
    >>> round(fit.line.gain.value, 6), fit.warnings
    (0.096, ())
    """
    x, y = np.asarray(volts, dtype=float), np.asarray(pressure_MPa, dtype=float)
    _check_readings(x, y, what)
    line = fit_straight_line(x, y)
    if line.gain.value <= 0:
        raise InputError(
            f"{what}: pressure falls with the volts ({line.gain.value:.4g} MPa/V)", hint="are its wires exchanged?"
        )
    residual = y - line.of(x)
    i = line.farthest
    unlike = line.farthest_p < OUTLIER_P
    if unlike and abs(residual[i]) > OUTLIER_MPA:
        raise InputError(
            f"{what}: reading {i + 1}, {y[i]:.4g} MPa at {x[i]:.3f} V, lies {residual[i]:+.4f} MPa off the line of the others "
            f"(p {line.farthest_p:.1g})",
            hint="was it mistyped, or read before the pressure stood still? read it again, or leave it out",
        )
    if line.r_squared < WORST_R_SQUARED:
        raise InputError(
            f"{what}: R² of the line is {line.r_squared:.4f}, less than {WORST_R_SQUARED}: readings scatter by {line.sd:.4f} MPa",
            hint="look for a leak or a supply below the wanted pressure, and wait longer before each reading",
        )
    hysteresis = _hysteresis(x, y, np.asarray(rising, dtype=bool))
    warnings = _warnings(line, hysteresis, what)
    if unlike and abs(residual[i]) > TELLING_MPA:
        warnings.append(
            f"{what}: reading {i + 1}, {y[i]:.4g} MPa at {x[i]:.3f} V, lies {1000 * residual[i]:+.1f} kPa off the line of the others"
        )
    return RegulatorFit(line, hysteresis, residual, tuple(warnings))


def _check_readings(x: FloatArray, y: FloatArray, what: str) -> None:
    for index, (volts, pressure) in enumerate(zip(x, y)):
        if not (math.isfinite(volts) and math.isfinite(pressure)):
            raise InputError(f"{what}: reading {index + 1} is {pressure} MPa at {volts} V", hint="leave it out")
    levels, span = len(np.unique(np.round(x, 2))), float(np.ptp(x)) if len(x) else 0.0
    if levels < FEWEST_LEVELS or span < SMALLEST_SPAN_V:
        raise InputError(
            f"{what}: {levels} different levels over {span:.2f} V are too few for a line",
            hint=f"give at least {FEWEST_LEVELS} levels over at least {SMALLEST_SPAN_V:g} V",
        )


def _hysteresis(x: FloatArray, y: FloatArray, rising: NDArray[np.bool_]) -> float:
    differences = []
    for level in np.unique(np.round(x, 2)):
        here = np.round(x, 2) == level
        if (here & rising).any() and (here & ~rising).any():
            differences.append(y[here & ~rising].mean() - y[here & rising].mean())
    return float(np.mean(differences)) if differences else math.nan


def _warnings(line: StraightLine, hysteresis: float, what: str) -> list[str]:
    found = []
    if line.bow_p < BOW_P and abs(line.bow.value) > TELLING_MPA:
        found.append(f"{what}: not straight, {1000 * line.bow.value:+.1f} kPa in the middle (p {line.bow_p:.2g})")
    if abs(hysteresis) > 2 * TELLING_MPA:
        found.append(
            f"{what}: {1000 * hysteresis:+.1f} kPa between falling and rising; wait longer, or look for friction"
        )
    return found
