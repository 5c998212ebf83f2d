"""The pressure of each cycle and the step that it belongs to: from a pressure trace, or from a stated list of steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError
from benchlab.force.loading import Loading
from benchlab.force.noise import shortest_half
from benchlab.units import FloatArray

TOLERANCE = 0.02
"""Share of the largest pressure within which pressures are of one step, where no tolerance is given."""

HELD = 0.05
"""A pressure counts as held where half of a cycle's readings above half height lie within this share of their mean."""


@dataclass(frozen=True)
class Level:
    """The pressure of one cycle. held: its hold was found; else it is the cycle's largest pressure."""

    pressure_MPa: float
    held: bool


def level_of(pressure_MPa: FloatArray, cycle: Loading) -> Level:
    """The pressure of a cycle of a trace (n,), NaN where it is not known: the mean of that half of its readings above half height that
    lies closest together, so that neither the rise nor an overshoot counts; the largest reading where none is held.

    >>> level_of(np.array([0, 3, 6, 5, 5, 5, 5.1, 3, 0]) / 10, Loading(0, 2, 6, 9)).pressure_MPa
    0.5
    """
    part = pressure_MPa[cycle.rise : cycle.fall + 1]
    part = part[np.isfinite(part)]
    half = shortest_half(part)
    mean = float(half.mean())
    held = len(part) > 2 and float(half[-1] - half[0]) <= HELD * mean
    return Level(mean if held else float(part.max()), held)


def cluster(levels_MPa: FloatArray, tolerance_MPa: float) -> NDArray[np.int64]:
    """(P,) which step each pressure (P,) belongs to, from 0 at the lowest: neighbours in size farther apart than the tolerance are of
    two steps. Raises InputError where a step so found is wider than twice the tolerance: then there is no telling where one ends.

    >>> cluster(np.array([0.101, 0.2, 0.1, 0.199]), 0.005).tolist()
    [0, 1, 0, 1]
    """
    order = np.argsort(levels_MPa, kind="stable")
    ordered = levels_MPa[order]
    rank = np.concatenate([[0], np.cumsum(np.diff(ordered) > tolerance_MPa)]).astype(np.int64)
    for step in range(int(rank[-1]) + 1):
        part = ordered[rank == step]
        if part[-1] - part[0] > 2 * tolerance_MPa * (1 + 1e-9):
            raise InputError(
                f"{len(part)} cycles have pressures from {part[0]:.4g} to {part[-1]:.4g} MPa without a gap of {tolerance_MPa:.3g} MPa: "
                "which steps are these?",
                hint="give the steps with --steps-MPa",
            )
    found = np.empty(len(levels_MPa), dtype=np.int64)
    found[order] = rank
    return found


def nearest_steps(levels_MPa: FloatArray, steps_MPa: Sequence[float], tolerance_MPa: float) -> NDArray[np.int64]:
    """(P,) which of the stated steps each pressure (P,) is of. Raises InputError for one that is within the tolerance of none.

    >>> nearest_steps(np.array([0.101, 0.2]), [0.1, 0.2], 0.005).tolist()
    [0, 1]
    """
    steps = np.asarray(steps_MPa, dtype=float)
    found = np.abs(levels_MPa[:, None] - steps).argmin(axis=1)
    off = np.abs(levels_MPa - steps[found])
    if len(off) and off.max() > tolerance_MPa:
        worst = int(off.argmax())
        raise InputError(
            f"cycle {worst + 1} is at {levels_MPa[worst]:.4g} MPa, {off[worst]:.2g} MPa from the nearest step of "
            f"{steps[found[worst]]:g} MPa; {tolerance_MPa:.2g} MPa are allowed",
            hint="are the steps of --steps-MPa those that were set?",
        )
    return found


def stated_steps(count: int, steps: int, cycles: int | None, found: str) -> NDArray[np.int64]:
    """(P,) the step of each of `count` cycles in order of time: so many cycles of the first step, then of the next.

    cycles: of each step, None for as many as there are. found: where the cycles are, for the message. Raises InputError, with both
    numbers, where the count does not fit.

    >>> stated_steps(4, 2, None, "").tolist()
    [0, 0, 1, 1]
    """
    if cycles is None and count and count % steps == 0:
        cycles = count // steps
    if cycles is None or count != steps * cycles:
        each = (
            f"{steps} steps of {cycles} cycles are {steps * cycles}" if cycles else f"{steps} steps do not divide them"
        )
        raise InputError(
            f"{count} whole cycle{'s' * (count != 1)} found, and {each}: {found}",
            hint="look at the trace; then correct --steps-MPa or --cycles, or give the pressure with --pressure",
        )
    return np.repeat(np.arange(steps), cycles)
