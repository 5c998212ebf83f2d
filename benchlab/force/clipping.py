"""A load cell at its limit: the trace is cut off flat at one value."""

from __future__ import annotations

import math

import numpy as np

from benchlab.units import FloatArray

LEAST_RUN = 5
"""Fewest equal readings in a row that may be a flat top."""

CHANCE = 1e-9
"""Equal readings in a row are a flat top where their like would come about by chance more rarely than this."""


def clipping_value(force_N: FloatArray) -> float | None:
    """The value at which a trace (n,) is cut off; None where it is not.

    The largest value of the record, if it stands at least five times in a row, and if as many equal neighbours would hardly happen
    with the share of equal neighbours that the rest of the upper half of the record has. A trace whose every hold is exactly level is
    therefore not called clipped.

    >>> swing = 12 * np.sin(np.linspace(0, np.pi, 50))
    >>> clipping_value(np.minimum(swing, 10.0)), clipping_value(swing)
    (10.0, None)
    """
    top = float(force_N.max())
    run = _longest_run(force_N == top)
    if run < LEAST_RUN:
        return None
    upper = force_N[(force_N < top) & (force_N > (top + force_N.min()) / 2)]
    alike = float(np.mean(np.diff(upper) == 0)) if len(upper) > 1 else 0.0
    return top if alike == 0 or (run - 1) * math.log(alike) + math.log(len(force_N)) < math.log(CHANCE) else None


def is_clipped(force_N: FloatArray, value: float | None) -> bool:
    """Whether a part of a trace (n,) reaches the clipping value twice in a row."""
    return value is not None and _longest_run(force_N >= value) > 1


def _longest_run(flags: np.ndarray) -> int:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    return int((edges[1::2] - edges[::2]).max(initial=0))
