"""A long table of plain numbers, proven so by its bytes and read by pandas in threads; anything else is left to the strict reader.

What is proven of every row: as many cells as the first one, each a number of at most MAX_NUMBER characters that pandas reads
whole, no cell empty, all cells quoted or none, decimals marked by the sign of the file. pandas rounds each number to the nearest
float, as float() does.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError
from benchlab.io.export_layout import Span, find_layout, is_cut
from benchlab.io.export_numbers import Column, FloatArray, Signs, find_signs
from benchlab.io.export_text import HEAD, MAX_ROWS, TAIL, ExportText, Row, head_lines, split_lines
from benchlab.io.numbers import MAX_NUMBER

MIN_BYTES = 4 * HEAD
"""Smaller files are left to the strict reader."""

_CHUNK = 1 << 22
_NEWLINE, _RETURN, _QUOTE, _NINE, _ZERO = b'\n\r"90'
_EXPONENTS = b"eE"

Bytes = NDArray[np.uint8]


class NotPlainError(Exception):
    """The table is not one of plain numbers."""


@dataclass(frozen=True)
class PlainTable:
    """The only table of a file: its rows before the numbers, its header, its columns and the lines that they are from."""

    before: tuple[Row, ...]
    span: Span
    header: tuple[int, ...]
    signs: Signs
    columns: tuple[Column, ...]
    lines: range
    cut: int | None


def read_plain(text: ExportText, stated: str | None = None) -> PlainTable | None:
    """The table of a file, all of which after its header is plain numbers; None for any other file. stated: the decimal sign."""
    data = text.data
    if len(data) < MIN_BYTES or data.count(b"\r", 0, HEAD) != data.count(b"\r\n", 0, HEAD):
        return None
    try:
        rows, unpaired = split_lines(text.path, head_lines(data)[:-1], text.separator)
        layout = find_layout(text.path, rows, unpaired, is_whole=True)
        span = layout.spans[-1]
        if len(layout.spans) > 1 or span.last < len(rows):
            return None
        numbers = rows[span.first : span.last]
        signs = find_signs(
            text.path, ((line, cell) for line, cells in numbers for cell in cells), text.separator, stated
        )
        first = numbers[0]
        body, is_last_cut = _body(text, first[0])
        columns = _columns(body, text.separator, signs.decimal, first[1])
    except (NotPlainError, InputError):
        return None
    lines = range(first[0], first[0] + len(columns[0].values))
    header = tuple(line for line, _ in rows[span.top : span.first])
    cut = lines.stop if is_last_cut else None
    return PlainTable(tuple(rows[: span.top]), span, header, signs, columns, lines, cut)


def _body(text: ExportText, line: int) -> tuple[bytes, bool]:
    """The bytes from the beginning of a line to the end of the last row that was not cut, and whether one was."""
    data, start = text.data, 0
    for _ in range(line - 1):
        start = data.index(b"\n", start) + 1
    end = len(data)
    while data[end - 1] in b"\n\r \t":
        end -= 1
    tail = data[max(start, end - TAIL) : end].decode("utf-8", "replace").splitlines()[1:][-21:]
    rows, unpaired = split_lines(text.path, tail, text.separator)
    if len(rows) < 2:
        raise NotPlainError
    if cut := is_cut(rows, unpaired, text.is_whole):
        end = data.rindex(b"\n", start, end)
    return data[start:end].rstrip(b"\r\n") + (b"\r\n" if data.find(b"\r", start) >= 0 else b"\n"), cut


def _columns(body: bytes, separator: str, decimal: str, first: list[str]) -> tuple[Column, ...]:
    """All columns of the body. Raises NotPlainError for the first doubt."""
    proof = _Proof(separator, decimal, len(first), all(decimal in cell for cell in first), body.startswith(b'"'))
    with ThreadPoolExecutor(max(1, min(4, os.cpu_count() or 1))) as pool:
        parts = list(pool.map(proof.read, _chunks(body)))
    if sum(len(values[0]) for values, _ in parts) > MAX_ROWS:
        raise NotPlainError
    columns = []
    for index in range(len(first)):
        values = np.concatenate([part[index] for part, _ in parts])
        decimals = [counts[:, index] for _, counts in parts if counts is not None]
        columns.append(Column(values, np.concatenate(decimals) if decimals else None))
    return tuple(columns)


def _chunks(body: bytes) -> Iterator[bytes]:
    start = 0
    while start < len(body):
        end = body.find(b"\n", start + _CHUNK) + 1 or len(body)
        yield body[start:end]
        start = end


@dataclass(frozen=True)
class _Proof:
    """What each part of the body is held to. all_marked: every number has a decimal sign."""

    separator: str
    decimal: str
    width: int
    all_marked: bool
    quoted: bool

    def read(self, chunk: bytes) -> tuple[list[FloatArray], NDArray[np.int16] | None]:
        """Columns of whole lines, and the decimals of each cell (n, width) where not all numbers have a decimal sign."""
        codes = np.frombuffer(chunk, np.uint8)
        ends = np.flatnonzero(codes == _NEWLINE)
        self._check_characters(codes, ends)
        decimals = None if self.all_marked else self._decimals(codes)
        values = self._parse(chunk, len(ends))
        marks = np.count_nonzero(codes == ord(self.decimal))
        if self.all_marked and marks != len(ends) * self.width:
            raise NotPlainError
        return values, decimals

    def _check_characters(self, codes: Bytes, ends: NDArray[np.intp]) -> None:
        """Lines short enough, ends of lines alike, cells all quoted or all bare, no letters but of exponents."""
        longest = int(max(ends[0] + 1, np.diff(ends).max(initial=0)))
        returns = np.count_nonzero(codes == _RETURN)
        least = self.width * (3 if self.quoted else 1) + self.width
        if longest - least > MAX_NUMBER or (returns and not (codes[ends - 1] == _RETURN).all()):
            raise NotPlainError
        if returns not in (0, len(ends)):
            raise NotPlainError
        quotes = codes == _QUOTE
        if self.quoted:
            self._check_quotes(codes, quotes, ends - 1 - (returns > 0))
        elif quotes.any():
            raise NotPlainError
        if codes.max() > _NINE:
            letters = codes > _NINE
            known = sum(np.count_nonzero(codes == code) for code in {*_EXPONENTS, ord(self.separator)} if code > _NINE)
            if np.count_nonzero(letters) != known or not self.all_marked:
                raise NotPlainError

    def _check_quotes(self, codes: Bytes, quotes: NDArray[np.bool_], ends: NDArray[np.intp]) -> None:
        """Two quotation marks a cell, beside the separators and the ends of lines."""
        between = codes[1:-1] == ord(self.separator)
        fits = np.count_nonzero(between & quotes[:-2] & quotes[2:]) == len(ends) * (self.width - 1)
        whole = np.count_nonzero(quotes) == 2 * len(ends) * self.width
        if self.separator == " " or not (fits and whole and quotes[0] and quotes[ends].all()):
            raise NotPlainError

    def _decimals(self, codes: Bytes) -> NDArray[np.int16]:
        """(n, width) decimals of each cell."""
        if self.separator == " " or self.quoted:
            raise NotPlainError
        ends = np.flatnonzero((codes == _NEWLINE) | (codes == ord(self.separator)))
        if len(ends) % self.width or (codes[ends[self.width - 1 :: self.width]] != _NEWLINE).any():
            raise NotPlainError
        starts = np.concatenate(([0], ends[:-1] + 1))
        starts = starts + np.isin(codes[starts], np.frombuffer(b"+-", np.uint8))
        marks = np.flatnonzero(codes == ord(self.decimal))
        last = np.where(codes[ends - 1] == _RETURN, ends - 1, ends)
        cell = np.searchsorted(ends, marks)
        decimals = np.zeros(len(ends), np.int16)
        decimals[cell] = last[cell] - marks - 1
        blank = np.count_nonzero((codes == ord(" ")) | (codes == ord("\t")))
        if (blank and self.separator != "\t") or (
            (decimals == 0) & (codes[starts] == _ZERO) & (last - starts > 1)
        ).any():
            raise NotPlainError
        return decimals.reshape(-1, self.width)

    def _parse(self, chunk: bytes, rows: int) -> list[FloatArray]:
        import pandas

        exact: dict[str, Any] = {}
        if int(pandas.__version__.split(".")[0]) < 3:
            exact = {"float_precision": "round_trip"}
        separator = r"\s+" if self.separator == " " else self.separator
        try:
            frame = pandas.read_csv(
                BytesIO(chunk),
                sep=separator,
                decimal=self.decimal,
                header=None,
                dtype=np.float64,
                na_filter=False,
                low_memory=False,
                **exact,
            )
        except (ValueError, OverflowError) as error:
            raise NotPlainError from error
        if frame.shape != (rows, self.width):
            raise NotPlainError
        values = [frame[name].to_numpy() for name in frame.columns]
        if not all(np.isfinite(column).all() for column in values):
            raise NotPlainError
        return values
