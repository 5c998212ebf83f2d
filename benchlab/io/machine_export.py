"""Raw exports of universal testing machines: force, extension and time of each specimen, in N, mm and s."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.errors import InputError, UsageError, printable
from benchlab.io.export_columns import KEYS, NO_NAMES, Chosen, columns_by_place, find_columns, is_raw_data
from benchlab.io.export_numbers import Lines
from benchlab.io.export_table import Export, ExportTable, read_export
from benchlab.io.export_text import SEPARATORS
from benchlab.units import FloatArray, to_mm, to_MPa, to_N, to_s

MAX_UNREADABLE = 0.1
"""Share of a column's cells that may hold something else than a number ("Overload", "----")."""

_CONVERT = {"force": to_N, "extension": to_mm, "time": to_s, "pressure": to_MPa}
_SIGNS = {".": "point", ",": "comma", "": "none seen"}


@dataclass(frozen=True)
class ExportOptions:
    """What settles a file that can be read in two ways; None leaves it to the file.

    columns: names by place with commas between, as `force_N,pressure_kPa,time_s,-`. force_unit: of a force column without one.
    decimal: "." or ",". encoding: as Python names it. sort_time: rows are sorted by time where it runs backwards.
    """

    columns: str | None = None
    force_unit: str | None = None
    decimal: str | None = None
    encoding: str | None = None
    sort_time: bool = False


@dataclass(frozen=True)
class MachineTest:
    """One specimen. columns: force_N and, where the file has them, time_s, extension_mm, pressure_MPa, cycle, segment; (n,) each,
    NaN where a cell has no number. lines: of the rows in the file, (n,)."""

    specimen: str
    columns: dict[str, FloatArray]
    lines: Lines

    @property
    def first_line(self) -> int:
        return int(self.lines[0])


@dataclass(frozen=True)
class MachineExport:
    """All specimens of a file; what was inferred in reading it, what stands beside the tables, and what is doubtful."""

    path: Path
    tests: tuple[MachineTest, ...]
    rows: int
    inferred: dict[str, str]
    preamble: dict[str, str]
    warnings: tuple[str, ...]


def read_machine_export(path: Path, options: ExportOptions | None = None) -> MachineExport:
    """Read the export of a testing machine. Raises UsageError where an option is missing, InputError for what is damaged."""
    options = options or ExportOptions()
    export = read_export(path, options.encoding, options.decimal)
    warnings = list(export.notes)
    tables = _raw_tables(export, options, warnings)
    chosen = [_chosen(table, options) for table in tables]
    tests = []
    for number, (table, columns) in enumerate(zip(tables, chosen), 1):
        name = table.label or str(number)
        tests.append(_test(table, columns, name, options.sort_time, warnings))
    rows = sum(len(test.lines) for test in tests)
    inferred = _inferred(export, tables, chosen)
    return MachineExport(path, tuple(tests), rows, inferred, _preamble(export), tuple(warnings))


def export_document(export: MachineExport) -> dict[str, Any]:
    """The export as `benchlab force --json` gives it: numbers that are not there are None."""
    present = [key for key in KEYS.values() if any(key in test.columns for test in export.tests)]
    return {
        "file": str(export.path),
        "rows": export.rows,
        "specimens": [test.specimen for test in export.tests],
        "columns": {key: _range([t.columns[key] for t in export.tests if key in t.columns]) for key in present},
        "sample_rate_Hz": _sample_rate(export.tests),
        "inferred": export.inferred,
        "preamble": export.preamble,
        "warnings": list(export.warnings),
    }


def _range(parts: Sequence[FloatArray]) -> dict[str, float | None]:
    finite = [part[np.isfinite(part)] for part in parts]
    values = np.concatenate(finite)
    return {"min": float(values.min()), "max": float(values.max())} if values.size else {"min": None, "max": None}


def _sample_rate(tests: Sequence[MachineTest]) -> float | None:
    steps = np.concatenate([np.diff(test.columns.get("time_s", np.empty(0))) for test in tests])
    steps = steps[steps > 0]
    return float(1 / np.median(steps)) if steps.size else None


def _raw_tables(export: Export, options: ExportOptions, warnings: list[str]) -> list[ExportTable]:
    """The tables of raw data; those beside them, as results, are left out with a warning."""
    tables = list(export.tables)
    raw = [table for table in tables if is_raw_data(table.names, table.units)]
    if len(tables) == 1 or not raw:
        longest = max(tables, key=lambda table: len(table.lines))
        raw = [table for table in tables if (table.names, table.units) == (longest.names, longest.units)]
    for table in tables:
        if table not in raw:
            shown = ", ".join(printable(name) for name in table.names if name)[:60]
            warnings.append(f"the table in line {table.lines[0]} ({shown}) holds no raw data and was left out")
    return raw


def _chosen(table: ExportTable, options: ExportOptions) -> tuple[Chosen, ...]:
    empty = [table.is_empty(index) for index in range(table.width)]
    if options.columns:
        return columns_by_place(table.path, options.columns, table.width, empty)
    if not table.has_header:
        hint = "name the columns by place, as --columns time_s,extension_mm,force_N with - for those that are not used"
        raise UsageError(f"{table.width} {NO_NAMES}", file=table.path, hint=hint)
    return find_columns(table.path, table.header_line, table.names, table.units, empty, options.force_unit)


def _test(
    table: ExportTable, columns: Sequence[Chosen], specimen: str, sort_time: bool, warnings: list[str]
) -> MachineTest:
    values: dict[str, FloatArray] = {}
    for chosen in columns:
        column, notes = table.column(chosen.index, chosen.label)
        warnings += notes
        _check_unreadable(table, chosen, column.unreadable, warnings)
        convert = _CONVERT.get(chosen.quantity)
        values[KEYS[chosen.quantity]] = convert(column.values, chosen.unit) if convert else column.values
    return MachineTest(specimen, values, table.lines)


def _check_unreadable(
    table: ExportTable, chosen: Chosen, unreadable: Sequence[tuple[int, str]], warnings: list[str]
) -> None:
    if not unreadable:
        return
    row, cell = unreadable[0]
    what = f"{len(unreadable)} of {len(table.lines)} cells of {printable(chosen.label)} without a number, the first {printable(cell)!r}"
    if len(unreadable) > MAX_UNREADABLE * len(table.lines):
        hint = f"at most {100 * MAX_UNREADABLE:g} % are passed over"
        raise InputError(what, file=table.path, where=f"line {table.lines[row]}", hint=hint)
    warnings.append(f"{what} in line {table.lines[row]}")


def _inferred(export: Export, tables: Sequence[ExportTable], chosen: Sequence[Sequence[Chosen]]) -> dict[str, str]:
    """Every inference in words."""
    table = tables[0]
    found = {
        "encoding": export.encoding,
        "separator": SEPARATORS[export.separator],
        "decimal": _SIGNS[export.signs.decimal],
        "thousands": _SIGNS[export.signs.thousands],
        "header": f"line {table.header_line}" if table.has_header else "none",
    }
    for column in chosen[0]:
        unit = (
            "assumed to be in " + column.unit if column.assumed else f"in {column.unit}" if column.unit else "a count"
        )
        found[KEYS[column.quantity]] = f"column {column.index + 1}, {printable(column.label)!r}, {unit}"
    return found


def _preamble(export: Export) -> dict[str, str]:
    found: dict[str, str] = {}
    for _, cells in export.preamble:
        there = [cell for cell in cells if cell]
        found.setdefault(there[0], " ".join(there[1:]))
    return found
