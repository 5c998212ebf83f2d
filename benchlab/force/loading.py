"""Loadings in a trace: each stretch in which a force or a pressure rises from its rest and falls back to it.

Nothing is asked of the trace but that it comes back: neither how high it goes, nor how long it stays, nor that its rest is at zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter, uniform_filter1d
from scipy.signal import find_peaks, peak_widths

from benchlab.force.noise import noise_sd
from benchlab.units import FloatArray

IntArray = NDArray[np.int64]

TIMES_NOISE = 10.0
"""A loading stands out by this many standard deviations of the noise."""

LEAST_SHARE = 0.02
"""A loading is at least this share of the range of the trace."""

RETURN = 0.4
"""Between two loadings the trace falls below this share of the lower one; where it does not, they are two bumps of one loading."""

SMOOTHED_SHARE = 10
"""Loadings are looked for in the running mean over this fraction of their usual length."""


@dataclass(frozen=True)
class Loading:
    """Samples `start` to `stop` (exclusive) from the rest before to the rest behind, half way up from `rise` to `fall` (inclusive).

    cut: `start` or `end` where the record begins or ends within it, else "".
    """

    start: int
    rise: int
    fall: int
    stop: int
    cut: str = ""


def find_loadings(values: FloatArray) -> tuple[Loading, ...]:
    """The loadings of a trace (n,), NaN where it is not known, in order; none where it does not stand out of its noise.

    Tops are those whose prominence (height over the higher of the two valleys that part them from higher ones) exceeds ten times the
    noise and 2 % of the range. The first pass finds the usual length of a loading, the second the smaller ones, in the running mean.

    >>> trace = np.repeat([0.0, 5.0, 0.0, 9.0, 0.0], 10)
    >>> [(c.rise, c.fall) for c in find_loadings(trace)]
    [(10, 19), (30, 39)]
    """
    known = np.flatnonzero(np.isfinite(values))
    if len(known) < len(values):
        return tuple(in_record(cycle, known) for cycle in find_loadings(values[known]))
    if len(values) < 3 or np.ptp(values) == 0:
        return ()
    clean = median_filter(values, 3, mode="nearest") if len(values) > 30 else values
    tops = _tops(clean, max(TIMES_NOISE * noise_sd(values), 5 * LEAST_SHARE * np.ptp(clean)))
    if not len(tops):
        return ()
    padded = _padded(clean)
    usual = float(np.median(peak_widths(padded, tops + 1, 0.5)[0]))
    window = max(1, int(usual / SMOOTHED_SHARE)) | 1
    smooth = uniform_filter1d(clean, window, mode="nearest")
    tops = _tops(smooth, max(TIMES_NOISE * noise_sd(values) / window**0.5, LEAST_SHARE * np.ptp(smooth)))
    tops = _parted(smooth, tops)
    return _loadings(smooth, tops)


def in_record(cycle: Loading, known: IntArray) -> Loading:
    """A loading among the known readings (k,) of a record in the numbers of the whole record."""
    start, rise, fall, last = known[[cycle.start, cycle.rise, cycle.fall, cycle.stop - 1]].tolist()
    return Loading(start, rise, fall, last + 1, cycle.cut)


def half_height(values: FloatArray, base: float) -> tuple[int, int]:
    """First and last place where values (n,) are above half way from a base to their largest."""
    above = np.flatnonzero(values >= (base + values.max()) / 2)
    return int(above[0]), int(above[-1])


def _padded(values: FloatArray) -> FloatArray:
    return np.concatenate([[values.min()], values, [values.min()]])


def _tops(values: FloatArray, prominence: float) -> IntArray:
    """Of a trace that lies at its lowest before and behind the record, so that a loading that is cut has a top too."""
    return find_peaks(_padded(values), prominence=max(prominence, 1e-300))[0] - 1


def _parted(smooth: FloatArray, tops: IntArray) -> IntArray:
    """The tops that the trace returns from: of two with a high valley between, the higher is kept."""
    kept = tops.tolist()
    while len(kept) > 1:
        valleys = _valleys(smooth, kept)
        rest = np.minimum(np.minimum(valleys[:-2], valleys[2:]), valleys[1:-1])
        height = np.minimum(smooth[kept[:-1]], smooth[kept[1:]]) - rest
        share = (valleys[1:-1] - rest) / np.maximum(height, 1e-300)
        worst = int(np.argmax(share))
        if share[worst] <= RETURN:
            break
        del kept[worst if smooth[kept[worst]] < smooth[kept[worst + 1]] else worst + 1]
    return np.array(kept, dtype=np.int64)


def _valleys(smooth: FloatArray, tops: list[int]) -> FloatArray:
    """Lowest values before the first top, between tops, and behind the last."""
    edges = [0, *tops, len(smooth) - 1]
    return np.array([smooth[a : b + 1].min() for a, b in pairwise(edges)])


def _loadings(smooth: FloatArray, tops: IntArray) -> tuple[Loading, ...]:
    edges = tops.tolist()
    bounds = [0, *(a + int(np.argmin(smooth[a : b + 1])) for a, b in pairwise(edges)), len(smooth)]
    valleys = _valleys(smooth, edges).tolist()
    found = []
    for top, start, stop, before, after in zip(edges, bounds, bounds[1:], valleys, valleys[1:]):
        lowest = min(before, after)
        half = (lowest + smooth[top]) / 2
        cut = "start" if start == 0 and smooth[0] > half else "end" if stop == len(smooth) and smooth[-1] > half else ""
        base = lowest if cut else max(before, after)
        first, last = half_height(smooth[start:stop], base)
        found.append(Loading(start, start + first, start + last, stop, cut))
    return tuple(found)
