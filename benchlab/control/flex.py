"""The flex sensor's line, from volts to bending angle, from a run that holds several pressures.

The paper's sensor "has a linear correlation between the change in voltage and the curvature" (section II-H); here the line comes
with its intervals, and whether it is straight is tested.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import f as f_distribution
from scipy.stats import spearmanr

from benchlab.bench import Line
from benchlab.control.holds import Hold, find_holds
from benchlab.control.straight_line import StraightLine, fit_straight_line
from benchlab.errors import InputError
from benchlab.units import FloatArray

LEAST_HOLD_S = 0.8
"""Shorter holds are not used."""

SETTLED = 0.5
"""The first half of a hold is left out: actuator and sensor are on their way."""

LEAST_LEVELS = 3

LEAST_DEG_PER_MPA, MOST_DEG = 10.0, 720.0
"""The stiffest actuator of the paper (slw 30) bends by 22 °/MPa; an angle that moves by less than half of that is not in degrees, nor is
one that goes twice round."""

FOLLOWS, FITS = 0.8, 0.8
"""Spearman's correlation of angle with pressure, and R² of the line: an angle with less is of another run."""


@dataclass(frozen=True)
class LackOfFit:
    """F of the levels' mean distances from the line over the scatter within levels, with its degrees of freedom and p."""

    F: float
    df: tuple[int, int]
    p: float


@dataclass(frozen=True)
class FlexCalibration:
    """θ = gain·V + offset from H holds, each averaged to one point, since the samples within one are not independent.

    volts, angle_deg, pressure_MPa: (H,). rising: (H,) whether the hold before was lower. line: with intervals and the test of a bow.
    lack_of_fit: None without levels that were held twice. hysteresis_deg: mean over levels held both ways of (falling − rising)
    distance from the line, NaN without such; hysteresis_max_deg: the largest. sample_sd_deg: of one sample about its hold.
    sd_deg: of one sample about the line, which is the Line's. left_out: holds without volts or angle.
    """

    volts: FloatArray
    angle_deg: FloatArray
    pressure_MPa: FloatArray
    rising: NDArray[np.bool_]
    line: StraightLine
    lack_of_fit: LackOfFit | None
    hysteresis_deg: float
    hysteresis_max_deg: float
    sample_sd_deg: float
    left_out: int = 0

    @property
    def sd_deg(self) -> float:
        return math.hypot(self.line.sd, self.sample_sd_deg)

    @property
    def bench_line(self) -> Line:
        """As a bench has it."""
        return Line(self.line.gain.value, self.line.offset.value, self.sd_deg)

    @property
    def residual_deg(self) -> FloatArray:
        """(H,) angle less line."""
        return self.angle_deg - self.line.of(self.volts)


def calibrate_flex(
    time_s: FloatArray,
    command_MPa: FloatArray,
    flex_V: FloatArray,
    angle_time_s: FloatArray,
    angle_deg: FloatArray,
    confidence: float = 0.95,
) -> FlexCalibration:
    """The line through the holds of a run: command_MPa and flex_V (T,) over time_s (T,), and the angle (A,) that was seen by another,
    over angle_time_s (A,) on the same clock, at any rate; NaN where a value is missing.

    Of each hold the second half is averaged. Straightness: a quadratic term, and, where levels of pressure were held more than once,
    lack of fit (Draper & Smith, Applied Regression Analysis, ch. 2). Angles at a level differ a little from time to time and both angle and
    volts have noise, so distances from the line are compared between and within levels, not angles at the same volts.

    Raises InputError for fewer than four usable holds or three levels, for an angle that is not in degrees or does not grow with the
    pressure, and where volts do not follow the angle.
    """
    holds, left_out = [], 0
    for hold in find_holds(time_s, command_MPa, LEAST_HOLD_S):
        point = _point(hold, time_s, flex_V, angle_time_s, angle_deg)
        left_out += point is None
        holds += [] if point is None else [(hold.pressure_MPa, *point)]
    levels = len(_levels(np.array([h[0] for h in holds]))[1])
    if len(holds) < LEAST_LEVELS + 1 or levels < LEAST_LEVELS:
        raise InputError(
            f"{len(holds)} holds at {levels} pressures have volts and an angle ({left_out} without); at least {LEAST_LEVELS + 1} holds at "
            f"{LEAST_LEVELS} pressures are needed",
            hint="run the protocol flex_calibration, and film all of it",
        )
    pressure, volts, angle, scatter_V = (np.array(column) for column in zip(*holds))
    _check_angles(pressure, angle)
    line = fit_straight_line(volts, angle, confidence)
    if line.gain.low <= 0 <= line.gain.high:
        raise InputError(
            f"the volts do not follow the angle: the gain is {line.gain.value:.3g} °/V, with an interval from {line.gain.low:.3g} to "
            f"{line.gain.high:.3g}",
            hint="is the flex sensor wired, and is the angle on the run's clock?",
        )
    if line.r_squared < FITS:
        raise InputError(
            f"the line explains {100 * line.r_squared:.0f} % of the angle's variance where {100 * FITS:.0f} % are the least",
            hint="is the angle of this run and on its clock, and is the flex sensor fixed to the actuator?",
        )
    rising = np.concatenate([[True], np.diff(pressure) > 0])
    residual = angle - line.of(volts)
    differences = _differences(pressure, residual, rising)
    return FlexCalibration(
        volts=volts,
        angle_deg=angle,
        pressure_MPa=pressure,
        rising=rising,
        line=line,
        lack_of_fit=_lack_of_fit(residual, pressure),
        hysteresis_deg=float(differences.mean()) if len(differences) else math.nan,
        hysteresis_max_deg=float(np.abs(differences).max()) if len(differences) else math.nan,
        sample_sd_deg=abs(line.gain.value) * math.sqrt(float(np.square(scatter_V).mean())),
        left_out=left_out,
    )


