"""The tables of an export as specimens: each with its name and its columns in N, mm, s and MPa."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.errors import InputError, printable
from benchlab.io.export_columns import KEYS, Chosen, is_raw_data
from benchlab.io.export_numbers import Column, Lines
from benchlab.io.export_table import Export, ExportTable
from benchlab.io.export_time import time_order
from benchlab.io.table import unguarded
from benchlab.units import FloatArray, to_mm, to_MPa, to_N, to_s

MAX_UNREADABLE = 0.1
"""Share of a column's cells that may be empty or hold something else than a number ("Overload", "----")."""

_CONVERT = {"force": to_N, "extension": to_mm, "time": to_s, "pressure": to_MPa}


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


def raw_tables(export: Export, warnings: list[str]) -> list[ExportTable]:
    """The tables of raw data; those beside them, as results, are left out with a warning."""
    raw = [table for table in export.tables if is_raw_data(table.names, table.units)]
    if not raw:
        longest = max(export.tables, key=lambda table: len(table.lines))
        raw = [t for t in export.tables if (t.names, t.units) == (longest.names, longest.units)]
    for table in export.tables:
        if table not in raw:
            shown = ", ".join(printable(name) for name in table.names if name) or "without names"
            warnings.append(f"the table in line {table.lines[0]} ({shown[:60]}) holds no raw data and was left out")
    return raw


def tests_of(
    export: Export,
    tables: Sequence[ExportTable],
    chosen: Sequence[Sequence[Chosen]],
    sort_time: bool,
    warnings: list[str],
) -> tuple[MachineTest, ...]:
    """The specimens of all tables, apart by table and by a column of specimens. Raises InputError, with the line, for damage."""
    tests: list[MachineTest] = []
    for name, table, columns in zip(_names(export, tables), tables, chosen):
        values = dict(_values(table, columns, warnings))
        for specimen, rows in _specimens(table, columns, name):
            lines = table.lines if rows is None else np.asarray(table.lines)[rows]
            part = values if rows is None else {key: column[rows] for key, column in values.items()}
            tests.append(MachineTest(specimen, part, lines))
    return tuple(_in_order(export, test, len(tests) == 1, sort_time, warnings) for test in tests)


def _values(table: ExportTable, columns: Sequence[Chosen], warnings: list[str]) -> Iterator[tuple[str, FloatArray]]:
    """(name in the normalised table, values) of each column that has any."""
    for chosen in columns:
        if chosen.quantity not in KEYS:
            continue
        column, notes = table.column(chosen.index, chosen.label)
        warnings += notes
        is_count = chosen.quantity not in _CONVERT
        if is_count and len(column.unreadable) == len(table.lines):
            warnings.append(f"column {printable(chosen.label)!r} holds no numbers and was left out")
            continue
        _check_cells(table, chosen, column, warnings)
        if chosen.assumed and chosen.quantity != "force":
            what = f"column {printable(chosen.label)!r} has no unit and was read in {chosen.unit}"
            warnings.append(f"line {table.header[0]}: {what}; name the columns with --columns if that is wrong")
        yield (
            KEYS[chosen.quantity],
            column.values if is_count else _CONVERT[chosen.quantity](column.values, chosen.unit),
        )


def _check_cells(table: ExportTable, chosen: Chosen, column: Column, warnings: list[str]) -> None:
    """Counts cells without a number. Raises InputError for more of them than MAX_UNREADABLE."""
    if column.complete or not np.isnan(column.values).any():
        return
    missing = np.flatnonzero(np.isnan(column.values))
    cells = dict(column.unreadable)
    first = column.unreadable[0][0] if cells else int(missing[0])
    shown = f"the first {printable(cells[first])!r}" if cells else "all empty"
    what = f"{len(missing)} of {len(table.lines)} cells of {printable(chosen.label)} hold no number, {shown}"
    if len(missing) > MAX_UNREADABLE * len(table.lines):
        hint = f"at most {100 * MAX_UNREADABLE:g} % are passed over"
        raise InputError(what, file=table.path, where=f"line {table.lines[first]}", hint=hint)
    warnings.append(f"line {table.lines[first]}: {what}")


def _names(export: Export, tables: Sequence[ExportTable]) -> list[str]:
    """A name for each table: the label in its header, the title above it where all have one, else its number."""
    numbers = [str(number) for number in range(1, len(tables) + 1)]
    titles = [_title(export, table) for table in tables] if len(tables) > 1 else [""]
    for names in ([table.label for table in tables], titles):
        if all(names) and len(set(names)) == len(names):
            return names
    return numbers


def _title(export: Export, table: ExportTable) -> str:
    """The last cell of the row right above a table's header, as of `Specimen 3` or `Specimen label, A1`."""
    above = max((line for line, _ in export.preamble if table.header and line < table.header[0]), default=0)
    before = max((int(other.lines[-1]) for other in export.tables if other.lines[-1] < table.lines[0]), default=0)
    cells = [cell for cell in dict(export.preamble).get(above, []) if cell] if above > before else []
    return cells[-1] if 0 < len(cells) <= 2 else ""


def _specimens(table: ExportTable, columns: Sequence[Chosen], name: str) -> Iterator[tuple[str, np.ndarray | None]]:
    """(name, rows) of each specimen of a table, in their order; None stands for all rows."""
    column = next((c for c in columns if c.quantity == "specimen"), None)
    if column is None:
        yield name, None
        return
    cells = np.array([unguarded(cell) for cell in table.texts(column.index)])
    found, first = np.unique(cells, return_index=True)
    for specimen in found[np.argsort(first)]:
        rows = np.flatnonzero(cells == specimen)
        yield str(specimen) or "without name", rows if len(found) > 1 else None


def _in_order(export: Export, test: MachineTest, is_only: bool, sort_time: bool, warnings: list[str]) -> MachineTest:
    """The specimen with its rows by time, where that is asked for and they are not; doubts about its time are warned of."""
    if "time_s" not in test.columns:
        return test
    order, notes = time_order(
        export.path, "" if is_only else test.specimen, test.columns["time_s"], test.lines, sort_time
    )
    warnings += notes
    if order is None:
        return test
    columns = {key: values[order] for key, values in test.columns.items()}
    return MachineTest(test.specimen, columns, np.asarray(test.lines)[order])
