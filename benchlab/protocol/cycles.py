"""Which cycle of a run a tick belongs to."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray


def number_cycles(counts: Sequence[Sequence[int]], step: ArrayLike) -> NDArray[np.int64]:
    """(T,) cycle of each tick: from 1, in the order of the plan, a new one wherever the counts change.

    counts: of each step of the plan, which time round of its repeats and cycles it is. step: (T,) index into them. 0 for ticks of a step
    in no repeat; where no step is in one, the whole run is cycle 1.

    >>> number_cycles([(), (1,), (1,), (2,), (2,), ()], [0, 1, 2, 3, 4, 5]).tolist()
    [0, 1, 1, 2, 2, 0]
    >>> number_cycles([(), ()], [0, 1, 1]).tolist()
    [1, 1, 1]
    """
    index = np.asarray(step, dtype=np.int64)
    told = [tuple(each) for each in counts]
    if not any(told):
        return np.ones(len(index), dtype=np.int64)
    number, numbers = 0, []
    before: tuple[int, ...] = ()
    for each in told:
        number += bool(each) and each != before
        before = each
        numbers.append(number if each else 0)
    return np.asarray([*numbers, 0], dtype=np.int64)[np.minimum(index, len(numbers))]
