"""The table of numbers in what testing machines export: after any preamble, with its names and units, as columns of text.

Separators tab, semicolon, comma or blanks; quoted cells; one header row or two (names, then units in brackets) or none.
"""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from benchlab.errors import InputError, printable
from benchlab.io.delimited import MAX_BYTES, MAX_COLUMNS, Lines, encoding_of
from benchlab.io.files import check_regular_file

MAX_ROWS = 3_000_000
MIN_ROWS = 5
"""Most and fewest rows of numbers that are read as a table."""

_BLANKS = "blanks"
_SEPARATORS = ("\t", ";", ",", _BLANKS)
_NUMBER = re.compile(r"[+-]?(\d[\d.,' \u00a0\u202f]*|[.,]\d+)([eE][+-]?\d+)?")
_GROUPED = re.compile(r"[+-]?\d{1,3}(,\d{3})+\.\d+")
_UNIT_CELL = re.compile(r"\s*\([^()]*\)\s*")

Row = tuple[int, list[str]]


@dataclass(frozen=True)
class ExportTable:
    """Rows of numbers, still text, each (line number, cells) with as many cells; `names` and `units` are empty where the file has none.

    preamble: the rows before the header. separator: "\\t", ";", "," or "blanks". notes: what was left out or changed.
    """

    path: Path
    names: tuple[str, ...]
    units: tuple[str, ...]
    preamble: tuple[Row, ...]
    rows: tuple[Row, ...]
    separator: str
    notes: tuple[str, ...] = field(default=())


def read_export(path: Path) -> ExportTable:
    """The table in a file. Raises UsageError or InputError where there is none, more than one, or a row that does not fit."""
    if (size := check_regular_file(path).st_size) > MAX_BYTES:
        raise InputError(f"{size / 1e6:.0f} MB, more than the limit of {MAX_BYTES / 1e6:.0f} MB", file=path)
    encoding = encoding_of(path)
    try:
        with path.open(encoding=encoding, newline=None) as file:
            reader = Lines(path, file)
            lines = [(reader.number, line) for line in reader if line.strip()]
    except UnicodeError as error:
        raise InputError(f"not readable as {encoding} text", file=path, hint="save it as UTF-8") from error
    except OSError as error:
        raise InputError(f"could not be read: {error.strerror or error}", file=path) from error
    if len(lines) > MAX_ROWS:
        raise InputError(f"{len(lines)} lines, more than the limit of {MAX_ROWS}", file=path)
    separator = _separator(path, [line for _, line in lines])
    rows = [(number, _cells(path, number, line, separator)) for number, line in lines]
    notes: list[str] = []
    first, last = _block(path, rows, notes)
    data = _even(path, rows[first:last], at_end=last == len(rows), notes=notes)
    names, units, before = _header(rows[:first], len(data[0][1]))
    return ExportTable(path, names, units, tuple(rows[:before]), tuple(data), separator, tuple(notes))


def ungrouped(cell: str, separator: str) -> str:
    """A quoted number of a comma-separated file without its thousands commas: they can be nothing else there.

    >>> ungrouped("1,001.17", ","), ungrouped("1,001.17", ";"), ungrouped("1,001", ",")
    ('1001.17', '1,001.17', '1,001')
    """
    text = cell.strip()
    return text.replace(",", "") if separator == "," and _GROUPED.fullmatch(text) else text


def _separator(path: Path, lines: list[str]) -> str:
    """The separator that splits most of the last lines into numbers."""
    sample = lines[-200:]

    def share(separator: str) -> float:
        return sum(_is_data(_split(line, separator)) for line in sample) / max(1, len(sample))

    best = max(_SEPARATORS, key=share)
    if share(best) == 0:
        hint = "export the raw data: rows of numbers, separated by commas, semicolons or tabs"
        raise InputError("no table of numbers in it", file=path, hint=hint)
    return best


def _split(line: str, separator: str) -> list[str]:
    if separator == _BLANKS:
        return line.split()
    try:
        return next(csv.reader([line.rstrip("\r\n")], delimiter=separator, strict=True), [])
    except csv.Error:
        return []


