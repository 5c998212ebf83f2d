"""The dimensions of designs: a table with a row a design, a study or design file, or the designs' own names."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from benchlab.actuator import DIMENSIONS, ShellDesign
from benchlab.errors import InputError, UsageError, printable
from benchlab.io.design_file import design_named, read_design
from benchlab.io.files import check_regular_file
from benchlab.io.hdf5 import is_hdf5
from benchlab.io.measured_cells import Cells, read_cells
from benchlab.io.measured_columns import find_columns
from benchlab.io.measured_units import converted
from benchlab.io.study_file import STUDY_FILE, read_study

if TYPE_CHECKING:
    import pandas

WANTED = ("tw_mm", "slw_mm")
DEFAULTS = {"fw_mm": 2.0, "perimeter_mm": 40.0, "length_mm": 180.0}
"""What a table must say of a design, and what the paper's designs have where it does not."""

_STUDY = re.compile(rb"^designs\s*:", re.MULTILINE)


def read_designs(
    path: Path, columns: Mapping[str, str] | None = None, told: list[str] | None = None
) -> Mapping[str, ShellDesign]:
    """Designs by name, from a table with the columns design, tw_mm, slw_mm and, where they are not the paper's, fw_mm, length_mm and
    perimeter_mm (or other units); from a study (the file, or its folder); or from a design file.

    A design may stand in several rows, if they say the same: a table of measurements serves as well. Without a column `design`, designs
    are called by their dimensions. columns: as of `read_measured`. told: takes what was assumed or left out.
    Raises UsageError or InputError, with the line, for a design that is impossible or has two sets of dimensions.
    """
    told = [] if told is None else told
    if path.is_dir():
        path = path / STUDY_FILE
    if path.suffix.lower() in (".yaml", ".yml"):
        check_regular_file(path)
        return _of_study(path, told) if _STUDY.search(path.read_bytes()) else _of_design_file(path)
    cells = read_cells(path, lambda header: find_columns(header, str(path), columns))
    told += cells.warnings
    return shapes_in(cells, str(path), told)


def designs_of_frame(frame: pandas.DataFrame, source: str = "designs") -> Mapping[str, ShellDesign]:
    """The same of a DataFrame with such columns."""
    import pandas

    columns = find_columns([str(label).strip() for label in frame.columns], source)
    data = {key: frame.iloc[:, column.index].to_numpy() for key, column in columns.read.items()}
    return shapes_in(Cells(pandas.DataFrame(data, index=np.arange(1, len(frame) + 1)), columns, ()), source, [])


def designs_beside(path: Path, columns: Mapping[str, str] | None = None) -> Mapping[str, ShellDesign]:
    """The dimensions that a table of measurements gives its designs itself, in columns tw_mm and slw_mm; empty where it has none."""
    if path.is_dir() or is_hdf5(path):
        return {}
    cells = read_cells(path, lambda header: find_columns(header, str(path), columns))
    return shapes_in(cells, str(path), []) if set(WANTED) <= set(cells.columns.read) else {}


def designs_of_names(names: Iterable[str]) -> Mapping[str, ShellDesign]:
    """The designs whose names say what they are, as `tw3_slw10`; the others are left out. Raises UsageError for an impossible one.

    >>> designs_of_names(["tw3_slw10", "glove"])["tw3_slw10"].window_width_mm
    3.0
    """
    found = {name: design_named(name) for name in names}
    return {name: design for name, design in found.items() if design is not None}


def shapes_in(cells: Cells, source: str, told: list[str]) -> dict[str, ShellDesign]:
    """The designs in the rows of a table. Raises as `read_designs`."""
    missing = [name for name in WANTED if name not in cells.columns.read]
    if missing:
        hint = (
            "name columns design, tw_mm, slw_mm (and fw_mm, perimeter_mm, length_mm where they are not 2, 40 and 180)"
        )
        raise InputError(f"no column {missing[0]}", file=source, hint=hint)
    assumed = {name: value for name, value in DEFAULTS.items() if name not in cells.columns.read}
    if assumed:
        listed = ", ".join(f"{name} {value:g}" for name, value in assumed.items())
        told.append(f"{listed}: not in the table, taken from the paper")
    frame = _dimensions(cells)
    shapes: dict[str, ShellDesign] = {}
    first: dict[str, int] = {}
    for line, row in frame.drop_duplicates().iterrows():
        shape = _shape(row, source, int(line))
        name = str(row["design"]) if "design" in frame else shape.name
        if shapes.setdefault(name, shape) != shape:
            what = f"design {printable(name)} has other dimensions in line {first[name]}"
            raise InputError(what, file=source, where=f"line {line}", hint="give designs that differ different names")
        first.setdefault(name, int(line))
    told += [words for name, shape in shapes.items() for words in _contradiction(name, shape)]
    return shapes


def _dimensions(cells: Cells) -> pandas.DataFrame:
    """Design and the five dimensions in mm, NaN where there is none."""
    frame = cells.frame[["design"] if "design" in cells.frame else []].copy()
    for name in DIMENSIONS:
        if (column := cells.columns.read.get(name)) and column.meaning:
            frame[name] = converted(cells.frame[name].to_numpy(dtype=float), column.meaning)
        else:
            frame[name] = DEFAULTS[name]
    return frame


def _shape(row: pandas.Series, source: str, line: int) -> ShellDesign:
    values = {field: float(row[name]) for name, field in DIMENSIONS.items()}
    empty = [name for name in DIMENSIONS if np.isnan(row[name])]
    if empty or row.get("design") == "":
        what = f"no {empty[0] if empty else 'name of the design'}"
        raise InputError(what, file=source, where=f"line {line}", hint="fill the cell in, or leave the column out")
    try:
        return ShellDesign(**values)
    except UsageError as error:
        raise InputError(error.what, file=source, where=f"line {line}", hint=error.hint) from None


def _contradiction(name: str, shape: ShellDesign) -> list[str]:
    """What is to be told of a design whose name says other dimensions than it has."""
    try:
        named = design_named(name)
    except UsageError:
        return []
    if named is None or named.name == shape.name:
        return []
    return [f"design {name} is {shape.name} by its dimensions, which count"]


def _of_study(path: Path, told: list[str]) -> dict[str, ShellDesign]:
    study = read_study(path)
    without = [design.name for design in study.designs if design.shell is None]
    if without:
        told.append(f"designs without a shell in the study: {', '.join(map(printable, without))}")
    return {design.name: design.shell for design in study.designs if design.shell is not None}


def _of_design_file(path: Path) -> dict[str, ShellDesign]:
    shape = read_design(path)
    return {shape.name: shape}
