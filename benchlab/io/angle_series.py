"""Bending angle over time that another instrument saw: a run file of `benchlab analyze`, or a table with time_s and angle_deg."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchlab.errors import InputError
from benchlab.io.delimited import open_table
from benchlab.io.hdf5 import is_hdf5
from benchlab.io.numbers import NumberReader
from benchlab.io.run_file import read_run_file
from benchlab.units import FloatArray


@dataclass(frozen=True)
class AngleSeries:
    """angle_deg (A,) over time_s (A,), NaN where it was not measured."""

    time_s: FloatArray
    angle_deg: FloatArray


def read_angle_series(path: Path) -> AngleSeries:
    """Read one.

    Raises UsageError or InputError for a missing or damaged file, for stills, which have no time, and for a time that goes back.
    """
    if is_hdf5(path):
        series = read_run_file(path).series
        found = AngleSeries(series.time_s, np.degrees(series.angle_rad))
        if not np.isfinite(found.time_s).all():
            raise InputError("stills have no time", file=path, hint="film the run, and analyze the film")
    else:
        found = _read_table(path)
    back = np.flatnonzero(np.diff(found.time_s) < 0)
    if len(back):
        at = int(back[0])
        raise InputError(f"time goes back, from {found.time_s[at]:g} s to {found.time_s[at + 1]:g} s", file=path)
    return found


def _read_table(path: Path) -> AngleSeries:
    with open_table(path) as table:
        missing = [name for name in ("time_s", "angle_deg") if table.header.count(name) != 1]
        if missing:
            hint = "name the columns time_s and angle_deg, once each"
            raise InputError(
                f"without one column {missing[0]}", file=path, where=f"line {table.header_line}", hint=hint
            )
        at = [table.header.index(name) for name in ("time_s", "angle_deg")]
        reader = NumberReader(path, table.delimiter)
        rows = [[reader.read(cells[i], line) for i in at] for line, cells in table.rows]
    if reader.unreadable:
        line, text = reader.unreadable[0]
        raise InputError(f"not a number: {text!r}", file=path, where=f"line {line}")
    values = np.array(rows, dtype=float).reshape(-1, 2)
    values = values[np.isfinite(values[:, 0])]
    if len(values) < 2:
        raise InputError("fewer than two rows with a time", file=path, hint="is this the table of a run?")
    return AngleSeries(values[:, 0], values[:, 1])