def _check_angles(pressure_MPa: FloatArray, angle_deg: FloatArray) -> None:
    """InputError for angles of the holds, (H,) each, that no actuator has at these pressures."""
    moved, over = float(np.ptp(angle_deg)), float(np.ptp(pressure_MPa))
    if moved < LEAST_DEG_PER_MPA * over:
        raise InputError(
            f"the angle moves by {moved:.3g}° over {over:.3g} MPa, and the stiffest actuator bends by {2 * LEAST_DEG_PER_MPA * over:.2g}°: "
            f"are these radians? ({moved:.3g} rad are {math.degrees(moved):.0f}°)",
            hint="give angle_deg in degrees, of this run",
        )
    if moved > MOST_DEG:
        raise InputError(f"the angle moves by {moved:.4g}°, more than twice round", hint="give angle_deg in degrees")
    follows = float(spearmanr(pressure_MPa, angle_deg).statistic)
    if follows < FOLLOWS:
        raise InputError(
            f"the angle does not grow with the pressure: their rank correlation over {len(angle_deg)} holds is {follows:.2f}, and "
            f"{FOLLOWS:g} is the least".replace("-", "−"),
            hint="is the angle of this run, on its clock (--angle-starts-s), and above 0 when bent?",
        )


def _point(
    hold: Hold, time_s: FloatArray, flex_V: FloatArray, angle_time_s: FloatArray, angle_deg: FloatArray
) -> tuple[float, float, float] | None:
    """Mean volts, mean angle and scatter of the volts in the settled part of a hold; None where one of them was not measured."""
    first, last = float(time_s[hold.first]), float(time_s[hold.last])
    began = first + SETTLED * (last - first)
    volts = flex_V[(time_s >= began) & (time_s <= last)]
    angles = angle_deg[(angle_time_s >= began) & (angle_time_s <= last)]
    volts, angles = volts[np.isfinite(volts)], angles[np.isfinite(angles)]
    if len(volts) < 2 or not len(angles):
        return None
    return float(volts.mean()), float(angles.mean()), float(volts.std(ddof=1))


def _levels(pressure_MPa: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
    """(H,) which level each hold is of, and the levels."""
    found, index = np.unique(np.round(pressure_MPa, 6), return_inverse=True)
    return index.astype(np.int64), found


def _lack_of_fit(residual: FloatArray, pressure: FloatArray) -> LackOfFit | None:
    index, levels = _levels(pressure)
    df = len(levels) - 2, len(residual) - len(levels)
    if df[1] < 1:
        return None
    count = np.bincount(index)
    mean = np.bincount(index, residual) / count
    within = float(np.square(residual - mean[index]).sum()) / df[1]
    if not within > 0:
        return None
    F = float(count @ np.square(mean)) / df[0] / within
    return LackOfFit(F, df, float(f_distribution.sf(F, *df)))


def _differences(pressure: FloatArray, residual: FloatArray, rising: NDArray[np.bool_]) -> FloatArray:
    """Falling less rising at each level that was held both ways."""
    index, levels = _levels(pressure)
    ways = [[residual[(index == level) & (rising == way)] for way in (False, True)] for level in range(len(levels))]
    return np.array([down.mean() - up.mean() for down, up in ways if len(down) and len(up)])
