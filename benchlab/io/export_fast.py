"""A long table of plain numbers, proven so by its bytes and read by pandas in threads; anything else is left to the strict reader.

What is proven of every row: as many cells as the first one, each a number of at most MAX_NUMBER characters that pandas reads
whole, no cell empty, all cells quoted or none, decimals marked by the sign of the file. pandas rounds each number to the nearest
float, as float() does.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError
from benchlab.io.export_layout import Span, find_layout, is_cut
from benchlab.io.export_numbers import BARE, Column, FloatArray, Signs, find_signs, tells_decimal
from benchlab.io.export_text import HEAD, MAX_ROWS, TAIL, ExportText, Row, head_lines, split_lines
from benchlab.io.numbers import MAX_NUMBER

MIN_BYTES = 16 * HEAD
"""Smaller files are left to the strict reader."""

_CHUNK = 1 << 20
_HEAD_LINES, _SAMPLE = 300, 100
"""Bytes that are proven at a time; lines by which the table is found, and rows by which the decimal sign is."""

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
        rows, unpaired = split_lines(text.path, head_lines(data)[:-1][:_HEAD_LINES], text.separator)
        layout = find_layout(text.path, rows, unpaired, is_whole=True)
        span = layout.spans[-1]
        if len(layout.spans) > 1 or span.last < len(rows):
            return None
        first, cells = rows[span.first]
        signs = _signs(text, rows[span.first : span.last][:_SAMPLE], stated)
        start, end, is_last_cut = _body(text, first)
        columns = _columns(text, start, end, first - 1, signs.decimal, cells)
    except (NotPlainError, InputError):
        return None
    lines = range(first, first + len(columns[0].values))
    header = tuple(line for line, _ in rows[span.top : span.first])
    cut = lines.stop if is_last_cut else None
    return PlainTable(tuple(rows[: span.top]), span, header, signs, columns, lines, cut)


def _signs(text: ExportText, rows: Sequence[Row], stated: str | None) -> Signs:
    """The signs of numbers, if the first rows prove them for all others: beside commas as separators, any point is for decimals."""
    signs = find_signs(text.path, ((line, cell) for line, cells in rows for cell in cells), text.separator, stated)
    proven = stated or text.separator == "," or any(tells_decimal(cell) for _, cells in rows for cell in cells)
    if not proven:
        raise NotPlainError
    return signs


def _body(text: ExportText, line: int) -> tuple[int, int, bool]:
    """Where a line begins, where the last row that was not cut ends (after its line end, if it has one), and whether one was cut."""
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
    return start, data.find(b"\n", end) + 1 or len(data), cut


def _columns(text: ExportText, start: int, end: int, header: int, decimal: str, first: list[str]) -> tuple[Column, ...]:
    """All columns between two places, which come after `header` lines. Raises NotPlainError for the first doubt."""
    all_marked = all(decimal in cell for cell in first)

    def proven() -> list[_Part]:
        data, quoted = text.data, text.data.startswith(b'"', start)
        if not quoted and data.find(b'"', start, end) >= 0:
            raise NotPlainError
        returns = data.find(b"\r", start, end) >= 0
        proof = _Proof(text.separator, decimal, len(first), all_marked, quoted, returns)
        return [proof.check(_whole_lines(data, *place)) for place in _places(data, start, end)]

    # The proof is made beside the reading: NumPy lets other threads run, and so does pandas.
    with ThreadPoolExecutor(1) as pool:
        proof = pool.submit(proven)
        values = _parsed(text, start, end, header, decimal)
        parts = proof.result()
    if values.shape != (sum(part.rows for part in parts), len(first)) or len(values) > MAX_ROWS:
        raise NotPlainError
    if any(part.exponents for part in parts) and not np.isfinite(values).all():
        raise NotPlainError
    if all_marked:
        return tuple(Column(column, None, complete=True) for column in values.T)
    decimals = np.concatenate([part.decimals for part in parts if part.decimals is not None])
    return tuple(Column(column, counts, complete=True) for column, counts in zip(values.T, decimals.T))


def _parsed(text: ExportText, start: int, end: int, header: int, decimal: str) -> FloatArray:
    """(n, width) numbers. From the file itself where its bytes are those that were proven: there pandas reads in threads."""
    import pandas

    exact: dict[str, Any] = {}
    if int(pandas.__version__.split(".")[0]) < 3:
        exact = {"float_precision": "round_trip"}
    as_stored = text.content.encoding in ("ascii", "utf-8", "utf-8-sig") and end == len(text.data)
    source = {"filepath_or_buffer": text.path, "skiprows": header} if as_stored else {}
    try:
        frame = pandas.read_csv(
            **(source or {"filepath_or_buffer": BytesIO(text.data[start:end])}),
            sep=r"\s+" if text.separator == " " else text.separator,
            decimal=decimal,
            header=None,
            dtype=np.float64,
            na_filter=False,
            compression=None,
            **exact,
        )
    except (ValueError, OverflowError, OSError) as error:
        raise NotPlainError from error
    return np.asarray(frame.to_numpy())


def _places(data: bytes, start: int, end: int) -> Iterator[tuple[int, int]]:
    """Places of whole lines, together about as long as _CHUNK."""
    while start < end:
        after = data.find(b"\n", start + _CHUNK, end) + 1 or end
        yield start, after
        start = after


def _whole_lines(data: bytes, start: int, end: int) -> memoryview:
    """A part of the file; the end of its last line is added where it is missing."""
    part = memoryview(data)[start:end]
    if part[-1] == _NEWLINE:
        return part
    line_end = b"\r\n" if data.find(b"\r", start, end) >= 0 else b"\n"
    return memoryview(bytes(part).rstrip(b"\r") + line_end)


@dataclass(frozen=True)
class _Part:
    """What is proven of some lines. decimals: (rows, width) of each cell, None where all numbers have a decimal sign."""

    rows: int
    exponents: bool
    decimals: NDArray[np.int16] | None


@dataclass(frozen=True)
class _Proof:
    """What each part of the body is held to. all_marked: every number has a decimal sign. returns: lines end in \\r\\n."""

    separator: str
    decimal: str
    width: int
    all_marked: bool
    quoted: bool
    returns: bool

    def check(self, lines: memoryview) -> _Part:
        """Raises NotPlainError where whole lines are not of plain numbers."""
        codes = np.frombuffer(lines, np.uint8)
        ends = np.flatnonzero(codes == _NEWLINE)
        self._check_lines(codes, ends)
        exponents = self._exponents(codes)
        if self.all_marked and np.count_nonzero(codes == ord(self.decimal)) != len(ends) * self.width:
            raise NotPlainError
        return _Part(len(ends), exponents, None if self.all_marked else self._decimals(codes))

    def _check_lines(self, codes: Bytes, ends: NDArray[np.intp]) -> None:
        """Lines short enough, ends of lines alike, cells all quoted."""
        longest = int(max(ends[0] + 1, np.diff(ends).max(initial=0)))
        least = self.width * (3 if self.quoted else 1) + self.width
        if longest - least > MAX_NUMBER:
            raise NotPlainError
        if self.returns and not (
            np.count_nonzero(codes == _RETURN) == len(ends) and (codes[ends - 1] == _RETURN).all()
        ):
            raise NotPlainError
        if self.quoted:
            self._check_quotes(codes, codes == _QUOTE, ends - 1 - self.returns)

    def _exponents(self, codes: Bytes) -> bool:
        """Whether there are letters, all of them of exponents."""
        if codes.max() <= _NINE:
            return False
        letters = np.count_nonzero(codes > _NINE)
        if ord(self.separator) > _NINE:
            letters -= np.count_nonzero(codes == ord(self.separator))
        if letters and not (self.all_marked and letters == sum(np.count_nonzero(codes == code) for code in _EXPONENTS)):
            raise NotPlainError
        return bool(letters)

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
        decimals[cell] = np.where(last[cell] > marks + 1, last[cell] - marks - 1, BARE)
        blank = np.count_nonzero((codes == ord(" ")) | (codes == ord("\t")))
        if (blank and self.separator != "\t") or (
            (decimals == 0) & (codes[starts] == _ZERO) & (last - starts > 1)
        ).any():
            raise NotPlainError
        return decimals.reshape(-1, self.width)
