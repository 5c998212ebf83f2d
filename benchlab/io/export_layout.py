"""Where the tables are in an export: the rows of numbers of each specimen, the names and units above them, the preamble."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from benchlab.errors import InputError, printable
from benchlab.io.export_columns import column_unit, known_words
from benchlab.io.export_numbers import has_unit, is_number
from benchlab.io.export_text import Row, all_numbers

_UNIT_CELL = re.compile(r"\s*[(\[][^()\[\]]*[)\]]\s*")
_NO_READING = re.compile(
    r"[+-]?(inf(inity)?|nan|over(load|flow|range)|[-*#?]+|#?n/?a!?|#\w+[!?]?|error|---?)", re.IGNORECASE
)
_FEW = 3


@dataclass(frozen=True)
class Span:
    """One table: rows[first:last] under names and units of `width` columns, "" where there is none; rows[top:first] are its header.

    label: what the header says over a first column that is empty: the specimen's number.
    """

    first: int
    last: int
    top: int
    names: tuple[str, ...]
    units: tuple[str, ...]
    label: str = ""

    @property
    def has_header(self) -> bool:
        return self.top < self.first


@dataclass(frozen=True)
class Layout:
    """The tables in the rows of a file; cut: the line of a last row that was cut and is in none of them."""

    spans: tuple[Span, ...]
    cut: int | None = None


def find_layout(path: Path, rows: Sequence[Row], unpaired: set[int], is_whole: bool) -> Layout:
    """All tables. is_whole: the last line has its end. Raises InputError, with the line, where a row does not fit its table."""
    spans: list[Span] = []
    cut: int | None = None
    index = below = 0
    while index < len(rows):
        if not _begins(rows, index):
            index += 1
            continue
        last = end = _end(rows, index)
        if last == len(rows) and last - index > 1 and is_cut(rows[index:], unpaired, is_whole):
            cut, end = rows[-1][0], last - 1
        _check_rows(path, rows, index, end, unpaired)
        span = _with_header(path, rows, below, index, end)
        if not spans or span.has_header:
            spans.append(span)
        elif all_numbers(rows[index][1]) or not _is_apart(rows, index):
            raise _gap(path, rows[below])
        index = below = last
    if not spans:
        raise _no_table(path, rows)
    if below == len(rows) - 1 and _is_rest(rows[below], rows[below - 1], unpaired, is_whole):
        cut = rows[below][0]
    return Layout(tuple(spans), cut)


def _begins(rows: Sequence[Row], index: int) -> bool:
    """Whether a table begins here: a row of numbers alone, or the first of some rows with two numbers or more in the same places."""
    cells = rows[index][1]
    if all_numbers(cells):
        return sum(map(bool, cells)) >= 2
    if len(cells) > 1 and all(is_number(cell) or _NO_READING.fullmatch(cell) for cell in cells):
        return any(map(is_number, cells))
    numeric = [is_number(cell) for cell in cells]
    same = rows[index + 1 : index + _FEW]
    return sum(numeric) >= 2 and len(same) == _FEW - 1 and all([is_number(c) for c in r] == numeric for _, r in same)


def _end(rows: Sequence[Row], first: int) -> int:
    """One past the last row of the table that begins at `first`."""
    width = len(rows[first][1])
    words = {i for i, cell in enumerate(rows[first][1]) if cell and not is_number(cell)}
    for index in range(first + 1, len(rows)):
        cells = rows[index][1]
        if all_numbers(cells):
            continue
        odd = [i for i, cell in enumerate(cells) if cell and not is_number(cell)]
        known = all(i in words or _NO_READING.fullmatch(cells[i]) for i in odd)
        few = 2 * len(odd) < sum(map(bool, cells)) and not _is_apart(rows, index)
        if len(cells) != width or not (known or few):
            return index
    return len(rows)


def _is_apart(rows: Sequence[Row], index: int) -> bool:
    """Whether there is a blank line before a row, as before statistics at the end."""
    return index > 0 and rows[index][0] > rows[index - 1][0] + 1


def is_cut(rows: Sequence[Row], unpaired: set[int], is_whole: bool) -> bool:
    """Whether the last of a table's rows ended before it was whole: fewer cells, or fewer decimals at the end of the file."""
    number, last = rows[-1]
    before = [cells for _, cells in rows[-21:-1]]
    if len(last) < len(before[-1]) or number in unpaired:
        return True
    if len(last) > len(before[-1]):
        return False
    if not last[-1]:
        return all(cells[-1] for cells in before)
    if is_whole:
        return False
    decimals = {_decimals(cells[-1]) for cells in before}
    return len(decimals) == 1 and _decimals(last[-1]) < decimals.pop()


def _is_rest(row: Row, before: Row, unpaired: set[int], is_whole: bool) -> bool:
    """Whether the file's last row, which is in no table, is what is left of one of its rows."""
    number, cells = row
    return number in unpaired or (not is_whole and len(cells) <= len(before[1]) and any(map(is_number, cells)))


