"""The states of a cell from those of its neighbour: the same mesh, laminated a little otherwise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from benchlab.simulation.cell import Cell, State
from benchlab.simulation.newton import Solved, minimise
from benchlab.simulation.response import Path, PathPoint, extrapolated, follow, moment_Nmm

TOLERANCE = 3e-3
"""Of a last step; a path from the round tube has 1e-5. With 1e-2 a film half as stiff comes out up to 0.13° off, with 1e-3 0.001°."""


def follow_beside(
    cell: Cell,
    pressures_MPa: Sequence[float],
    beside: Path | None = None,
    held_k: float | None = None,
    reached: Callable[[], None] | None = None,
) -> Path:
    """Stable states of `cell`, as `response.follow` finds them, but each from the state of a neighbour at the same pressure, moved by
    how the states before it were moved (a polynomial in the pressure).

    Without a neighbour, where its mesh is another, it lacks a pressure, or a state is not found, the whole path is followed from the
    round tube.
    """
    states = {point.pressure_MPa: point.state for point in beside.points} if beside else {}
    if all(p in states and len(states[p].fields) == len(cell.held) for p in pressures_MPa):
        points = _beside(cell, [(float(p), states[p]) for p in pressures_MPa], held_k, reached)
        if points is not None:
            return Path(points, None)
    return follow(cell, pressures_MPa, held_k, reached)


def _beside(
    cell: Cell, neighbours: Sequence[tuple[float, State]], held_k: float | None, reached: Callable[[], None] | None
) -> tuple[PathPoint, ...] | None:
    moved: list[tuple[float, State]] = []
    points: list[PathPoint] = []
    for pressure, neighbour in neighbours:
        start = _sum(neighbour, extrapolated(moved[-3:], pressure)) if moved else neighbour
        solved = _from(cell, pressure, start if held_k is None else replace(start, k=held_k), held_k is None)
        if not solved.converged:
            return None
        moved.append((pressure, _sum(solved.state, neighbour, -1.0)))
        points.append(PathPoint(pressure, solved.state, 0.0 if held_k is None else moment_Nmm(cell, solved)))
        if reached:
            reached()
    return tuple(points)


def _from(cell: Cell, pressure_MPa: float, start: State, bends: bool) -> Solved:
    return minimise(lambda at: cell.potential(at, pressure_MPa), start, free=(bends, True), tolerance=TOLERANCE)


def _sum(a: State, b: State, times: float = 1.0) -> State:
    return State(a.fields + times * b.fields, a.k + times * b.k, a.lam + times * b.lam)
