"""Where the record of a run has holes: ticks of the plan of which no sample is left."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import counted
from benchlab.io.journal import Journal


@dataclass(frozen=True)
class Gap:
    """after: index of the last sample before it. ticks: that are missing. begin_s, end_s: times of the samples on its sides."""

    after: int
    ticks: int
    begin_s: float
    end_s: float

    @property
    def words(self) -> str:
        """In words.

        >>> Gap(699, 48, 6.99, 7.48).words
        'no sample of 48 ticks between 6.990 and 7.480 s'
        """
        return f"no sample of {counted(self.ticks, 'tick')} between {self.begin_s:.3f} and {self.end_s:.3f} s"


def gaps_of(journal: Journal) -> list[Gap]:
    """The holes between the first sample and the last. A tick that was held in a pause has several samples, which is none."""
    samples = journal.samples
    tick, time_s = samples["tick"].astype(np.int64), samples["time_s"]
    return [
        Gap(int(i), int(tick[i + 1] - tick[i] - 1), float(time_s[i]), float(time_s[i + 1]))
        for i in np.flatnonzero(np.diff(tick) > 1)
    ]


def broken(values: NDArray[np.void], gaps: list[Gap]) -> NDArray[np.void]:
    """Samples (T,) with a row in each hole whose numbers are not known, so that no line is drawn across it."""
    blank = np.zeros(1, values.dtype)
    for name in values.dtype.names or ():
        if values.dtype[name].kind == "f":
            blank[name] = np.nan
    return np.insert(values, [gap.after + 1 for gap in gaps], blank[0])
