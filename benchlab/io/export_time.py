"""A time that runs backwards or stands still: where it does, and the order that would mend it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError, printable
from benchlab.io.export_numbers import Lines
from benchlab.units import FloatArray


def time_order(
    path: Path, specimen: str, time_s: FloatArray, lines: Lines, sort: bool
) -> tuple[NDArray[np.intp] | None, list[str]]:
    """(order of the rows by time where `sort` is set and they have another, warnings with lines). time_s: (n,), NaN passed over.
    specimen: its name, "" where it is the only one.

    Raises InputError where the time begins again at its start and would be sorted: two tests would be mixed.
    """
    if (time_s[1:] > time_s[:-1]).all():
        return None, []
    rows = np.flatnonzero(np.isfinite(time_s))
    there = time_s[rows]
    step = np.diff(there)
    back, still = np.flatnonzero(step < 0), np.flatnonzero(step == 0)
    again = back[there[back + 1] <= there[0]]
    who = f" of specimen {printable(specimen)!r}" if specimen else ""

    def line(at: int) -> str:
        return f"line {lines[rows[at + 1]]}"

    notes = [f"{line(still[0])}: the time{who} stands still, {_times(still.size)}"] if still.size else []
    if not back.size:
        return None, notes
    if again.size and sort:
        what, hint = f"the time{who} begins again: sorting would mix two tests", "split the file in this line"
        raise InputError(what, file=path, where=line(again[0]), hint=hint)
    at = back[0]
    what = f"{line(at)}: the time{who} runs backwards from {there[at]:g} to {there[at + 1]:g} s, {_times(back.size)}"
    if again.size:
        what = f"{line(again[0])}: the time{who} begins again, {_times(again.size)}; if another test begins here, split the file"
    if sort:
        return np.argsort(time_s, kind="stable"), [*notes, f"{what}; rows were sorted by time"]
    return None, [*notes, f"{what}; rows are left as they are" + ("" if again.size else ", --sort-time sorts them")]


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"
