"""The export of a testing machine in N, mm, s and MPa on disk: HDF5 that NeXus viewers draw, and a CSV table.

    /entry              NXentry   export (file, specimens, inferred, preamble), provenance, warnings as JSON texts
    /entry/specimen_1   NXdata    force_N over time_s, or over line where there is no time; one group a specimen, in their order

Columns are those that the file has: time_s, extension_mm, force_N, pressure_MPa, cycle, segment; `line` is where a row stands in
the file. The CSV table holds the same with the specimen's name before it, and `read_machine_export` reads it back.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from io import StringIO
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from benchlab.errors import InputError
from benchlab.io.export_columns import KEYS
from benchlab.io.files import written_whole
from benchlab.io.hdf5 import Reader, add_numbers, add_texts, open_hdf5
from benchlab.io.machine_export import MachineExport, MachineTest
from benchlab.io.nexus import Schema, nxdata, read_document, read_provenance_of, write_nexus
from benchlab.io.table import guarded
from benchlab.units import FloatArray

SCHEMA = Schema("benchlab-force", 1, "benchlab force file")

_UNITS = {
    "time_s": ("s", "time (s)"),
    "extension_mm": ("mm", "extension (mm)"),
    "force_N": ("N", "force (N)"),
    "pressure_MPa": ("MPa", "pressure (MPa)"),
    "cycle": ("", "cycle, as the machine counts"),
    "segment": ("", "segment, as the machine counts"),
}
_DIGITS = "%.12g"
_BLOCK = 10_000
"""How a number is written; rows that are written at a time."""


def write_force_csv(path: Path, export: MachineExport) -> None:
    """Write a row a reading, whole or not at all: specimen, and the columns of the file; empty cells where there is no number.

    Numbers have 12 digits. A name that a spreadsheet would take for a formula has an apostrophe before it.
    Raises InputError where the disk refuses.
    """
    names = [name for name in KEYS.values() if any(name in test.columns for test in export.tests)]
    with (
        written_whole(path) as temporary,
        temporary.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file,
    ):
        file.write(_row("specimen", *names) + "\n")
        for test in export.tests:
            none = np.full(len(test.lines), np.nan)
            table = np.column_stack([test.columns.get(name, none) for name in names]) + 0.0  # -0 is written as 0
            specimen = _row(guarded(test.specimen), "")
            for at in range(0, len(table), _BLOCK):
                file.writelines(f"{specimen}{row}\n" for row in _rows(table[at : at + _BLOCK]))


def write_force_file(path: Path, export: MachineExport, provenance: Mapping[str, Any]) -> None:
    """Write all specimens as HDF5, whole or not at all. Raises InputError where the disk refuses."""
    about = {
        "file": str(export.path),
        "specimens": [test.specimen for test in export.tests],
        "inferred": export.inferred,
        "preamble": export.preamble,
    }
    documents = {"export": about, "provenance": dict(provenance), "warnings": list(export.warnings)}

    def fill(entry: h5py.Group) -> None:
        for number, test in enumerate(export.tests, 1):
            _write_test(entry, f"specimen_{number}", test)

    write_nexus(path, SCHEMA, "specimen_1", documents, fill)


def read_force_file(path: Path) -> MachineExport:
    """Read a force file; `path` in it is that of the export. InputError for anything damaged, foreign, or from a newer benchlab."""
    with open_hdf5(path, SCHEMA.kind) as reader:
        SCHEMA.check(reader)
        about = read_document(reader, "export", SCHEMA)
        warnings = read_document(reader, "warnings", SCHEMA, list)
        specimens = about["specimens"]
        tests = tuple(_read_test(reader, f"/entry/specimen_{n}") for n, _ in enumerate(specimens, 1))
        if [test.specimen for test in tests] != specimens:
            raise InputError("names of specimens differ within the file", file=path, hint="make it again")
    rows = sum(len(test.lines) for test in tests)
    return MachineExport(Path(about["file"]), tests, rows, about["inferred"], about["preamble"], tuple(warnings))


def read_force_provenance(path: Path) -> dict[str, Any] | None:
    """The provenance of a force file alone; None where there is none that can be read."""
    return read_provenance_of(path, SCHEMA)


def _write_test(entry: h5py.Group, name: str, test: MachineTest) -> None:
    timed = "time_s" in test.columns and bool(np.isfinite(test.columns["time_s"]).all())
    axis = "time_s" if timed else "line"
    group = nxdata(entry, name, "force_N", [axis], f"force on specimen {test.specimen}")
    others = [key for key in ("extension_mm", "pressure_MPa") if key in test.columns]
    if others:
        group.attrs["auxiliary_signals"] = others
    add_texts(group, "specimen", test.specimen, "name of the specimen")
    add_numbers(group, "line", np.asarray(test.lines, dtype=np.int64), "", "line in the exported file")
    for key, values in test.columns.items():
        add_numbers(group, key, values, *_UNITS[key])
    group[axis].make_scale(axis)
    for key in ("line", *test.columns):
        if key != axis:
            group[key].dims[0].attach_scale(group[axis])


def _read_test(reader: Reader, group: str) -> MachineTest:
    lines = reader.numbers(f"{group}/line").astype(np.int64)
    columns = {
        key: reader.numbers(f"{group}/{key}", lines.shape).astype(float)
        for key in KEYS.values()
        if reader.find(f"{group}/{key}") is not None
    }
    if "force_N" not in columns:
        raise InputError(f"no dataset {group}/force_N", file=reader.path, hint="make the file again")
    return MachineTest(reader.texts(f"{group}/specimen")[0], columns, lines)


def _row(*cells: str) -> str:
    """A row of texts, quoted where they have to be."""
    made = StringIO()
    csv.writer(made, lineterminator="").writerow(cells)
    return made.getvalue()


def _rows(table: FloatArray) -> list[str]:
    """Rows of numbers with commas between, nothing for NaN."""
    form = ",".join([_DIGITS] * table.shape[1])
    text = "\n".join([form] * len(table)) % tuple(table.ravel().tolist())
    return text.replace("nan", "").split("\n")
