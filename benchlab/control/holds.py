"""The stretches of a run in which its pressure was held."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchlab.units import FloatArray

SAME_MPA = 1e-6
"""Commands that differ by less are the same; a step of the DAC is a hundred times as large."""


@dataclass(frozen=True)
class Hold:
    """Samples first to last, both included, with the same commanded pressure."""

    first: int
    last: int
    pressure_MPa: float


def find_holds(time_s: FloatArray, command_MPa: FloatArray, least_s: float) -> list[Hold]:
    """Holds of at least least_s in the commanded pressure (T,) over time_s (T,), in order of time.

    >>> find_holds(np.arange(6.0), np.array([0.1, 0.1, 0.1, 0.15, 0.2, 0.2]), 2.0)
    [Hold(first=0, last=2, pressure_MPa=0.1)]
    """
    if len(time_s) == 0:
        return []
    edges = np.flatnonzero(np.abs(np.diff(command_MPa)) > SAME_MPA)
    firsts = np.concatenate([[0], edges + 1])
    lasts = np.concatenate([edges, [len(time_s) - 1]])
    return [
        Hold(int(a), int(b), float(command_MPa[a]))
        for a, b in zip(firsts, lasts)
        if time_s[b] - time_s[a] >= least_s - 1e-9
    ]
