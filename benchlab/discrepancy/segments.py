"""A run cut where its pressure turns: loadings, unloadings, holds."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from benchlab.units import FloatArray

TOLERANCE = 0.02
"""A straight piece stays this close to the pressure, as a share of the run's range."""

HOLD = 0.03
"""A piece that changes by less than this share of the range, and lasts, is a hold."""

BLUNT = 0.3
"""A stop shorter than this share of the ramps beside it is a blunt turn."""

BLUNTER, SCRAP, FEW = 0.6, 0.2, 8
"""The same of a stop in which the pressure moves, as it does behind a lag, and of ramps over less than SCRAP of a ramp beside: noise there.
Of FEW readings at most, one longer piece beside it is enough: its other neighbour may be such a scrap itself."""

STOPS = ("hold", "rest")

MOST_PIECES = 200
"""A run with more is no ramps and holds; it is taken as a whole (chosen)."""


@dataclass(frozen=True)
class Segment:
    """Points first to last (inclusive) of a run. direction: loading, unloading, hold or rest (a hold without pressure); all without a time.

    cycle: from 1, grows with each loading from rest or after an unloading. rate_MPa_s: mean, positive, NaN in a hold.
    start_MPa, end_MPa: medians of three readings about the ends.
    """

    first: int
    last: int
    direction: str
    cycle: int
    rate_MPa_s: float
    start_MPa: float
    end_MPa: float
    duration_s: float


def segments_of(time_s: FloatArray, pressure_MPa: FloatArray) -> list[Segment]:
    """The segments of a run, in order. time_s, pressure_MPa: (N,), finite, time growing; or all the same: then there is one segment.

    >>> t = np.linspace(0, 30, 301)
    >>> [s.direction for s in segments_of(t, np.interp(t, [0, 10, 20, 30], [0, 0.3, 0.3, 0]))]
    ['loading', 'hold', 'unloading']
    """
    span = float(np.ptp(pressure_MPa))
    if len(time_s) < 2 or span == 0:
        return []
    if not np.ptp(time_s) > 0:
        ends = float(pressure_MPa[0]), float(pressure_MPa[-1])
        return [Segment(0, len(time_s) - 1, "all", 1, np.nan, *ends, 0.0)]
    noise = _noise(pressure_MPa)
    corners = _corners(time_s, pressure_MPa, max(TOLERANCE * span, 4 * noise))
    pieces = [(a, b, _direction(time_s, pressure_MPa, a, b, span)) for a, b in pairwise(corners)]
    merged: list[tuple[int, int, str]] = []
    for first, last, direction in pieces:
        if merged and merged[-1][2] == direction:
            merged[-1] = (merged[-1][0], last, direction)
        else:
            merged.append((first, last, direction))
    return _numbered(time_s, pressure_MPa, _without_blunt_turns(time_s, pressure_MPa, merged, noise))


def _without_blunt_turns(
    time_s: FloatArray, pressure_MPa: FloatArray, pieces: list[tuple[int, int, str]], noise_MPa: float
) -> list[tuple[int, int, str]]:
    """Stops and scraps that are short beside the pieces around them are none: the turn is at their highest (lowest) point."""
    kept, span = list(pieces), float(np.ptp(pressure_MPa))

    def lasts(piece: tuple[int, int, str]) -> float:
        return float(time_s[piece[1]] - time_s[piece[0]])

    def moves(piece: tuple[int, int, str]) -> float:
        return float(np.ptp(pressure_MPa[piece[0] : piece[1] + 1]))

    def none_beside(piece: tuple[int, int, str], around: list[tuple[int, int, str]], through: bool) -> bool:
        sides, moved = [lasts(one) for one in around], moves(piece)
        largest = max((moves(one) for one in around if one[2] not in STOPS), default=0.0)
        if piece[2] not in STOPS and moved >= SCRAP * largest:
            return False
        if through or (piece[2] in STOPS and moved < HOLD * span + 6 * noise_MPa):
            return lasts(piece) < BLUNT * (sum(sides) if through else min(sides))
        return lasts(piece) < BLUNTER * (max(sides) if piece[1] - piece[0] <= FEW else min(sides))

    i = 1
    while i < len(kept) - 1:
        (first, last, _), (start, _, before), (_, end, after) = kept[i], kept[i - 1], kept[i + 1]
        if not none_beside(kept[i], [kept[i - 1], kept[i + 1]], before == after):
            i += 1
            continue
        if before == after:
            kept[i - 1 : i + 2] = [(start, end, before)]
            i = max(i - 1, 1)
            continue
        piece = pressure_MPa[first : last + 1]
        turn = first + int(np.argmax(piece) if before == "loading" or after == "unloading" else np.argmin(piece))
        kept[i - 1 : i + 2] = [(start, turn, before), (turn, end, after)]
    while len(kept) > 1 and kept[0][1] - kept[0][0] <= FEW and none_beside(kept[0], [kept[1]], False):
        kept[:2] = [(kept[0][0], kept[1][1], kept[1][2])]
    return kept


def _numbered(time_s: FloatArray, pressure_MPa: FloatArray, pieces: list[tuple[int, int, str]]) -> list[Segment]:
    found, cycle, fell = [], 0, True
    for first, last, direction in pieces:
        if direction == "loading" and fell:
            cycle, fell = cycle + 1, False
        fell = fell or direction == "unloading"
        start, end = (float(np.median(pressure_MPa[max(i - 1, 0) : i + 2])) for i in (first, last))
        duration = float(time_s[last] - time_s[first])
        rate = abs(end - start) / duration if direction in ("loading", "unloading") and duration > 0 else np.nan
        found.append(Segment(first, last, direction, max(cycle, 1), rate, start, end, duration))
    return found


def _direction(time_s: FloatArray, pressure_MPa: FloatArray, first: int, last: int, span: float) -> str:
    change = float(np.median(pressure_MPa[max(last - 2, 0) : last + 1]) - np.median(pressure_MPa[first : first + 3]))
    if abs(change) < HOLD * span:
        level = float(np.mean(pressure_MPa[first : last + 1]) - np.min(pressure_MPa))
        return "rest" if level < 2 * HOLD * span else "hold"
    return "loading" if change > 0 else "unloading"


def _noise(pressure_MPa: FloatArray) -> float:
    """Standard deviation of white noise on the pressure, from its second differences."""
    if len(pressure_MPa) < 5:
        return 0.0
    return float(1.4826 * np.median(np.abs(np.diff(pressure_MPa, 2))) / np.sqrt(6))


def _corners(time_s: FloatArray, pressure_MPa: FloatArray, tolerance: float) -> list[int]:
    """Ends of the straight pieces that stay within the tolerance (Douglas and Peucker 1973, along the pressure)."""
    keep: NDArray[np.bool_] = np.zeros(len(time_s), dtype=bool)
    keep[[0, -1]] = True
    stack = [(0, len(time_s) - 1)]
    while stack:
        first, last = stack.pop()
        if last - first < 2:
            continue
        t, p = time_s[first : last + 1], pressure_MPa[first : last + 1]
        chord = p[0] + (p[-1] - p[0]) * (t - t[0]) / (t[-1] - t[0])
        off = np.abs(p - chord)
        worst = int(np.argmax(off))
        if off[worst] > tolerance:
            keep[first + worst] = True
            stack += [(first, first + worst), (first + worst, last)]
    return [int(i) for i in np.flatnonzero(keep)]
