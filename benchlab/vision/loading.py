"""Loading cycles in a pressure trace, and the angle at a pressure in each of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.vision.picture import FloatArray

IntArray = NDArray[np.int64]

BEGUN, ENDED = 0.6, 0.4
"""Shares of the wanted pressure: a cycle is counted when the pressure rises above the one, having been below the other."""

HOLD_FRAMES = 3
"""Fewest frames in a row within the tolerance that are called a hold."""

OVERSHOOT = 1.1
"""A regulator may overshoot to this many times the pressure before it holds; beyond, the pressure is moving on."""

WIDEST_GAP = 0.1
"""Share of the wanted pressure that may lie between the two frames of an interpolation when frames between them failed."""


@dataclass(frozen=True)
class Trace:
    """T frames in order of time. pressure_MPa: (T,) NaN where unknown. angle, sd: (T,) in one unit, NaN where not measured.

    sure: (T,) bool, frames without doubt; the others are used only where no sure one would do.
    """

    pressure_MPa: FloatArray
    angle: FloatArray
    sd: FloatArray
    sure: NDArray[np.bool_]


@dataclass(frozen=True)
class Cycle:
    """Frames `start` to `stop` (exclusive) of a trace: from the end of the rest before the rise to the next one.

    peak: the frame of the largest pressure.
    """

    start: int
    peak: int
    stop: int


@dataclass(frozen=True)
class Reading:
    """An angle at a pressure. frames: those that it is from. method: `held`, `interpolated`, or "" where there is none:
    then `why` says why, and angle and sd are NaN."""

    angle: float
    sd: float
    method: str
    frames: tuple[int, ...] = ()
    why: str = ""


def find_cycles(pressure_MPa: FloatArray, wanted_MPa: float) -> tuple[Cycle, ...]:
    """The loading cycles of a trace (T,), NaN where unknown, that come near the wanted pressure (> 0).

    A cycle is counted where the pressure rises above 0.6 of the wanted pressure; the next one needs a fall below 0.4 of it.
    Between two, the last frame of the lowest pressure parts them.

    >>> [(c.start, c.peak, c.stop) for c in find_cycles(np.array([0, 0, 1, 2, 2, 0, 0, 2, 0.0]), 2.0)]
    [(1, 3, 6), (6, 7, 9)]
    """
    known = np.flatnonzero(np.isfinite(pressure_MPa))
    begun: list[int] = []
    low = True
    for i in known:
        if low and pressure_MPa[i] >= BEGUN * wanted_MPa:
            begun.append(int(i))
            low = False
        elif pressure_MPa[i] <= ENDED * wanted_MPa:
            low = True
    if not begun:
        return ()
    edges = zip([int(known[0]), *begun[:-1]], begun)
    starts = [_last_lowest(pressure_MPa, first, last + 1) for first, last in edges]
    stops = [*starts[1:], len(pressure_MPa)]
    return tuple(
        Cycle(start, start + int(np.nanargmax(pressure_MPa[start:stop])), stop) for start, stop in zip(starts, stops)
    )


def angle_at(wanted_MPa: float, tolerance_MPa: float, trace: Trace, cycle: Cycle) -> Reading:
    """The angle of one cycle at the wanted pressure.

    Where the pressure is held within the tolerance of it: the mean over that hold. Else, interpolated between the two frames
    in which the rising pressure passes it. The standard deviation is the mean of those of the frames, as if their errors were
    wholly alike, which those of the scale are: an upper bound.

    >>> p, a = np.array([0, 1, 2, 3, 3, 3, 0.0]), np.array([0, 10, 20, 30, 31, 32, 0.0])
    >>> trace, (cycle,) = Trace(p, a, 0 * a + 0.5, np.ones(7, bool)), find_cycles(p, 3.0)
    >>> angle_at(3.0, 0.1, trace, cycle)
    Reading(angle=31.0, sd=0.5, method='held', frames=(3, 4, 5), why='')
    >>> angle_at(1.5, 0.1, trace, cycle)
    Reading(angle=15.0, sd=0.5, method='interpolated', frames=(1, 2), why='')
    """
    peak = float(trace.pressure_MPa[cycle.peak])
    if peak < wanted_MPa - tolerance_MPa:
        return _none(f"its peak of {peak:.4g} MPa does not reach {wanted_MPa:g} MPa")
    measured = np.isfinite(trace.angle)
    hold = _hold(wanted_MPa, tolerance_MPa, trace.pressure_MPa, cycle)
    if hold is not None:
        sure = hold[(measured & trace.sure)[hold]]
        frames = sure if len(sure) else hold[measured[hold]]
        if not len(frames):
            return _none(f"no frame was measured while {wanted_MPa:g} MPa were held")
        angle, sd = float(trace.angle[frames].mean()), float(trace.sd[frames].mean())
        return Reading(angle, sd, "held", tuple(frames.tolist()))
    rise = np.arange(cycle.start, cycle.peak + 1)
    rise = rise[np.isfinite(trace.pressure_MPa[rise])]
    reached = min(wanted_MPa, peak)
    reading = _interpolated(reached, tolerance_MPa, trace, rise, measured & trace.sure)
    return reading if reading.method else _interpolated(reached, tolerance_MPa, trace, rise, measured)


def rising_curve(at_MPa: FloatArray, tolerance_MPa: float, trace: Trace, cycles: tuple[Cycle, ...]) -> FloatArray:
    """(P,) the angle at each pressure of `at_MPa` (P,) on the rise, mean over the cycles; NaN where none has it.

    As `angle_at` has it, but where the pressure is held, of the first frames of the hold alone: an actuator that creeps while it is held
    goes up at one pressure, and a curve with the mean of that would turn up at its end.
    """
    rows = [
        [_on_the_rise(angle_at(p, tolerance_MPa, trace, cycle), trace) for p in at_MPa.tolist()] for cycle in cycles
    ]
    found = np.array(rows, dtype=float).reshape(len(cycles), len(at_MPa))
    count = np.isfinite(found).sum(axis=0)
    return np.where(count > 0, np.nansum(found, axis=0) / np.maximum(count, 1), np.nan)


def _on_the_rise(reading: Reading, trace: Trace) -> float:
    frames = list(reading.frames[:HOLD_FRAMES])
    return float(trace.angle[frames].mean()) if reading.method == "held" else reading.angle


def _last_lowest(pressure: FloatArray, first: int, stop: int) -> int:
    part = pressure[first:stop]
    return first + int(np.flatnonzero(part == np.nanmin(part))[-1])


def _hold(wanted: float, tolerance: float, pressure: FloatArray, cycle: Cycle) -> IntArray | None:
    """Frames of the longest stretch within the tolerance of the wanted pressure that does not drift through it, from the first to the
    last that comes within half the tolerance of its median: those before still rise, those after fall."""
    part = pressure[cycle.start : cycle.stop]
    gone = np.flatnonzero(part > max(OVERSHOOT * wanted, wanted + 2 * tolerance))
    part = part[: gone[0]] if len(gone) else part
    inside = np.concatenate([[False], np.abs(part - wanted) <= tolerance * (1 + 1e-9), [False]])
    edges = np.flatnonzero(np.diff(inside.astype(int)))
    for first, stop in sorted(zip(edges[::2], edges[1::2]), key=lambda run: int(run[0] - run[1])):
        third = max(1, (stop - first) // 3)
        drift = np.median(part[stop - third : stop]) - np.median(part[first : first + third])
        if stop - first >= HOLD_FRAMES and abs(drift) <= tolerance:
            held = np.flatnonzero(part[first:stop] >= np.median(part[first:stop]) - tolerance / 2)
            return np.arange(first + held[0], first + held[-1] + 1) + cycle.start
    return None


def _interpolated(wanted: float, tolerance: float, trace: Trace, rise: IntArray, usable: NDArray[np.bool_]) -> Reading:
    """Between the last usable frame before the pressure reaches the wanted one and the first from there on."""
    pressure = trace.pressure_MPa
    first = int(np.flatnonzero(pressure[rise] >= wanted)[0])
    before, after = rise[:first][usable[rise[:first]]], rise[first:][usable[rise[first:]]]
    if first == 0 and pressure[rise[0]] - wanted > tolerance:
        return _none(f"the record of this cycle starts at {pressure[rise[0]]:.4g} MPa")
    if not len(after) or not (len(before) or first == 0):
        return _none(f"no frame was measured {'above' if len(before) else 'below'} {wanted:g} MPa on the rise")
    b = int(after[0])
    if first == 0 or pressure[b] == wanted:
        return Reading(float(trace.angle[b]), float(trace.sd[b]), "interpolated", (b,))
    a = int(before[-1])
    step = float(pressure[b] - pressure[a])
    if np.count_nonzero((rise > a) & (rise < b)) and step > WIDEST_GAP * wanted:
        return _none(f"no frame was measured between {pressure[a]:.4g} and {pressure[b]:.4g} MPa on the rise")
    share = min(1.0, (wanted - float(pressure[a])) / step) if step > 0 else 1.0
    angle, sd = ((1 - share) * float(values[a]) + share * float(values[b]) for values in (trace.angle, trace.sd))
    return Reading(angle, sd, "interpolated", (a, b))


def _none(why: str) -> Reading:
    return Reading(math.nan, math.nan, "", (), why)
