"""The plant from a run in open loop: gain, lag and dead time from commanded pressure to bending angle, at each operating point."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from benchlab.control.first_order import Fit, fit
from benchlab.control.holds import find_holds
from benchlab.control.straight_line import Interval
from benchlab.control.tuning import Lag
from benchlab.errors import InputError
from benchlab.units import FloatArray

STILL_S = 0.3
"""A pressure that stands for so long is a hold."""

LONGEST_STEP_S = 0.5
"""A change between two holds that takes no longer is a step."""

WINDOW_S = 2.0
"""After a step, what is looked at: long enough for the lag, short enough to leave creep out."""

LARGEST_STEP_MPA = 0.1
"""A larger step is of no one operating point, the response curve being bent."""

LONGEST_DEAD_TIME_S = 0.5
LEAST_R_SQUARED = 0.5
"""A stretch of a run that the model explains less of is left out; with more, the intervals say how well it is known."""


@dataclass(frozen=True)
class Plant:
    """Local model K·exp(−L·s)/(τ·s + 1) about one pressure, from start_s to end_s of the run.

    pressure_MPa: of the operating point. rises: whether the pressure rose there; None for a sweep. residual_sd_deg, r_squared: of the
    fit over `samples`. Intervals allow for the correlation of neighbouring residuals.
    """

    pressure_MPa: float
    rises: bool | None
    gain_deg_per_MPa: Interval
    lag_s: Interval
    dead_time_s: Interval
    residual_sd_deg: float
    r_squared: float
    samples: int
    start_s: float
    end_s: float

    @property
    def cautious(self) -> Lag:
        """The ends of the intervals for which gains must be least: large gain, long dead time, short lag."""
        return Lag(self.gain_deg_per_MPa.high, self.lag_s.low, self.dead_time_s.high)


@dataclass(frozen=True)
class Identification:
    """plants: in order of time, or of pressure for a sweep. method: steps or sweep. left_out: what was not used, and why."""

    plants: tuple[Plant, ...]
    method: str
    left_out: tuple[str, ...]


@dataclass(frozen=True)
class _Stretch:
    time_s: FloatArray
    command_MPa: FloatArray
    angle_deg: FloatArray

    @property
    def step_MPa(self) -> float:
        return float(self.command_MPa[-1] - self.command_MPa[0])

    @property
    def name(self) -> str:
        return f"{self.command_MPa[0]:.4g} to {self.command_MPa[-1]:.4g} MPa at {self.time_s[0]:.4g} s"


def identify(
    time_s: FloatArray,
    command_MPa: FloatArray,
    angle_deg: FloatArray,
    window_s: float = WINDOW_S,
    confidence: float = 0.95,
) -> Identification:
    """Identify from commanded pressure and measured angle, (T,) each over time_s (T,), in open loop. Samples without an angle are left out.

    With steps between holds, each step of at most LARGEST_STEP_MPA is an operating point: gain, lag and dead time by least squares
    from just before it to window_s after. Without steps (ramps, sines), one lag and dead time with a cubic response curve over the
    whole run, whose slope is the gain at three pressures; the loop of the actuator then goes into the lag, so steps are better.

    Raises InputError where the run has nothing to identify from, and where nothing in it is described by such a plant.
    """
    known = np.isfinite(angle_deg) & np.isfinite(command_MPa)
    run = _Stretch(*(np.asarray(a, dtype=float)[known] for a in (time_s, command_MPa, angle_deg)))
    if len(run.time_s) < 50 or np.ptp(run.command_MPa) == 0:
        raise InputError(
            f"{len(run.time_s)} samples with an angle and an open-loop pressure that changes: too few to identify from",
            hint="run a protocol with steps of pressure on a bench with a calibrated flex sensor",
        )
    steps = _steps(run, window_s)
    plants: list[Plant] = []
    left_out: list[str] = []
    for stretch in steps or [run]:
        if steps and abs(stretch.step_MPa) > LARGEST_STEP_MPA + 1e-9:
            left_out.append(f"{stretch.name}: a step larger than {LARGEST_STEP_MPA:g} MPa is of no one operating point")
            continue
        found = _local(stretch, confidence) if steps else _sweep(stretch, confidence)
        doubt = next((doubt for plant in found if (doubt := _doubt(plant))), "")
        left_out += [f"{stretch.name}: {doubt}"] if doubt else []
        plants += [] if doubt else found
    if not plants:
        raise InputError(
            f"no plant found: {left_out[0]}" + (f", and {len(left_out) - 1} more" if left_out[1:] else ""),
            hint="use small steps of pressure between holds of some seconds",
        )
    return Identification(tuple(plants), "steps" if steps else "sweep", tuple(left_out))


def _steps(run: _Stretch, window_s: float) -> list[_Stretch]:
    """From STILL_S before each step to window_s after it, or to the end of the hold that it leads to."""
    holds = find_holds(run.time_s, run.command_MPa, STILL_S)
    found = []
    for before, after in itertools.pairwise(holds):
        if run.time_s[after.first] - run.time_s[before.last] <= LONGEST_STEP_S:
            began = run.time_s[before.last]
            inside = (run.time_s >= began - STILL_S) & (run.time_s <= began + window_s)
            inside[: before.first] = inside[after.last + 1 :] = False
            found.append(_Stretch(run.time_s[inside], run.command_MPa[inside], run.angle_deg[inside]))
    return found


def _local(stretch: _Stretch, confidence: float) -> list[Plant]:
    fitted = fit(stretch.time_s, stretch.command_MPa, stretch.angle_deg, 1, LONGEST_DEAD_TIME_S)
    gain = float(fitted.coefficients[0]), float(np.sqrt(fitted.covariance[0, 0]))
    middle = float(stretch.command_MPa[[0, -1]].mean())
    return [_plant(stretch, fitted, middle, gain, stretch.step_MPa > 0, confidence)]


def _sweep(stretch: _Stretch, confidence: float) -> list[Plant]:
    fitted = fit(stretch.time_s, stretch.command_MPa, stretch.angle_deg, 3, LONGEST_DEAD_TIME_S)
    found = []
    for pressure in np.quantile(fitted.response, (0.1, 0.5, 0.9)):
        slope = np.array([1, 2 * pressure, 3 * pressure**2])
        gain = float(slope @ fitted.coefficients[:3]), float(np.sqrt(slope @ fitted.covariance[:3, :3] @ slope))
        found.append(_plant(stretch, fitted, float(pressure), gain, None, confidence))
    return found


def _plant(
    stretch: _Stretch,
    fitted: Fit,
    pressure_MPa: float,
    gain: tuple[float, float],
    rises: bool | None,
    confidence: float,
) -> Plant:
    z = float(norm.ppf((1 + confidence) / 2))
    log_lag_sd, dead_sd = np.sqrt(np.diag(fitted.covariance)[-2:])
    total = float(np.square(stretch.angle_deg - stretch.angle_deg.mean()).sum())
    left = float(np.square(fitted.residual).sum())
    factor = float(np.exp(np.minimum(z * log_lag_sd, 50.0)))
    return Plant(
        pressure_MPa=pressure_MPa,
        rises=rises,
        gain_deg_per_MPa=Interval(gain[0], gain[0] - z * gain[1], gain[0] + z * gain[1]),
        lag_s=Interval(fitted.lag_s, fitted.lag_s / factor, fitted.lag_s * factor),
        dead_time_s=Interval(
            fitted.dead_time_s,
            max(0.0, fitted.dead_time_s - z * float(dead_sd)),
            fitted.dead_time_s + z * float(dead_sd),
        ),
        residual_sd_deg=float(np.sqrt(left / len(fitted.residual))),
        r_squared=1 - left / total if total > 0 else 0.0,
        samples=len(fitted.residual),
        start_s=float(stretch.time_s[0]),
        end_s=float(stretch.time_s[-1]),
    )


def _doubt(plant: Plant) -> str:
    """Why a fit is no plant to tune for; empty where it is one."""
    if plant.r_squared < LEAST_R_SQUARED:
        return f"a lag with dead time explains R² {plant.r_squared:.2f} of the angle, less than {LEAST_R_SQUARED:g}"
    gain, lag = plant.gain_deg_per_MPa, plant.lag_s
    if gain.low <= 0:
        return f"the gain is {gain.value:.3g} °/MPa, with an interval from {gain.low:.3g}: not surely above 0"
    if lag.high > 3 * lag.value or lag.value > plant.end_s - plant.start_s:
        return f"the lag is {lag.value:.3g} s, with an interval to {lag.high:.3g} s: this stretch does not tell it"
    return ""
