"""What a gap is made of: a course over pressure, what each kind of run has beside it, and loops of directions and cycles.

A missing effect shows in one of the three: a margin in the course, a mounting between kinds, friction in the loops. What is small beside
the whole gap may be most of its part.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from benchlab.discrepancy.features import Feature, Features
from benchlab.discrepancy.segments import STOPS

PARTS = ("course", "kinds", "loops")


def parts_of(features: Features) -> tuple[sparse.csr_array, ...]:
    """One (F, F) for each of PARTS: what takes values of the features to it. They add up to one, and each is orthogonal to the others.

    The course is the mean over all that a design has at one pressure; kinds, the mean of a kind of run there, less the course; loops, the
    rest.
    """
    rows = features.features
    known = np.bincount(features.feature, minlength=len(rows)) > 0
    place = [(row.quantity, row.design, level) for row, level in zip(rows, _levels(rows))]
    course = _means(place, known)
    kinds = _means([(*where, row.kind, row.occurrence) for where, row in zip(place, rows)], known)
    everything = sparse.eye_array(len(rows))
    return course, sparse.csr_array(kinds - course), sparse.csr_array(everything - kinds)


def _levels(rows: Sequence[Feature]) -> list[int]:
    """Interval of pressure of each feature; of a hold or a rest, the interval of ramps whose mean pressure is nearest."""
    ramps: dict[int, list[float]] = {}
    for row in rows:
        if row.direction not in STOPS:
            ramps.setdefault(row.bin, []).append(row.pressure_MPa)
    middle = {level: float(np.mean(pressures)) for level, pressures in ramps.items()}

    def level(row: Feature) -> int:
        if row.direction not in STOPS:
            return row.bin
        return min(middle, key=lambda at: abs(middle[at] - row.pressure_MPa), default=0)

    return [level(row) for row in rows]


def _means(groups: Sequence[Hashable], known: NDArray[np.bool_]) -> sparse.csr_array:
    """(F, F): takes values to the mean over their group, of those that are known."""
    number = {group: i for i, group in enumerate(dict.fromkeys(groups))}
    shape = (len(number), len(groups))
    member = sparse.csr_array(
        (known.astype(float), ([number[group] for group in groups], np.arange(len(groups)))), shape
    )
    share = sparse.diags_array(1 / np.maximum(member.sum(axis=1), 1))
    return sparse.csr_array(member.T @ share @ member)
