"""The states of a cell from those of its neighbour: the same mesh, laminated a little otherwise."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchlab.simulation import newton
from benchlab.simulation.cell import Cell, State
from benchlab.simulation.newton import Solved
from benchlab.simulation.response import Path, PathPoint, extrapolated, follow, moment_Nmm

TOLERANCE = 3e-3
"""Of a last step; a path from the round tube has 1e-5. With 1e-2 a film half as stiff comes out up to 0.13° off, with 1e-3 0.001°."""


@dataclass(frozen=True)
class Neighbour:
    """The states of a cell, free and held straight; those of a cell like it are found beside them."""

    free: Path
    held: Path | None = None


def neighbour_at(value: float, known: Mapping[float, Neighbour]) -> Neighbour:
    """About where the states of a cell are at one value of a property, from those at others: a polynomial through the nearest three.

    known: by value. States that only some of them have, or that are not of one mesh, are left out.
    """
    nearest = {at: known[at] for at in sorted(known, key=lambda each: abs(each - value))[:3]}
    held = {at: each.held for at, each in nearest.items() if each.held is not None}
    free = _path_at(value, {at: each.free for at, each in nearest.items()})
    return Neighbour(free, _path_at(value, held) if len(held) == len(nearest) else None)


def _path_at(value: float, paths: Mapping[float, Path]) -> Path:
    """The polynomial through states of the same pressure and mesh (Lagrange)."""
    states = {at: {point.pressure_MPa: point.state for point in path.points} for at, path in paths.items()}
    weights = {at: math.prod((value - other) / (at - other) for other in paths if other != at) for at in paths}
    first, *others = states.values()
    shared = [p for p in first if all(p in o and o[p].fields.shape == first[p].fields.shape for o in others)]
    return Path(tuple(PathPoint(p, _mixed([(weights[at], states[at][p]) for at in paths]), 0.0) for p in shared), None)


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
    round tube; beside a neighbour to its tolerance.
    """
    states = {point.pressure_MPa: point.state for point in beside.points} if beside else {}
    if all(p in states and len(states[p].fields) == len(cell.held) for p in pressures_MPa):
        points = _beside(cell, [(float(p), states[p]) for p in pressures_MPa], held_k, reached)
        if points is not None:
            return Path(points, None)
    return follow(cell, pressures_MPa, held_k, reached, TOLERANCE if beside else newton.TOLERANCE)


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
    at_pressure = functools.partial(cell.potential, pressure_MPa=pressure_MPa)
    return newton.minimise(at_pressure, start, free=(bends, True), tolerance=TOLERANCE, look=not bends)


def _mixed(parts: Sequence[tuple[float, State]]) -> State:
    return State(
        np.asarray(sum(w * s.fields for w, s in parts)),
        sum(w * s.k for w, s in parts),
        sum(w * s.lam for w, s in parts),
    )


def _sum(a: State, b: State, times: float = 1.0) -> State:
    return State(a.fields + times * b.fields, a.k + times * b.k, a.lam + times * b.lam)
