"""Raw exports of universal testing machines: force, extension and time of each specimen, in N, mm and s."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.errors import UsageError
from benchlab.io.export_table import read_export, ungrouped
from benchlab.io.numbers import NumberReader
from benchlab.units import FloatArray, known_unit, parse_column, to_mm, to_MPa, to_N, to_s


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
    NaN where a cell has no number. first_line: of its numbers in the file."""

    specimen: str
    columns: dict[str, FloatArray]
    first_line: int


@dataclass(frozen=True)
class MachineExport:
    """All specimens of a file; what was inferred in reading it, what stands before the numbers, and what is doubtful."""

    path: Path
    tests: tuple[MachineTest, ...]
    rows: int
    inferred: dict[str, str]
    preamble: dict[str, str]
    warnings: tuple[str, ...]


def read_machine_export(path: Path, options: ExportOptions | None = None) -> MachineExport:
    """Read the export of a testing machine. Raises UsageError where an option is missing, InputError for what is damaged."""
    options = options or ExportOptions()
    table = read_export(path)
    reader = NumberReader(path, table.separator)
    cells = list(zip(*(row for _, row in table.rows)))
    words = options.columns.split(",") if options.columns else [f"{n} {u}" for n, u in zip(table.names, table.units)]
    columns, inferred = {}, {"separator": table.separator}
    for word, column in zip(words, cells):
        _, unit = parse_column(word)
        found = known_unit(unit or "")
        if found is None:
            continue
        values = np.array([reader.read(ungrouped(cell, table.separator), 0) for cell in column])
        convert = {"force": to_N, "length": to_mm, "time": to_s, "pressure": to_MPa}[found[0]]
        key = {"force": "force_N", "length": "extension_mm", "time": "time_s", "pressure": "pressure_MPa"}[found[0]]
        columns[key], inferred[key] = convert(values, found[1]), word
    if "force_N" not in columns:
        raise UsageError("no column of force", file=path, hint="name the columns with --columns")
    test = MachineTest("1", columns, table.rows[0][0])
    return MachineExport(path, (test,), len(table.rows), inferred, {}, table.notes)


def export_document(export: MachineExport) -> dict[str, Any]:
    """The export as `benchlab force --json` gives it."""
    names = dict.fromkeys(name for test in export.tests for name in test.columns)
    merged = {name: np.concatenate([t.columns[name] for t in export.tests if name in t.columns]) for name in names}
    return {
        "file": str(export.path),
        "rows": export.rows,
        "specimens": [test.specimen for test in export.tests],
        "columns": {n: {"min": float(np.nanmin(v)), "max": float(np.nanmax(v))} for n, v in merged.items()},
        "sample_rate_Hz": float(1 / np.median(np.diff(merged["time_s"]))),
        "inferred": export.inferred,
        "preamble": export.preamble,
        "warnings": list(export.warnings),
    }
