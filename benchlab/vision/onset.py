"""When a recorded quantity begins to move, so that two clocks can be brought together."""

from __future__ import annotations

import numpy as np

from benchlab.errors import InputError
from benchlab.vision.picture import FloatArray

LOW, HIGH = 0.03, 0.12  # of the whole change: the stretch that is carried back to the level at rest


def find_onset(time_s: FloatArray, values: FloatArray) -> float:
    """Time at which `values` (T,) leave their level at the start: the line through their first rise, carried back.

    NaN values are passed over. Raises InputError where nothing moves.

    >>> time = np.linspace(0, 3, 301)
    >>> round(find_onset(time, np.clip(time - 0.5, 0, None)), 2)
    0.5
    """
    known = np.isfinite(values) & np.isfinite(time_s)
    time, value = time_s[known], values[known]
    if len(time) < 4:
        raise InputError("too few points to find when the motion starts", hint="give --sync SECONDS")
    rest = float(value[:2].mean())
    change = value - rest
    furthest = int(np.argmax(np.abs(change)))
    share = change[: furthest + 1] / change[furthest] if change[furthest] else np.zeros(1)
    jitter = 1.4826 * np.median(np.abs(np.diff(value))) if len(value) > 1 else 0.0
    if abs(change[furthest]) <= max(10 * jitter, 1e-12):
        raise InputError("nothing moves, so there is no onset of motion", hint="give --sync SECONDS")
    low, high = (_last_crossing(time[: furthest + 1], share, level) for level in (LOW, HIGH))
    return float(max(low - LOW * (high - low) / (HIGH - LOW), time[0]))


def _last_crossing(time: FloatArray, share: FloatArray, level: float) -> float:
    """Time of the last rise of `share` through `level`, interpolated."""
    below = np.flatnonzero(share < level)
    if not len(below) or below[-1] + 1 >= len(share):
        return float(time[0])
    i = int(below[-1])
    return float(time[i] + (level - share[i]) / (share[i + 1] - share[i]) * (time[i + 1] - time[i]))