def _cells(path: Path, number: int, line: str, separator: str) -> list[str]:
    cells = _split(line, separator)
    if not cells:
        hint = "is there a quotation mark without its partner?"
        raise InputError("not a table row", file=path, where=f"line {number}", hint=hint)
    if len(cells) > MAX_COLUMNS:
        what = f"{len(cells)} columns, more than the limit of {MAX_COLUMNS}"
        raise InputError(what, file=path, where=f"line {number}")
    return [cell.strip() for cell in cells]


def _is_data(cells: list[str]) -> bool:
    return sum(bool(_NUMBER.fullmatch(cell.strip())) for cell in cells) >= 2


def _block(path: Path, rows: list[Row], notes: list[str]) -> tuple[int, int]:
    """Indices (first, one past the last) of the longest run of data rows; InputError where a second one is as much of a table."""
    runs: list[tuple[int, int]] = []
    start: int | None = None
    for index, (_, cells) in enumerate([*rows, (0, [])]):
        if _is_data(cells):
            start = index if start is None else start
        elif start is not None:
            runs.append((start, index))
            start = None
    first, last = max(runs, key=lambda run: run[1] - run[0])
    for one, other in pairwise(runs):
        _refuse_gap(path, rows, one[1], other[0])
    others = [run for run in runs if run != (first, last) and (run[1] - run[0]) * 5 > last - first]
    if others:
        at = ", ".join(str(rows[begin][0]) for begin, _ in sorted([(first, last), *others]))
        hint = "save each specimen as a file of its own, and give them all"
        raise InputError(f"{len(others) + 1} tables of numbers (from lines {at})", file=path, hint=hint)
    if last - first < MIN_ROWS:
        where = f"line {rows[first][0]}"
        raise InputError(f"{last - first} rows of numbers, a test has at least {MIN_ROWS}", file=path, where=where)
    if later := [run for run in runs if run[0] > last]:
        notes.append(f"rows of numbers from line {rows[later[0][0]][0]} on are a table of their own and were left out")
    return first, last


def _refuse_gap(path: Path, rows: list[Row], end: int, begin: int) -> None:
    """InputError where a single row between two runs has a number and something else in it: a reading that failed."""
    number, cells = rows[end]
    if begin == end + 1 and len(cells) == len(rows[begin][1]) and any(map(_NUMBER.fullmatch, cells)):
        bad = next((cell for cell in cells if cell and not _NUMBER.fullmatch(cell)), "an empty cell")
        hint = "remove the row, or export again"
        raise InputError(f"{printable(bad)!r} is not a number", file=path, where=f"line {number}", hint=hint)


def _even(path: Path, rows: list[Row], at_end: bool, notes: list[str]) -> list[Row]:
    """All rows as long as the first; a last row that was cut while it was written is left out."""
    width = len(rows[0][1])
    if at_end and len(rows[-1][1]) < width:
        notes.append(f"the last row (line {rows[-1][0]}) is cut and was left out")
        rows = rows[:-1]
    for number, cells in rows:
        if len(cells) != width:
            what = f"row has {len(cells)} fields, the first one (line {rows[0][0]}) {width}"
            hint = "a decimal comma, or a comma within a cell? separate the columns by semicolons"
            raise InputError(what, file=path, where=f"line {number}", hint=hint)
    return rows


def _header(before: list[Row], width: int) -> tuple[tuple[str, ...], tuple[str, ...], int]:
    """Names, units and how many of the rows before the data are preamble."""
    names: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    left = len(before)
    if left and _is_units(before[left - 1][1]):
        units = tuple(cell.strip("() ") for cell in before[left - 1][1])
        left -= 1
    if left and abs(len(before[left - 1][1]) - width) <= 1 and any(before[left - 1][1]):
        names = tuple(before[left - 1][1])
        left -= 1
    return _padded(names, width), _padded(units, width), left


def _is_units(cells: list[str]) -> bool:
    return any(cells) and all(_UNIT_CELL.fullmatch(cell) for cell in cells if cell)


def _padded(cells: tuple[str, ...], width: int) -> tuple[str, ...]:
    return (cells + ("",) * width)[:width] if cells else ()
