"""Blocked force against pressure: cycles within actuators, actuators as samples."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.force.levels import TOLERANCE, cluster
from benchlab.force.line import ForceLine, fit_line
from benchlab.units import FloatArray


@dataclass(frozen=True)
class ActuatorCycles:
    """The whole cycles of one actuator. force_N: (P,) peak of each, zero taken off; pressure_MPa: (P,) of each; lower_bound: (P,) whether
    the true peak may be higher."""

    actuator: str
    force_N: FloatArray
    pressure_MPa: FloatArray
    lower_bound: NDArray[np.bool_]


@dataclass(frozen=True)
class BlockedForce:
    """The blocked force of m actuators at K pressures.

    pressure_MPa: (K,) growing. mean_N, cycle_sd_N: (m, K) mean and standard deviation of an actuator's cycles, NaN where it has none,
    or one. cycles: (m, K) how many. lower_bound: (m, K) whether one of them is. line: None where `line_reason` says why.
    tolerance_MPa: within which pressures are of one step. lever_arm_mm: from the clamp to where the force acts, None where nobody has told.
    """

    actuators: tuple[str, ...]
    pressure_MPa: FloatArray
    mean_N: FloatArray
    cycle_sd_N: FloatArray
    cycles: NDArray[np.int64]
    lower_bound: NDArray[np.bool_]
    line: ForceLine | None
    line_reason: str
    tolerance_MPa: float
    lever_arm_mm: float | None
    notes: tuple[str, ...]

    @property
    def n(self) -> NDArray[np.int64]:
        """(K,) actuators with a cycle at each pressure."""
        return np.isfinite(self.mean_N).sum(axis=0)

    @property
    def over_actuators_N(self) -> FloatArray:
        """(K,) mean over the actuators."""
        return np.nanmean(self.mean_N, axis=0)

    @property
    def sd_N(self) -> FloatArray:
        """(K,) standard deviation between actuators; NaN where there is one."""
        found = np.full(len(self.pressure_MPa), np.nan)
        several = self.n > 1
        found[several] = np.nanstd(self.mean_N[:, several], axis=0, ddof=1)
        return found


def blocked_force(
    records: Sequence[ActuatorCycles],
    tolerance_MPa: float | None = None,
    confidence: float = 0.95,
    lever_arm_mm: float | None = None,
) -> BlockedForce:
    """Blocked force from the cycles of one or more actuators; records of the same name are of one actuator.

    tolerance_MPa: None for 2 % of the largest pressure. The line is fitted to the pressures that every actuator has, without those where a
    peak is only a lower bound. Raises InputError where the pressures are not in steps, ValueError without a cycle.

    >>> one = ActuatorCycles("a", np.array([1.0, 1.2, 2.0]), np.array([0.1, 0.1, 0.2]), np.zeros(3, bool))
    >>> found = blocked_force([one])
    >>> found.pressure_MPa.tolist(), found.mean_N.round(3).tolist(), found.cycles.tolist()
    ([0.1, 0.2], [[1.1, 2.0]], [[2, 1]])
    """
    names = tuple(dict.fromkeys(record.actuator for record in records))
    force, pressure, lower = (np.concatenate([getattr(r, field) for r in records]) for field in _FIELDS)
    if not len(force):
        raise ValueError("no cycle")
    owner = np.concatenate([np.full(len(r.force_N), names.index(r.actuator)) for r in records])
    tolerance = TOLERANCE * float(pressure.max()) if tolerance_MPa is None else tolerance_MPa
    step = cluster(pressure, tolerance)
    shape = (len(names), int(step.max()) + 1)
    mean, spread, bound = np.full(shape, np.nan), np.full(shape, np.nan), np.zeros(shape, dtype=bool)
    cycles = np.zeros(shape, dtype=np.int64)
    for i, j in np.ndindex(shape):
        chosen = (owner == i) & (step == j)
        cycles[i, j] = chosen.sum()
        if cycles[i, j]:
            mean[i, j], bound[i, j] = force[chosen].mean(), lower[chosen].any()
        if cycles[i, j] > 1:
            spread[i, j] = force[chosen].std(ddof=1)
    pressures = np.array([round(float(pressure[step == j].mean()), 9) for j in range(shape[1])])
    line, reason, notes = _line(pressures, mean, bound, confidence)
    notes += _order(pressures, mean)
    return BlockedForce(
        names, pressures, mean, spread, cycles, bound, line, reason, tolerance, lever_arm_mm, tuple(notes)
    )


_FIELDS = ("force_N", "pressure_MPa", "lower_bound")


def _line(
    pressure: FloatArray, mean: FloatArray, bound: NDArray[np.bool_], confidence: float
) -> tuple[ForceLine | None, str, list[str]]:
    whole = np.isfinite(mean).all(axis=0)
    chosen = whole & ~bound.any(axis=0)
    notes = []
    if not whole.all():
        notes.append(f"not every actuator has a cycle at {_listed(pressure[~whole])} MPa: the line is without it")
    if (whole & ~chosen).any():
        notes.append(f"peaks at {_listed(pressure[whole & ~chosen])} MPa are lower bounds: the line is without them")
    if chosen.sum() < 2:
        return None, f"a line needs two pressures, and {int(chosen.sum())} can be used", notes
    if not mean[:, chosen].any():
        return None, "all forces are zero", notes
    return fit_line(pressure[chosen], mean[:, chosen], confidence), "", notes


def _order(pressure: FloatArray, mean: FloatArray) -> list[str]:
    """A doubt where more pressure gave less force, as it does when cycles are counted to the wrong steps."""
    over = np.nanmean(mean, axis=0)
    falls = np.flatnonzero(np.diff(over) < 0)
    if not len(falls):
        return []
    j = int(falls[0])
    return [
        f"the mean force falls from {over[j]:.4g} N at {pressure[j]:g} MPa to {over[j + 1]:.4g} N at {pressure[j + 1]:g} MPa: "
        "are the steps in this order?"
    ]


def _listed(values: FloatArray) -> str:
    return ", ".join(f"{value:.4g}" for value in values)


def relative_bound(found: BlockedForce, step: int) -> str:
    """`≥ ` before a force that is a lower bound at a step, else nothing."""
    return "≥ " if bool(found.lower_bound[:, step].any()) else ""


def moment_N_mm(force_N: float, lever_arm_mm: float | None) -> float:
    """Moment about the clamp; NaN where the lever arm is not known."""
    return math.nan if lever_arm_mm is None else force_N * lever_arm_mm
