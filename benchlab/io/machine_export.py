"""Raw exports of universal testing machines: force, extension and time of each specimen, in N, mm and s.

export_text     bytes -> lines -> cells        encoding, separator
export_layout   rows -> tables                 names, units, numbers, preamble
export_numbers  cells -> numbers               decimal sign, thousands; export_damage: decimals that were lost
export_columns  names, units -> quantities     export_words: what labs call them
export_table    all of these, for any file     export_fast: the same for long files of plain numbers
export_tests    tables -> specimens            export_time: a time that runs backwards
export_told     what was inferred, in words    force_file: the table in N, mm and s, written and read back
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.errors import UsageError
from benchlab.io.export_columns import KEYS, NO_NAMES, REMEDY, Chosen, columns_by_place, find_columns
from benchlab.io.export_table import ExportTable, read_export
from benchlab.io.export_tests import MachineTest, raw_tables, tests_of
from benchlab.io.export_told import inferred_in_words, preamble_of
from benchlab.units import FloatArray


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
class MachineExport:
    """All specimens of a file; what was inferred in reading it, what stands beside the tables, and what is doubtful.

    Forces have the sign that the machine gave them. inferred: by name of a column or of what was found, in words.
    """

    path: Path
    tests: tuple[MachineTest, ...]
    rows: int
    inferred: dict[str, str]
    preamble: dict[str, str]
    warnings: tuple[str, ...]


def read_machine_export(path: Path, options: ExportOptions | None = None) -> MachineExport:
    """Read the export of a testing machine, whatever its language, encoding, separator and decimal sign.

    Raises UsageError where an option has to say what a column or a unit is, InputError, with the line, for what is damaged or could
    be read in two ways.
    """
    options = options or ExportOptions()
    export = read_export(path, options.encoding, options.decimal)
    warnings = list(export.notes)
    tables = raw_tables(export, warnings)
    chosen = [_columns(table, options) for table in tables]
    tests = tests_of(export, tables, chosen, options.sort_time, warnings)
    inferred = inferred_in_words(export, tables, chosen, len(tests))
    rows = sum(len(test.lines) for test in tests)
    return MachineExport(path, tests, rows, inferred, preamble_of(export), tuple(warnings))


def export_document(export: MachineExport) -> dict[str, Any]:
    """The export as `benchlab force --json` gives it: numbers that are not there are None.

    sample_rate_Hz: of the median step of time; time_step_s: the smallest, median and largest step forward, None without a time.
    """
    steps = _time_steps(export.tests)
    present = [key for key in KEYS.values() if any(key in test.columns for test in export.tests)]
    return {
        "file": str(export.path),
        "rows": export.rows,
        "specimens": [test.specimen for test in export.tests],
        "columns": {key: _range([t.columns[key] for t in export.tests if key in t.columns]) for key in present},
        "sample_rate_Hz": None if steps is None else 1 / steps["median"],
        "time_step_s": steps,
        "inferred": export.inferred,
        "preamble": export.preamble,
        "warnings": list(export.warnings),
    }


def _columns(table: ExportTable, options: ExportOptions) -> tuple[Chosen, ...]:
    empty = [table.is_empty(index) for index in range(table.width)]
    if options.columns:
        return columns_by_place(table.path, options.columns, table.width, empty)
    if not table.has_header:
        raise UsageError(f"{table.width} {NO_NAMES}", file=table.path, hint=REMEDY)
    return find_columns(table.path, table.header[0], table.names, table.units, empty, options.force_unit)


def _range(parts: Sequence[FloatArray]) -> dict[str, float | None]:
    values = np.concatenate(parts)
    values = values[np.isfinite(values)]
    return {"min": float(values.min()), "max": float(values.max())} if values.size else {"min": None, "max": None}


def _time_steps(tests: Sequence[MachineTest]) -> dict[str, float] | None:
    steps = np.concatenate([np.diff(test.columns.get("time_s", np.empty(0))) for test in tests])
    steps = steps[steps > 0]
    if not steps.size:
        return None
    return {"min": float(steps.min()), "median": float(np.median(steps)), "max": float(steps.max())}
