"""Angles that somebody else measured, as a table: of one recording or of a whole study, with or without pressure.

Columns, in any order: angle_deg; and, where there are, angle_sd_deg, cycle, a pressure with its unit (`pressure_MPa`, `Pressure (kPa)`),
design and sample. Rows of other designs and samples are passed over, so that one table can serve all of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError
from benchlab.io.delimited import Table, open_table
from benchlab.io.numbers import NumberReader
from benchlab.io.table import unguarded
from benchlab.units import UNITS, FloatArray, parse_column, to_MPa

_NUMBERS = ("angle_deg", "angle_sd_deg", "cycle")
_NAMES = ("design", "sample")


@dataclass(frozen=True)
class AngleTable:
    """R rows of one sample, in the order of the file.

    line: (R,) in the file. cycle: (R,) as told, None without such a column. pressure_MPa: (R,) NaN where a cell is empty, None
    without a column. angle_deg, angle_sd_deg: (R,) NaN where a cell is empty.
    """

    line: NDArray[np.int64]
    angle_deg: FloatArray
    angle_sd_deg: FloatArray
    cycle: NDArray[np.int64] | None
    pressure_MPa: FloatArray | None
    warnings: tuple[str, ...] = ()


def is_series(path: Path) -> bool:
    """Whether this is a table of `benchlab analyze`, a row a frame. Raises UsageError or InputError for what is no table."""
    with open_table(path) as table:
        return {"frame", "time_s", "angle_deg"} <= set(table.header)


def names_samples(path: Path) -> bool:
    """Whether a table says of each row which sample it is of, so that it may serve several. Raises as `is_series`."""
    with open_table(path) as table:
        return "sample" in table.header


def read_angle_table(path: Path, design: str, sample: str) -> AngleTable:
    """The rows of one sample. Raises UsageError or InputError with the line: no angle, no number, no row of the sample, or, where
    there is no pressure, a cycle twice."""
    with open_table(path) as table:
        places = _places(table)
        reader = NumberReader(path, table.delimiter)
        rows: list[tuple[int, list[float]]] = []
        for line, cells in table.rows:
            wanted = {"design": design, "sample": sample}
            if any(unguarded(cells[places[name]].strip()) != wanted[name] for name in _NAMES if name in places):
                continue
            numbers = [reader.read(cells[places[name]], line) for name in places if name not in _NAMES]
            if reader.unreadable:
                raise InputError(f"not a number: {reader.unreadable[0][1]!r}", file=path, where=f"line {line}")
            rows.append((line, numbers))
        if not rows:
            raise _no_rows(path, design, sample, [name for name in _NAMES if name in places])
        left = [name for at, name in enumerate(table.header) if at not in places.values()]
        warnings = table.warnings + ([f"columns not read: {', '.join(left)}"] if left else [])
    names = [name for name in places if name not in _NAMES]
    columns = dict(zip(names, np.array([numbers for _, numbers in rows]).T))
    lines = np.array([line for line, _ in rows])
    pressure = _pressure(path, table, places, columns)
    cycle = _cycles(path, lines, columns)
    if pressure is None and cycle is not None:
        _check_once(path, lines, cycle)
    none = np.full(len(lines), np.nan)
    return AngleTable(lines, columns["angle_deg"], columns.get("angle_sd_deg", none), cycle, pressure, tuple(warnings))


def _no_rows(path: Path, design: str, sample: str, named: list[str]) -> InputError:
    if not named:
        return InputError("no data rows", file=path, hint="the file holds only a header")
    return InputError(
        f"no row of {design} {sample}", file=path, hint=f"is it called so in column {' and '.join(named)}?"
    )


def _places(table: Table) -> dict[str, int]:
    """Which column is what. The pressure is any one whose unit is one of pressure."""
    names = [cell.strip() for cell in table.header]
    places = {name: names.index(name) for name in (*_NAMES, *_NUMBERS) if name in names}
    pressures = [i for i, name in enumerate(names) if parse_column(name)[1] in UNITS["pressure"]]
    where = f"line {table.header_line}"
    if len(pressures) > 1:
        listed = " and ".join(repr(names[i]) for i in pressures)
        raise InputError(f"{len(pressures)} pressure columns: {listed}", file=table.path, where=where, hint="keep one")
    if "angle_deg" not in places:
        listed = ", ".join(repr(name) for name in names[:8])
        hint = "name the column with the angles angle_deg"
        raise InputError(f"no column angle_deg among {listed}", file=table.path, where=where, hint=hint)
    if twice := [name for name in places if names.count(name) > 1]:
        raise InputError(f"column {twice[0]!r} stands twice", file=table.path, where=where, hint="keep one")
    return places | ({"pressure": pressures[0]} if pressures else {})


def _pressure(path: Path, table: Table, places: dict[str, int], columns: dict[str, FloatArray]) -> FloatArray | None:
    if "pressure" not in columns:
        return None
    unit = parse_column(table.header[places["pressure"]])[1]
    return to_MPa(columns["pressure"], unit or "")


def _cycles(path: Path, lines: NDArray[np.int64], columns: dict[str, FloatArray]) -> NDArray[np.int64] | None:
    if "cycle" not in columns:
        return None
    cycle = columns["cycle"]
    wrong = ~(np.isfinite(cycle) & (cycle >= 1) & (cycle == np.round(cycle)))
    if wrong.any():
        where = f"line {lines[int(np.argmax(wrong))]}"
        raise InputError("cycle is not a whole number from 1", file=path, where=where, hint="count cycles as 1, 2, 3")
    return cycle.astype(np.int64)


def _check_once(path: Path, lines: NDArray[np.int64], cycle: NDArray[np.int64]) -> None:
    seen: dict[int, int] = {}
    for line, number in zip(lines.tolist(), cycle.tolist()):
        if number in seen:
            what = f"cycle {number} of this sample stands twice, in lines {seen[number]} and {line}"
            raise InputError(
                what, file=path, where=f"line {line}", hint="one row a cycle; is a column `sample` missing?"
            )
        seen[number] = line