def _decimals(cell: str) -> int:
    match = re.search(r"[.,](\d*)$", cell)
    return len(match[1]) if match else 0


def _check_rows(path: Path, rows: Sequence[Row], first: int, last: int, unpaired: set[int]) -> None:
    """Raises InputError for a row of another length than the first one, or with a quotation mark that lacks its partner."""
    line, width = rows[first][0], len(rows[first][1])
    for number, cells in rows[first:last]:
        if len(cells) != width:
            what = f"row has {len(cells)} fields, the first one (line {line}) {width}"
            hint = "a decimal comma, or a comma within a cell? separate the columns by semicolons"
            raise InputError(what, file=path, where=f"line {number}", hint=hint)
    if odd := sorted(n for n in unpaired if rows[first][0] <= n <= rows[last - 1][0]):
        hint = "is there a quotation mark without its partner?"
        raise InputError("not a table row", file=path, where=f"line {odd[0]}", hint=hint)


def _with_header(path: Path, rows: Sequence[Row], below: int, first: int, last: int) -> Span:
    """The table with its header, which lies after row `below`. Raises InputError for a header of another length."""
    line, cells = rows[first]
    width = len(cells)
    top = first
    units: list[str] = []
    if top > below and _is_units(rows[top - 1][1]):
        top -= 1
        units = [cell.strip("()[] ") for cell in rows[top][1]]
    names: list[str] = []
    if top > below and _is_names(rows[top - 1][1], width, bool(units)):
        top -= 1
        names = rows[top][1]
    if names and top > below and _is_split(rows[top - 1][1], names):
        top -= 1
        names = [_fuller(upper, lower) for upper, lower in zip(rows[top][1], names)]
    used = _used(rows[first:last], width)
    for what, found in (("header", names), ("row of units", units)):
        if _filled(found) > width or (what == "header" and 0 < len(found) < used):
            said = f"row has {width} fields, {what} {len(found)}"
            hint = "a decimal comma, or a comma within a cell? separate the columns by semicolons"
            raise InputError(said, file=path, where=f"line {line}", hint=hint)
    names = (names + [""] * width)[:width] if names else []
    units = (units + [""] * width)[:width] if units else []
    label = names[0] if names and is_number(names[0]) else ""
    return Span(first, last, top, tuple(names), tuple(units), label)


def _is_units(cells: Sequence[str]) -> bool:
    """Whether a row holds units alone, in brackets or bare."""
    there = [cell for cell in cells if cell]
    if all(_UNIT_CELL.fullmatch(cell) for cell in there):
        return True
    return all(column_unit(cell.strip("()[]")) for cell in there) and not any(map(is_number, there))


def _is_names(cells: Sequence[str], width: int, has_units: bool) -> bool:
    """Whether a row names columns: words, and no number but a specimen's over the first column."""
    if any(is_number(cell) or has_unit(cell) for cell in cells[1:]) or not any(
        cell and not is_number(cell) for cell in cells
    ):
        return False
    if known_words(cells):
        return True
    if is_number(cells[0]):
        return False
    return (len(cells) == width and (has_units or sum(map(bool, cells)) > 1)) or (has_units and len(cells) > 1)


def _is_split(upper: Sequence[str], names: Sequence[str]) -> bool:
    """Whether a row above the names is a first line of them: a word in each place, two of which name quantities."""
    return len(upper) == len(names) and all(upper) and not any(map(is_number, upper)) and known_words(upper) > 1


def _fuller(upper: str, lower: str) -> str:
    """The one of a name's two lines that names a quantity, else both."""
    named = [part for part in (lower, upper) if known_words([part])]
    return named[0] if named else f"{upper} {lower}"


def _filled(cells: Sequence[str]) -> int:
    """How many cells there are without the empty ones at the end."""
    return max((i for i, cell in enumerate(cells, 1) if cell), default=0)


def _used(rows: Sequence[Row], width: int) -> int:
    """How many columns there are without those at the end in which no row has a cell."""
    while width and not any(cells[width - 1] for _, cells in rows):
        width -= 1
    return width


def _gap(path: Path, row: Row) -> InputError:
    """Numbers go on after a row that is none of the table, and is no header either."""
    number, cells = row
    odd = next((cell for cell in cells if cell and not is_number(cell)), ";".join(cells))
    hint = "remove the row, or export again"
    return InputError(f"{printable(odd)!r} is not a number", file=path, where=f"line {number}", hint=hint)


def _no_table(path: Path, rows: Sequence[Row]) -> InputError:
    hint = "export the raw data: rows of numbers, separated by commas, semicolons or tabs"
    for number, cells in rows:
        if sum(map(is_number, cells)) >= 2:
            odd = next(cell for cell in cells if cell and not is_number(cell))
            return InputError(
                f"no row of numbers: {printable(odd[:40])!r} is not one", file=path, where=f"line {number}", hint=hint
            )
    return InputError("no data rows", file=path, hint=hint)
