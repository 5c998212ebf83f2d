"""The tables of numbers in what testing machines export, with names, units and preamble: the one reader of such files.

Any separator, decimal sign and encoding; one header row or two (names, then units) or none; several tables in a file. Long
files of plain numbers are read by `export_fast`, all others here, to the same result.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from benchlab.io.export_damage import check_decimals
from benchlab.io.export_fast import read_plain
from benchlab.io.export_layout import Span, find_layout
from benchlab.io.export_numbers import Column, Lines, Signs, find_signs, numbers
from benchlab.io.export_text import ExportText, Row, read_text, rows_of

_SHORT = re.compile(r"(0|[1-9]\d{0,11})([.,]\d*)?")


@dataclass(frozen=True)
class ExportTable:
    """One table of n rows. names and units: of its columns, "" where the file has none. lines: of its rows in the file, (n,).

    label: what stands over a first column that is empty, as a specimen's number. header: lines of names and of units, if any.
    """

    path: Path
    names: tuple[str, ...]
    units: tuple[str, ...]
    label: str
    header: tuple[int, ...]
    lines: Lines
    width: int
    signs: Signs
    plain: tuple[Column, ...] = field(default=(), repr=False)
    rows: Sequence[Row] = field(default=(), repr=False)

    @property
    def has_header(self) -> bool:
        return bool(self.header)

    def is_empty(self, index: int) -> bool:
        """Whether no row has a cell in a column."""
        return not self.plain and not any(cells[index] for _, cells in self.rows)

    def texts(self, index: int) -> list[str]:
        """The cells of a column as texts, numbers in their shortest form."""
        if self.plain:
            return [f"{value:.12g}" for value in self.plain[index].values]
        cells = (cells[index] for _, cells in self.rows)
        return [f"{float(cell.replace(',', '.')):.12g}" if _SHORT.fullmatch(cell) else cell for cell in cells]

    def column(self, index: int, label: str = "") -> tuple[Column, list[str]]:
        """The numbers of a column, and notes. Raises InputError, with the line, for damaged ones. label: its name in messages."""
        if self.plain:
            column = self.plain[index]
        else:
            cells = [cells[index] for _, cells in self.rows]
            column = numbers(self.path, label, cells, self.lines, self.signs)
        return column, check_decimals(self.path, label, column, self.lines, self.signs.stated)


@dataclass(frozen=True)
class Export:
    """All tables of a file. preamble: rows that are in none of them. separator: as in SEPARATORS. notes: what is left out or doubtful."""

    path: Path
    encoding: str
    separator: str
    signs: Signs
    tables: tuple[ExportTable, ...]
    preamble: tuple[Row, ...]
    notes: tuple[str, ...]


def read_export(path: Path, encoding: str | None = None, decimal: str | None = None, strict: bool = False) -> Export:
    """The tables of a file. encoding, decimal: as options give them. strict: without the reader of plain numbers.

    Raises UsageError or InputError, with the line, where there is none, a row does not fit, or numbers could be read in two ways.
    """
    text = read_text(path, encoding)
    plain = None if strict else read_plain(text, decimal)
    if plain is None:
        return _read_strictly(text, decimal)
    table = _table(path, plain.span, plain.header, plain.lines, plain.signs, columns=plain.columns)
    return _export(text, plain.signs, (table,), plain.before, plain.cut)


def _read_strictly(text: ExportText, decimal: str | None) -> Export:
    rows, unpaired = rows_of(text)
    layout = find_layout(text.path, rows, unpaired, text.is_whole)
    inside = (row for span in layout.spans for row in rows[span.first : span.last])
    cells = ((line, cell) for line, cells in inside for cell in cells)
    signs = find_signs(text.path, cells, text.separator, decimal)
    tables = []
    for span in layout.spans:
        header = tuple(line for line, _ in rows[span.top : span.first])
        body = rows[span.first : span.last]
        lines = np.array([line for line, _ in body])
        tables.append(_table(text.path, span, header, lines, signs, rows=body))
    used = {index for span in layout.spans for index in range(span.top, span.last)}
    left = tuple(row for index, row in enumerate(rows) if index not in used and row[0] != layout.cut)
    return _export(text, signs, tuple(tables), left, layout.cut)


def _table(
    path: Path,
    span: Span,
    header: tuple[int, ...],
    lines: Lines,
    signs: Signs,
    columns: tuple[Column, ...] = (),
    rows: Sequence[Row] = (),
) -> ExportTable:
    width = len(columns) or len(rows[0][1])
    blank = ("",) * width
    names, units = span.names or blank, span.units or blank
    return ExportTable(path, names, units, span.label, header, lines, width, signs, columns, rows)


def _export(
    text: ExportText, signs: Signs, tables: tuple[ExportTable, ...], preamble: tuple[Row, ...], cut: int | None
) -> Export:
    notes = [text.content.doubt] if text.content.doubt else []
    if cut is not None:
        notes.append(f"the last row (line {cut}) is cut and was left out")
    return Export(text.path, text.content.encoding, text.separator, signs, tables, preamble, tuple(notes))
