"""Further columns that the user names (`--against`): what they say of each feature."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.measured import Run
from benchlab.units import FloatArray

SEVERAL = "several"
"""What a feature has whose runs have different words."""

Against = Mapping[str, FloatArray | NDArray[np.str_]]
"""By column: of each feature (F,) the mean of its numbers, NaN where there are none; or the word of its runs."""


def against_of(
    runs: Sequence[Run],
    points: Sequence[Mapping[str, FloatArray]],
    feature_of_point: Sequence[NDArray[np.int64]],
    number: int,
) -> Against:
    """points: of each run, by column of numbers, means at its points (P,). feature_of_point: of each run (Q, P) by quantity, −1 for none.

    number: F.
    """
    names = dict.fromkeys(name for run in runs for name in run.against)
    words = {name for run in runs for name, value in run.against.items() if isinstance(value, str)}
    return {
        name: _words(name, runs, feature_of_point, number)
        if name in words
        else _means(name, points, feature_of_point, number)
        for name in names
    }


def _means(
    name: str, points: Sequence[Mapping[str, FloatArray]], places: Sequence[NDArray[np.int64]], number: int
) -> FloatArray:
    total, count = np.zeros(number), np.zeros(number)
    for values, place in zip(points, places):
        if name in values:
            known = (place >= 0) & np.isfinite(values[name])
            total += np.bincount(place[known], np.broadcast_to(values[name], place.shape)[known], minlength=number)
            count += np.bincount(place[known], minlength=number)
    return np.divide(total, count, out=np.full(number, np.nan), where=count > 0)


def _words(name: str, runs: Sequence[Run], places: Sequence[NDArray[np.int64]], number: int) -> NDArray[np.str_]:
    found: list[set[str]] = [set() for _ in range(number)]
    for run, place in zip(runs, places):
        for feature in np.unique(place[place >= 0]):
            found[feature].add(str(run.against.get(name, "")))
    return np.array([next(iter(words)) if len(words) == 1 else SEVERAL for words in found])
