"""A run of thousands of readings as a few dozen points: at each turn one, in each interval of pressure a few."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.measured import Run
from benchlab.discrepancy.segments import STOPS, Segment
from benchlab.units import FloatArray

BINS = 8
"""Intervals of pressure, up to the study's largest."""

HOLD_EDGES = (0.0, 0.05, 0.2, 0.5, 1.0)
"""Intervals of a hold, as shares of its duration."""

POINTS, POINTS_AFTER_A_TURN = 3, 8
"""Points at which a model is evaluated, per interval; more in the first two after a turn, where lags and loops show."""

DIRECTIONS = ("all", "hold", "loading", "rest", "unloading")
LAST_CYCLE = 4
"""Cycles from this one on are taken together."""


@dataclass(frozen=True)
class Points:
    """The P points of one run, and the interval that each belongs to: cycle, direction, bin (P,), −1 for none; rates of the segments (P,).

    values, counts: by quantity, (P,): mean of the readings, NaN without one, and their number. against: means of further columns.
    """

    time_s: FloatArray
    pressure_MPa: FloatArray
    command_MPa: FloatArray
    temperature_C: FloatArray
    cycle: NDArray[np.int64]
    direction: NDArray[np.int64]
    bin: NDArray[np.int64]
    rate_MPa_s: FloatArray
    values: dict[str, FloatArray]
    counts: dict[str, FloatArray]
    against: dict[str, FloatArray]


def points_of(run: Run, cut: Sequence[Segment], top_MPa: float) -> Points:
    """Readings taken together to points: at each turn one, in each interval a few."""
    starts, about = [0], [(1, DIRECTIONS.index("all"), 0, np.nan)]
    if cut:
        starts, about = [], []
    turns = bool(cut) and cut[0].direction != "all"
    for segment in cut:
        if turns:
            starts.append(segment.first)
            about.append((-1, -1, -1, np.nan))
        for place, (first, last, number) in enumerate(_intervals(run, segment, top_MPa)):
            wanted = min(POINTS_AFTER_A_TURN if place < 2 else POINTS, last - first)
            cycle = -1 if segment.direction == "rest" else min(segment.cycle, LAST_CYCLE)
            told = (cycle, DIRECTIONS.index(segment.direction), number, segment.rate_MPa_s)
            starts += [first + (last - first) * i // wanted for i in range(wanted)]
            about += [told] * wanted
    if turns:
        starts.append(cut[-1].last)
        about.append((-1, -1, -1, np.nan))
    end = cut[-1].last + 1 if cut else len(run.time_s)
    at = np.array(starts)
    cycle, direction, number, rate = np.array(about).T

    def mean(values: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        if values is None:
            return np.full(len(at), np.nan), np.zeros(len(at))
        good = np.isfinite(values[:end])
        count = np.add.reduceat(good.astype(float), at)
        total = np.add.reduceat(np.where(good, values[:end], 0.0), at)
        return np.divide(total, count, out=np.full(len(at), np.nan), where=count > 0), count

    means = {quantity: mean(values) for quantity, values in run.values.items()}
    return Points(
        mean(run.time_s)[0],
        mean(run.pressure_MPa)[0],
        mean(run.command_MPa)[0],
        mean(run.temperature_C)[0],
        cycle.astype(int),
        direction.astype(int),
        number.astype(int),
        rate,
        {quantity: found[0] for quantity, found in means.items()},
        {quantity: found[1] for quantity, found in means.items()},
        {name: mean(column)[0] for name, column in run.against.items() if not isinstance(column, str)},
    )


def _intervals(run: Run, segment: Segment, top_MPa: float) -> list[tuple[int, int, int]]:
    """First reading, reading after the last, and number of each interval of a segment, in the order of time."""
    inside = np.arange(segment.first + 1, segment.last)
    if segment.direction == "all":
        inside = np.arange(segment.first, segment.last + 1)
    if len(inside) == 0:
        return []
    if segment.direction in STOPS:
        since = (run.time_s[inside] - run.time_s[segment.first]) / max(segment.duration_s, 1e-12)
        number = np.clip(np.searchsorted(HOLD_EDGES, since, side="right") - 1, 0, len(HOLD_EDGES) - 2)
    else:
        number = np.clip((_level(run, segment, inside, top_MPa) / top_MPa * BINS).astype(int), 0, BINS - 1)
    borders = [0, *(np.flatnonzero(np.diff(number)) + 1), len(inside)]
    return [(int(inside[a]), int(inside[b - 1]) + 1, int(number[a])) for a, b in pairwise(borders)]


def _level(run: Run, segment: Segment, inside: NDArray[np.int64], top_MPa: float) -> FloatArray:
    """Pressure without its noise: the straight line where the segment is one, else the largest (smallest) so far; as it is without time."""
    if segment.direction == "all":
        return run.pressure_MPa[inside]
    ends = [run.time_s[segment.first], run.time_s[segment.last]]
    straight = np.interp(run.time_s[inside], ends, [segment.start_MPa, segment.end_MPa])
    if float(np.max(np.abs(straight - run.pressure_MPa[inside]))) < 0.05 * top_MPa:
        return np.asarray(straight)
    so_far = np.maximum if segment.direction == "loading" else np.minimum
    return np.asarray(so_far.accumulate(run.pressure_MPa[inside]))
