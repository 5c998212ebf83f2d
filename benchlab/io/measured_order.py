"""Whether the rows of a run are of one run: where its time begins again, or its numbers jump to and fro, they may be of several.

Where the table says whose and of which run each row is, the order of rows says nothing. Where it does not, they have to be in order.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError, counted, printable
from benchlab.io.measured_frame import Rows, values_in
from benchlab.units import FloatArray

MOST_BEHIND = 0.1
"""Share of a run's rows that may have an earlier time than a row before them, as where a clock was set back; also of rows at which its
numbers turn round. A file that steps back more often is in no order of time. Chosen."""

WIDE, SWEPT = 0.1, 0.5
"""Share of a quantity's range by which it goes to and fro where rows of several runs take turns; and of its largest value that the range
must be, and more than LEAST_MPa, so that it is not noise about a standstill."""

LEAST_MPa = 0.01

FEWEST = 3
"""Rows at which either is the case, at least."""


def check_one_run(rows: Rows, name: tuple[str, str, str]) -> None:
    """rows: of one run, in the order of time. Raises InputError, with the line, where they are of several that cannot be told apart."""
    if "time_s" not in rows.frame:
        return
    time, line = rows.frame["time_s"].to_numpy(), rows.frame.index.to_numpy()
    filed = np.argsort(line, kind="stable")
    behind = time[filed] < np.maximum.accumulate(time[filed])
    back = np.flatnonzero(np.diff(time[filed]) < 0)
    in_order = len(back) <= MOST_BEHIND * len(time)
    if behind.sum() >= FEWEST and behind.mean() > MOST_BEHIND and (rows.unsaid or in_order):
        at = int(filed[back[0] + 1])
        what = f"goes back from {time[filed[back[0]]]:g} s to {time[at]:g} s, {counted(len(back), 'time')} in all"
        raise _refused(rows, name, f"time of {run_words(name)} {what}", at)
    if not rows.unsaid or not LEAST_MPa < _swept(rows.frame[rows.x].to_numpy()) < np.inf:
        return
    for key in [rows.x, *values_in(rows.frame)]:
        turns = _to_and_fro(rows.frame[key].to_numpy())
        if len(turns) >= FEWEST and len(turns) > MOST_BEHIND * len(time):
            what = f"{key} of {run_words(name)} goes to and fro from row to row in the order of time, {counted(len(turns), 'time')} in all"
            raise _refused(rows, name, what, int(turns[0]))


def _to_and_fro(values: FloatArray) -> NDArray[np.int64]:
    """Rows between two wide steps in opposite directions."""
    step = np.diff(values)
    both = np.minimum(abs(step[:-1]), abs(step[1:]))
    return 1 + np.flatnonzero((step[:-1] * step[1:] < 0) & (both > WIDE * _swept(values)))


def _swept(values: FloatArray) -> float:
    """The range of the values; infinite where it is small beside them."""
    known = values[np.isfinite(values)]
    width = float(np.ptp(known)) if len(known) else 0.0
    return width if width > SWEPT * float(np.max(abs(known), initial=0.0)) else np.inf


def run_words(name: tuple[str, str, str]) -> str:
    """name: design, sample and run."""
    return printable(f"run {name[2]} of {name[0]} {name[1]}")


def _refused(rows: Rows, name: tuple[str, str, str], what: str, at: int) -> InputError:
    return rows.refused(
        what, at, remedy(rows, "does time begin again in each cycle? name each run, and let time go on")
    )


def remedy(rows: Rows, named: str) -> str:
    """What to do where rows seem to be of several runs; named: where the table says all of design, sample and run."""
    if not rows.unsaid:
        return named
    there = ", ".join(printable(key) for key in rows.frame if key not in rows.unsaid)
    none = " and no column ".join(rows.unsaid)
    return f"there is no column {none} (but {there}): add it where these are several runs; of one run, give its rows in the order of time"
