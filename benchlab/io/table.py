"""The curvature series as a CSV table: one row per frame, an empty cell for what is not known.

UTF-8, commas, decimal points whatever the locale. A text that a spreadsheet would take for a formula is written with a
leading apostrophe (the remedy that OWASP names for CSV injection), which `read_series_csv` takes off again.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from benchlab.errors import InputError
from benchlab.io.delimited import open_table
from benchlab.io.files import written_whole
from benchlab.io.numbers import NumberReader
from benchlab.vision.picture import FloatArray
from benchlab.vision.series import CurvatureSeries

if TYPE_CHECKING:
    import pandas

_FORMATS = {
    "time_s": "%.6f",
    "curvature_per_mm": "%.8g",
    "curvature_sd_per_mm": "%.4g",
    "angle_deg": "%.4f",
    "angle_sd_deg": "%.4g",
    "radius_mm": "%.8g",
    "fit_rms_px": "%.5g",
    "pressure_MPa": "%.8g",
}
_COUNTS = ("frame", "n_markers")
_TEXTS = ("name", "flag")
_OPTIONAL = ("name", "pressure_MPa")
_FORMULA = ("=", "+", "-", "@", "\t")


def write_series_csv(path: Path, series: CurvatureSeries) -> None:
    """Write the table whole or not at all. InputError where the disk refuses.

    Columns: frame (from 0), name (stills only), time_s, curvature_per_mm, curvature_sd_per_mm, angle_deg, angle_sd_deg,
    radius_mm, fit_rms_px, n_markers, pressure_MPa (where one is known), flag.
    """
    columns: dict[str, list[str]] = {"frame": [str(i) for i in range(len(series.flag))]}
    if series.names:
        columns["name"] = [guarded(name) for name in series.names]
    numbers: dict[str, FloatArray] = {
        "time_s": series.time_s,
        "curvature_per_mm": series.curvature_per_mm,
        "curvature_sd_per_mm": series.curvature_sd_per_mm,
        "angle_deg": np.degrees(series.angle_rad),
        "angle_sd_deg": np.degrees(series.angle_sd_rad),
        "radius_mm": series.radius_mm,
        "fit_rms_px": series.fit_rms_px,
    }
    columns |= {name: _cells(values, _FORMATS[name]) for name, values in numbers.items()}
    columns["n_markers"] = [str(n) for n in series.n_markers.tolist()]
    if series.pressure_MPa is not None:
        columns["pressure_MPa"] = _cells(series.pressure_MPa, _FORMATS["pressure_MPa"])
    columns["flag"] = [guarded(text) for text in series.flag]
    with (
        written_whole(path) as temporary,
        temporary.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))


def read_series_csv(path: Path) -> pandas.DataFrame:
    """The table as a DataFrame: whole numbers for frame and n_markers, floats with NaN for empty cells, and texts.

    Raises UsageError or InputError with the line: a column missing or unknown, a row too long or short, no number.
    """
    import pandas

    with open_table(path) as table:
        known = {*_FORMATS, *_COUNTS, *_TEXTS}
        missing = [name for name in known - set(table.header) if name not in _OPTIONAL]
        unknown = [name for name in table.header if name not in known]
        if missing or unknown or len(set(table.header)) < len(table.header) or table.delimiter != ",":
            what = "not a table of benchlab analyze" + (f", without {', '.join(sorted(missing))}" if missing else "")
            raise InputError(
                what, file=path, where=f"line {table.header_line}", hint="make it again from the recording"
            )
        reader = NumberReader(path, ",")
        convert: list[Callable[[str, int], object]] = [
            (lambda cell, _: unguarded(cell)) if name in _TEXTS else reader.read for name in table.header
        ]
        rows = []
        for line, cells in table.rows:
            rows.append([read(cell, line) for read, cell in zip(convert, cells)])
            _check_row(path, line, table.header, rows[-1], reader)
        if table.warnings:
            raise InputError(table.warnings[0], file=path, hint="was the copy finished?")
    frame = pandas.DataFrame(rows, columns=list(table.header))
    types = {name: "int64" if name in _COUNTS else "object" if name in _TEXTS else "float64" for name in table.header}
    return frame.astype(types)


def guarded(text: str) -> str:
    """Text as a cell that no spreadsheet runs: an apostrophe before what begins like a formula, or with an apostrophe.

    Line ends are written as escapes, so that a row is a line.

    >>> guarded("=cmd|calc"), guarded("slw5"), unguarded(guarded("'=1"))
    ("'=cmd|calc", 'slw5', "'=1")
    """
    text = text.replace("\r", "\\r").replace("\n", "\\n")
    return "'" + text if text.startswith((*_FORMULA, "'")) else text


def unguarded(cell: str) -> str:
    """The text that `guarded` made this cell of."""
    return cell[1:] if cell.startswith("'") and cell[1:].startswith((*_FORMULA, "'")) else cell


def _cells(values: FloatArray, form: str) -> list[str]:
    """Numbers as text, empty where there is none, and without a sign where only zeros are left."""
    texts = (form % value if math.isfinite(value) else "" for value in values.tolist())
    return [text.lstrip("-") if not text.strip("-0.") else text for text in texts]


def _check_row(path: Path, line: int, header: tuple[str, ...], row: list[object], reader: NumberReader) -> None:
    if reader.unreadable:
        raise InputError(f"not a number: {reader.unreadable[0][1]!r}", file=path, where=f"line {line}")
    for name, value in zip(header, row):
        if name in _COUNTS and not (isinstance(value, float) and value >= 0 and value.is_integer()):
            raise InputError(f"{name} is not a whole number", file=path, where=f"line {line}")
