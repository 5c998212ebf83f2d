"""The path of a cell's states as pressure grows: free to bend, or held at a curvature."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from benchlab.errors import UsageError
from benchlab.simulation.cell import Cell, State
from benchlab.simulation.newton import TOLERANCE, Solved, condensed, minimise

SMALLEST_STEP_MPa = 5e-4
"""Below this a pressure step is not cut further: the pressure before it is the limit."""

_ALMOST = 1.01
"""A step that ends this near to a pressure asked for ends there: two states that differ by rounding say nothing of the next one."""

_LARGEST_GROWTH = 1.5
"""Times the volume before: a step that grows the cell by more is taken again, in halves."""


@dataclass(frozen=True)
class PathPoint:
    """A stable state: pressure, state of the cell, and the moment with which the actuator presses against what holds it
    (0 when free), in N·mm."""

    pressure_MPa: float
    state: State
    moment_Nmm: float


@dataclass(frozen=True)
class Path:
    """Stable states at the pressures asked for, in their order.

    limit_pressure_MPa: None, or the highest pressure at which a stable state was found before one asked for: beyond it
    the cell has no equilibrium near by (it bursts). Points beyond are missing.
    """

    points: tuple[PathPoint, ...]
    limit_pressure_MPa: float | None


def follow(
    cell: Cell,
    pressures_MPa: Sequence[float],
    held_k: float | None = None,
    reached: Callable[[], None] | None = None,
    tolerance: float = TOLERANCE,
) -> Path:
    """Stable states of the cell at growing pressures, from the round tube on.

    held_k: None, free to bend; or the angle per unstretched length (rad/mm) at which the cell is held.
    reached: called after each pressure. tolerance: of the last step, as of `minimise`. Raises UsageError where the pressures do not
    grow or are negative.
    """
    check_pressures(pressures_MPa)
    start = cell.round_tube() if held_k is None else replace(cell.round_tube(), k=held_k)
    known: list[tuple[float, State]] = []
    points: list[PathPoint] = []
    for pressure in pressures_MPa:
        solved = _reach(cell, start, known, float(pressure), held_k, tolerance)
        if solved is None:
            return Path(tuple(points), known[-1][0] if known else 0.0)
        points.append(PathPoint(float(pressure), solved.state, moment_Nmm(cell, solved) if held_k is not None else 0.0))
        if reached:
            reached()
    return Path(tuple(points), None)


def hold(cell: Cell, free: PathPoint, k: float, steps: int = 4) -> PathPoint | None:
    """The state at the pressure of a free one, bent or straightened to k; None where no stable state is found."""
    state = free.state
    solved: Solved | None = None
    for target in np.linspace(state.k, k, steps + 1)[1:]:
        state = replace(state, k=float(target))
        solved = minimise(lambda at: cell.potential(at, free.pressure_MPa), state, free=(False, True))
        if not solved.converged:
            return None
        state = solved.state
    return None if solved is None else PathPoint(free.pressure_MPa, state, moment_Nmm(cell, solved))


def moment_Nmm(cell: Cell, solved: Solved) -> float:
    """Moment of the whole cross-section: −∂Π/∂k of the quarter cell, times 2 for the other half, by half the cell's length."""
    return -2 * float(solved.potential.border_gradient[0]) / cell.half_length_mm


def bending_stiffness_Nmm2(cell: Cell, point: PathPoint) -> float:
    """dM/dk of the whole cross-section where a free cell rests: how much moment a little more bending takes, all else in balance."""
    at = cell.potential(point.state, point.pressure_MPa)
    border = condensed(at)
    return 2 * float(border[0, 0] - border[0, 1] ** 2 / border[1, 1]) / cell.half_length_mm


def check_pressures(pressures_MPa: Sequence[float]) -> None:
    """Raises UsageError for pressures that are negative, not numbers, or do not grow."""
    if not len(pressures_MPa):
        raise UsageError("no pressure is given", hint="give at least one, in MPa")
    for pressure in pressures_MPa:
        if not (math.isfinite(pressure) and pressure >= 0):
            raise UsageError(f"a pressure is {pressure} MPa", hint="give pressures of 0 MPa or more")
    for before, after in pairwise(pressures_MPa):
        if after <= before:
            raise UsageError(f"pressure {after:g} MPa follows {before:g} MPa", hint="give pressures that grow")


def _reach(
    cell: Cell,
    start: State,
    known: list[tuple[float, State]],
    pressure: float,
    held_k: float | None,
    tolerance: float,
) -> Solved | None:
    """The state at `pressure`, in as many steps as it takes from the last known one; steps taken are added to `known`."""
    free = (held_k is None, True)
    reached = known[-1][0] if known else 0.0
    step = pressure - reached
    while True:
        target = pressure if pressure - reached < _ALMOST * step else reached + step
        guess = extrapolated(known, target) if known else start
        most = _LARGEST_GROWTH * cell.volume_mm3(known[-1][1] if known else start)
        solved = _stable_state(cell, target, guess, free, most, tolerance)
        if solved.converged:
            known.append((target, solved.state))
            if target == pressure:
                return solved
            reached, step = target, 1.5 * step
        elif step <= SMALLEST_STEP_MPa:
            return None
        else:
            step /= 4


def _stable_state(
    cell: Cell, pressure: float, guess: State, free: tuple[bool, bool], most_volume_mm3: float, tolerance: float
) -> Solved:
    """Looked at after the last step only where it is held: the moment is the slope of its potential."""
    return minimise(
        lambda at: cell.potential(at, pressure),
        guess,
        free,
        tolerance=tolerance,
        astray=lambda at: cell.volume_mm3(at) > most_volume_mm3,
        look=not free[0],
    )


def extrapolated(known: list[tuple[float, State]], pressure: float) -> State:
    """The state at a pressure as a polynomial through the last states, of third order at most, would have it."""
    last = known[-4:]
    weights = [
        math.prod((pressure - q) / (p - q) for j, (q, _) in enumerate(last) if j != i) for i, (p, _) in enumerate(last)
    ]
    fields = sum((w * state.fields for w, (_, state) in zip(weights, last)), np.zeros_like(last[0][1].fields))
    return State(
        fields,
        math.fsum(w * state.k for w, (_, state) in zip(weights, last)),
        math.fsum(w * state.lam for w, (_, state) in zip(weights, last)),
    )
