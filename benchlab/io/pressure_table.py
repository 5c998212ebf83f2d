"""Time and pressure out of a text table, whose header has to say which columns they are and in which units."""

from __future__ import annotations

import itertools
from array import array
from pathlib import Path

import numpy as np

from benchlab.errors import InputError
from benchlab.io.delimited import Table, open_table
from benchlab.io.numbers import NumberReader
from benchlab.units import UNITS, known_unit, parse_column, to_MPa, to_s
from benchlab.vision.picture import FloatArray

MAX_UNREADABLE = 0.1
"""Share of the cells that may hold something else than a number ("Overload", "----")."""

_NAMES = {
    "time": {"time", "t", "elapsed", "elapsed time", "elapsed_time", "timestamp", "zeit", "temps", "tiempo"},
    "pressure": {"pressure", "p", "druck", "pression", "presion", "presión"},
}
_EXAMPLES = {"time": "time_s", "pressure": "pressure_kPa"}

Column = tuple[str, str | None]


def read_pressure_table(path: Path) -> tuple[list[int], FloatArray, FloatArray, list[str]]:
    """Line numbers, time in s and pressure in MPa of the rows, NaN where a cell has no number, and warnings."""
    with open_table(path) as table:
        columns = _named_columns(table)
        first = next(table.rows, None)
        if first is not None and (units := _units_row(first[1])):
            columns = [_with_unit(table, first[0], *pair) for pair in zip(columns, units)]
            first = next(table.rows, None)
        if first is None:
            raise InputError("no data rows", file=path, hint="the file holds only a header")
        time_at, time_unit = _find(table, columns, "time")
        pressure_at, pressure_unit = _find(table, columns, "pressure")
        notes = []
        if time_unit is None:
            notes.append(f"column {table.header[time_at]!r} has no unit and was read as s; name it time_s")
        reader = NumberReader(path, table.delimiter)
        lines, times, pressures = array("q"), array("d"), array("d")
        for line, cells in itertools.chain([first], table.rows):
            lines.append(line)
            times.append(reader.read(cells[time_at], line))
            pressures.append(reader.read(cells[pressure_at], line))
        notes += table.warnings + _reading_notes(table, reader, len(lines))
    return list(lines), to_s(np.array(times), time_unit or "s"), to_MPa(np.array(pressures), pressure_unit or ""), notes


def _named_columns(table: Table) -> list[Column]:
    cells = [cell.replace(",", ".") for cell in table.header]
    if all(_is_number(cell) for cell in cells if cell):
        where, hint = f"line {table.header_line}", "name the columns, e.g. time_s,pressure_kPa"
        raise InputError("no header: the first row holds numbers", file=table.path, where=where, hint=hint)
    return [parse_column(cell) for cell in table.header]


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _units_row(cells: list[str]) -> list[str | None] | None:
    """The units, if this is a row of them: no number, and at least one known unit. None if it is a row of data."""
    units = [cell.strip().strip("()[]{}").strip() for cell in cells]
    if any(_is_number(unit.replace(",", ".")) for unit in units) or not any(known_unit(unit) for unit in units):
        return None
    return [found[1] if (found := known_unit(unit)) else (unit or None) for unit in units]


def _with_unit(table: Table, line: int, column: Column, unit: str | None) -> Column:
    name, given = column
    if given and unit and given != unit:
        what = f"column {name!r} is in {given} by its name and in {unit} by the row of units"
        raise InputError(what, file=table.path, where=f"line {line}", hint="remove one of them")
    return name, given or unit


def _find(table: Table, columns: list[Column], quantity: str) -> tuple[int, str | None]:
    """Index and unit of the one column that holds a quantity. Only a time may be without a unit."""
    units = UNITS[quantity]
    named = [i for i, (name, _) in enumerate(columns) if name.lower() in _NAMES[quantity]]
    fitting = [i for i in named if columns[i][1] is None or columns[i][1] in units]
    measured = [i for i, (_, unit) in enumerate(columns) if unit in units]
    found = (fitting or measured) if quantity == "time" else sorted({*fitting, *measured})
    if len(found) > 1:
        listed = " and ".join(repr(table.header[i]) for i in found[:4])
        raise _refused(table, f"{len(found)} {quantity} columns: {listed}", "keep one of them in the file")
    example = f"put the unit in the header, e.g. {_EXAMPLES[quantity]}"
    if not found and named:
        what = f"unit {columns[named[0]][1]!r} of column {table.header[named[0]]!r} is not one of {quantity}"
        raise _refused(table, what, f"use one of {', '.join(units)}")
    if not found:
        listed = ", ".join(repr(cell) for cell in table.header[:8]) + (" …" if len(table.header) > 8 else "")
        vague = next((cell for cell, (name, _) in zip(table.header, columns) if quantity in name.lower()), None)
        raise _refused(table, f"no unit in {vague!r}" if vague else f"no {quantity} column among {listed}", example)
    unit = columns[found[0]][1]
    if unit is None and quantity == "pressure":
        raise _refused(table, f"no unit in {table.header[found[0]]!r}", example)
    return found[0], unit


def _refused(table: Table, what: str, hint: str) -> InputError:
    return InputError(what, file=table.path, where=f"line {table.header_line}", hint=hint)


def _reading_notes(table: Table, reader: NumberReader, n_rows: int) -> list[str]:
    notes = []
    if table.encoding == "latin-1":
        notes.append("not UTF-8: read as Latin-1")
    if reader.commas_may_be_thousands:
        notes.append("every comma has three digits behind it: read as decimal commas")
    if reader.unreadable:
        line, cell = reader.unreadable[0]
        count = len(reader.unreadable)
        what = f"{count} of {2 * n_rows} cells without a number, the first {cell!r}"
        if count > MAX_UNREADABLE * 2 * n_rows:
            limit = f"at most {100 * MAX_UNREADABLE:g} % are passed over"
            raise InputError(what, file=table.path, where=f"line {line}", hint=limit)
        notes.append(f"{what} in line {line}")
    return notes
