"""The states of a cell from those of its neighbour: the same mesh, laminated a little otherwise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from benchlab.simulation.cell import Cell, State
from benchlab.simulation.newton import minimise
from benchlab.simulation.response import Path, PathPoint, extrapolated, follow, moment_Nmm

TOLERANCE = 1e-3
"""Of a last step, against 1e-5 of a path from the round tube: the state is good to about 1e-6, far below what a curve shows."""


def follow_beside(cell: Cell, beside: Sequence[PathPoint], held_k: float | None = None) -> Path:
    """Stable states of `cell` at the pressures of a neighbour's states, as `response.follow` would find them in twice the time.

    Each search begins at the neighbour's state, moved by how the states before it were moved (a polynomial in the pressure). Where
    one is not found, or the meshes differ, the whole path is followed from the round tube.
    """
    if beside and len(beside[0].state.fields) == len(cell.held):
        points = _beside(cell, beside, held_k)
        if points is not None:
            return Path(points, None)
    return follow(cell, [point.pressure_MPa for point in beside], held_k)


def _beside(cell: Cell, beside: Sequence[PathPoint], held_k: float | None) -> tuple[PathPoint, ...] | None:
    moved: list[tuple[float, State]] = []
    points: list[PathPoint] = []
    for point in beside:
        pressure, start = point.pressure_MPa, point.state
        if moved:
            start = _sum(start, extrapolated(moved[-3:], pressure))
        if held_k is not None:
            start = replace(start, k=held_k)
        solved = minimise(
            lambda at, p=pressure: cell.potential(at, p),  # type: ignore[misc]
            start,
            free=(held_k is None, True),
            tolerance=TOLERANCE,
        )
        if not solved.converged:
            return None
        moved.append((pressure, _sum(solved.state, point.state, -1.0)))
        moment = 0.0 if held_k is None else moment_Nmm(cell, solved)
        points.append(PathPoint(pressure, solved.state, moment))
    return tuple(points)


def _sum(a: State, b: State, times: float = 1.0) -> State:
    return State(a.fields + times * b.fields, a.k + times * b.k, a.lam + times * b.lam)
