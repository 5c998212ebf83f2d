"""The cells of a table of measurements as columns of numbers and texts: strictly, row by row, or, for a long table of plain cells, at once.

A long table is read by pandas only where that gives what the strict reader would: every row has as many cells as the header, every
number is finite or an empty cell, and a line is a row. In any doubt the strict reader reads it, and says what is wrong and where.
"""

from __future__ import annotations

import itertools
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.errors import InputError, printable
from benchlab.io.delimited import Table, open_table
from benchlab.io.measured_columns import Column, Columns
from benchlab.io.numbers import NumberReader
from benchlab.io.pressure_table import MAX_UNREADABLE
from benchlab.io.table import unguarded

if TYPE_CHECKING:
    import pandas

LONG_BYTES = 1_000_000
"""From this size on, reading at once is tried."""

_SAMPLE_ROWS = 300
"""Rows that the strict reader looks at first, to learn the decimal sign."""

Row = tuple[int, list[str]]


@dataclass(frozen=True)
class Cells:
    """Rows of a table. frame: a column a key of `columns`, numbers or texts (as categories), as in the file; its index is the line."""

    frame: pandas.DataFrame
    columns: Columns
    warnings: tuple[str, ...]


def read_cells(path: Path, find: Callable[[Sequence[str]], Columns]) -> Cells:
    """Read the columns that `find` names in the header. Raises UsageError or InputError, with the line, for what cannot be read."""
    with open_table(path) as table:
        columns = find(table.header)
        rows = _rows(table, columns)
        if path.stat().st_size >= LONG_BYTES:
            first = list(itertools.islice(rows, _SAMPLE_ROWS))
            if (cells := _read_at_once(table, columns, first)) is not None:
                return cells
            rows = itertools.chain(first, rows)
        return _read_strictly(table, columns, rows)


def _rows(table: Table, columns: Columns) -> Iterator[Row]:
    """The rows of data, of which the first one may stand where others have a header."""
    return itertools.chain([(table.header_line, list(table.header))] * columns.headless, table.rows)


def is_text(column: Column) -> bool:
    """Whether a column is read as text: words, and what the user names, of which it is not known yet."""
    return column.meaning is None or column.meaning.is_word


def _read_strictly(table: Table, columns: Columns, rows: Iterable[Row]) -> Cells:
    import pandas

    reader = NumberReader(table.path, table.delimiter)
    lines = array("q")
    texts: dict[str, list[str]] = {key: [] for key, column in columns.read.items() if is_text(column)}
    numbers = {key: array("d") for key in columns.read if key not in texts}
    first_of = ""
    for line, cells in rows:
        lines.append(line)
        for key, found in texts.items():
            found.append(unguarded(cells[columns.read[key].index].strip()))
        for key, values in numbers.items():
            values.append(reader.read(cells[columns.read[key].index], line))
            if reader.unreadable and not first_of:
                first_of = columns.read[key].label
    data: dict[str, Any] = {key: np.asarray(values) for key, values in numbers.items()}
    data |= {key: pandas.Categorical(found) for key, found in texts.items()}
    notes = [*table.warnings, *_notes(table, reader, len(lines) * len(numbers), first_of)]
    return Cells(pandas.DataFrame(data, index=np.asarray(lines)), columns, tuple(notes))


def _notes(table: Table, reader: NumberReader, cells: int, first_of: str) -> list[str]:
    """What is to be said of cells without a number, the first of them in column `first_of`. Raises InputError where they are many."""
    notes = ["not UTF-8: read as Latin-1"] if table.encoding == "latin-1" else []
    if reader.commas_may_be_thousands:
        notes.append("every comma has three digits behind it: read as decimal commas")
    if reader.unreadable:
        line, cell = reader.unreadable[0]
        what = f"{len(reader.unreadable)} of {cells} cells hold no number, the first {cell!r}"
        if len(reader.unreadable) > MAX_UNREADABLE * cells:
            hint = f"at most {100 * MAX_UNREADABLE:g} % are passed over; a row of units belongs into the names"
            raise InputError(what, file=table.path, where=f"line {line}, column {first_of}", hint=hint)
        notes.append(f"{what} in line {line}, column {printable(first_of)}: no value there")
    return notes


def _read_at_once(table: Table, columns: Columns, first: Sequence[Row]) -> Cells | None:
    """The table read by pandas, None in any doubt. first: its first rows, already read, for the strict reader to judge."""
    import pandas

    sample = _read_strictly(table, columns, first)
    start = first[0][0] if first else 0
    decimal = _decimal(table, columns, first)
    data = table.path.read_bytes() if table.encoding in ("utf-8", "utf-8-sig", "latin-1") else None
    if data is None or not decimal or sample.warnings or data.count(b"\r") != data.count(b"\r\n"):
        return None
    body = _body(data, start)
    width = len(table.header)
    kinds = {column.index: str if is_text(column) else np.float64 for column in columns.read.values()}
    exact: dict[str, Any] = {"float_precision": "round_trip"} if int(pandas.__version__.split(".")[0]) < 3 else {}
    try:
        frame = pandas.read_csv(
            BytesIO(body),
            sep=table.delimiter,
            decimal=decimal,
            header=None,
            names=range(width),
            usecols=sorted(kinds),
            dtype={index: "category" if kind is str else kind for index, kind in kinds.items()},
            keep_default_na=False,
            na_values={index: [""] for index, kind in kinds.items() if kind is not str},
            skip_blank_lines=False,
            encoding="latin-1" if table.encoding == "latin-1" else "utf-8",
            **exact,
        )
    except (ValueError, OverflowError):
        return None
    separators = sum(part.count(table.delimiter.encode()) for part in body.split(b'"')[::2])
    if len(frame) != body.count(b"\n") or separators != len(frame) * (width - 1) or b"nan" in body.lower():
        return None
    found = {}
    for key, column in columns.read.items():
        values = frame[column.index]
        if not is_text(column) and np.isinf(values.to_numpy()).any():
            return None
        found[key] = _stripped(values) if is_text(column) else values.to_numpy()
    whole = pandas.DataFrame(found, index=np.arange(start, start + len(frame)))
    empty = [whole[key] == "" if is_text(column) else whole[key].isna() for key, column in columns.read.items()]
    blank = np.logical_and.reduce(empty).any()
    return None if blank else Cells(whole, columns, sample.warnings)


def _decimal(table: Table, columns: Columns, rows: Sequence[Row]) -> str:
    """The decimal sign that the first rows prove, "" where it is left open."""
    if table.delimiter == ",":
        return "."
    numbers = [c.index for c in columns.read.values() if not is_text(c)]
    signs = {sign for _, cells in rows for index in numbers for sign in ".," if sign in cells[index]}
    return signs.pop() if len(signs) == 1 else ""


def _body(data: bytes, line: int) -> bytes:
    """The bytes from a line on, the last one with its end."""
    start = 0
    for _ in range(line - 1):
        start = data.index(b"\n", start) + 1
    end = len(data)
    while data[end - 1] in b"\r\n ":
        end -= 1
    return data[start:end] + b"\n"


def _stripped(values: pandas.Series) -> pandas.Categorical:
    """Texts without blanks around them and without the sign that guards them."""
    import pandas

    clean = [unguarded(str(text).strip()) for text in values.cat.categories]
    if clean == values.cat.categories.tolist():
        return values.array
    return pandas.Categorical(np.asarray(clean, dtype=object)[values.cat.codes.to_numpy()])
