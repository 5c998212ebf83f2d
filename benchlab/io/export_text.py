"""The lines of an export: read within limits, split by the separator that the file has, each with its number."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchlab.errors import InputError, printable
from benchlab.io.delimited import MAX_BYTES, MAX_COLUMNS, MAX_LINE
from benchlab.io.encoding import Decoded, check_text, decoded
from benchlab.io.export_numbers import NUMBER, is_number
from benchlab.io.files import check_regular_file

MAX_ROWS = 3_000_000
"""Most lines that are read."""

SEPARATORS = {"\t": "tab", ";": "semicolon", "|": "bar", ",": "comma", " ": "blanks"}
"""Name of each separator, those first that are taken where two fit alike."""

HEAD, TAIL = 1 << 14, 1 << 13
"""Bytes at the beginning and the end of a file by which its separator is found."""

_SAMPLE = 150
"""Lines of each of them that are looked at, in a longer file."""

Row = tuple[int, list[str]]

_ROW = re.compile(rf"(?:{NUMBER})?(?:\t(?:{NUMBER})?)*")
_WITH_UNIT = re.compile(rf"(?:^|(?<=[,;\t\"|]))\s*(?:{NUMBER})\s*[a-zA-Zµ%]{{1,4}}\s*(?=[,;\t\"|]|$)")
_LINE_ENDS = re.compile(r"\r\n|\r|\n")


@dataclass(frozen=True)
class ExportText:
    """A file's content as UTF-8 with \\n or \\r\\n at the ends of lines, and its separator."""

    path: Path
    content: Decoded
    separator: str

    @property
    def data(self) -> bytes:
        return self.content.data

    @property
    def is_whole(self) -> bool:
        """Whether the last line has its end."""
        return self.data.endswith((b"\n", b"\r"))


def read_text(path: Path, encoding: str | None = None) -> ExportText:
    """Raises UsageError or InputError for a file that is missing, too large, not text, or without a row of numbers."""
    if (size := check_regular_file(path).st_size) > MAX_BYTES:
        raise InputError(f"{size / 1e6:.0f} MB, more than the limit of {MAX_BYTES / 1e6:.0f} MB", file=path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"could not be read: {error.strerror or error}", file=path) from error
    check_text(path, data[:4096])
    content = decoded(path, data, encoding)
    if b"\n" not in content.data and b"\r" in content.data:
        content = Decoded(content.data.replace(b"\r", b"\n"), content.encoding, content.doubt)
    if (at := content.data.find(b"\0")) >= 0:
        line = content.data.count(b"\n", 0, at) + 1
        raise InputError("binary data", file=path, where=f"line {line}", hint="this is not a text table")
    return ExportText(path, content, _separator(path, content.data))


def head_lines(data: bytes) -> list[str]:
    """The lines at the beginning of a file; the last of them may be cut."""
    return _LINE_ENDS.split(data[:HEAD].decode("utf-8", "replace"))


def rows_of(text: ExportText) -> tuple[list[Row], set[int]]:
    """Rows of cells that are not blank, and the numbers of the lines with a quotation mark that lacks its partner."""
    lines = _LINE_ENDS.split(text.data.decode("utf-8"))
    if len(lines) > MAX_ROWS:
        raise InputError(f"{len(lines)} lines, more than the limit of {MAX_ROWS}", file=text.path)
    if max(map(len, lines)) > MAX_LINE:
        number = next(i for i, line in enumerate(lines, 1) if len(line) > MAX_LINE)
        raise _too_long(text.path, number, lines[number - 1], text.separator)
    return split_lines(text.path, lines, text.separator)


def split_lines(path: Path, lines: Sequence[str], separator: str) -> tuple[list[Row], set[int]]:
    """As `rows_of`, of lines that are numbered from 1."""
    unpaired = {i for i, line in enumerate(lines, 1) if line.count('"') % 2}
    rows = []
    for number, cells in enumerate(_cells(lines, separator, unpaired), 1):
        if len(cells) > MAX_COLUMNS:
            raise _many(path, number)
        stripped = [cell.strip() for cell in cells]
        if any(stripped):
            rows.append((number, stripped))
    return rows, unpaired


def all_numbers(cells: Sequence[str]) -> bool:
    """Whether every cell that is not empty is meant as a number."""
    return bool(_ROW.fullmatch("\t".join(cells)))


def _cells(lines: Iterable[str], separator: str, unpaired: set[int]) -> Iterable[list[str]]:
    if separator == " ":
        return (_by_blanks(line) for line in lines)
    paired = (line.replace('"', "") if i in unpaired else line for i, line in enumerate(lines, 1))
    return csv.reader(paired, delimiter=separator)


def _by_blanks(line: str) -> list[str]:
    """Cells between blanks; between two blanks or more where there are words with single ones, as in a header."""
    cells = [cell.strip('"') for cell in line.split()]
    wide = re.split(r"\s{2,}|\t", line.strip())
    return wide if len(wide) > 1 and not all_numbers(cells) else cells


def _separator(path: Path, data: bytes) -> str:
    """The separator that splits most lines into numbers."""
    _check_first_line(path, data)
    head = head_lines(data)
    tail: list[str] = []
    if len(data) > HEAD:
        head, tail = head[:-1][:_SAMPLE], _LINE_ENDS.split(data[-TAIL:].decode("utf-8", "replace"))[1:][-_SAMPLE:]
    sample = [line[:MAX_LINE] for line in (*head, *tail) if line.strip()]
    if not sample:
        raise InputError("no data rows", file=path, hint="the file holds no text")

    def count(separator: str) -> int:
        unpaired = {i for i, line in enumerate(sample, 1) if line.count('"') % 2}
        rows = ([cell.strip() for cell in cells] for cells in _cells(sample, separator, unpaired))
        return sum(sum(map(bool, cells)) >= 2 and all_numbers(cells) for cells in rows)

    counts = {separator: count(separator) for separator in SEPARATORS}
    best = max(SEPARATORS, key=counts.__getitem__)
    if best == "," and counts[" "] == counts[","]:
        _check_blanks(path, data)
    return best if counts[best] else _by_numbers(path, data, sample)


def _check_blanks(path: Path, data: bytes) -> None:
    """Raises InputError for a line as `0,100 200,500`: decimal commas between blanks, or blanks for thousands between commas."""
    for number, line in enumerate(head_lines(data), 1):
        cells = [cell.strip() for cell in line.split(",")]
        if any(" " in cell for cell in cells) and all_numbers(cells) and all_numbers(line.split()):
            what = f"{printable(line[:40])!r} could be separated by commas or by blanks"
            hint = "export it with semicolons or tabs between the columns"
            raise InputError(what, file=path, where=f"line {number}", hint=hint)


def _by_numbers(path: Path, data: bytes, sample: Sequence[str]) -> str:
    """The separator of a file without a row that holds numbers alone. Raises InputError where none gives two numbers in a line."""

    def count(separator: str) -> int:
        split = (line.split() if separator == " " else line.split(separator) for line in sample)
        return sum(sum(is_number(cell.strip(' "')) for cell in cells) >= 2 for cells in split)

    counts = {separator: count(separator) for separator in SEPARATORS}
    best = max(SEPARATORS, key=counts.__getitem__)
    if counts[best]:
        return best
    for number, line in enumerate(head_lines(data), 1):
        units = [match[0].strip() for match in _WITH_UNIT.finditer(line)]
        if len(units) > 1:
            hint = "put the unit in the header, as in Load (N)"
            where = f"line {number}"
            raise InputError(f"unit in a cell: {printable(units[0])!r}", file=path, where=where, hint=hint)
    hint = "export the raw data: rows of numbers, separated by commas, semicolons or tabs"
    raise InputError("no data rows: no line with two numbers in it", file=path, hint=hint)


def _check_first_line(path: Path, data: bytes) -> None:
    """Raises InputError for a first line that is longer than the limit."""
    start = data[: MAX_LINE * 4]
    if len(start) > MAX_LINE and not re.search(rb"[\r\n]", start[: MAX_LINE + 1]):
        line = re.split(rb"[\r\n]", start)[0].decode("utf-8", "replace")
        raise _too_long(path, 1, line, max(SEPARATORS, key=line.count))


def _too_long(path: Path, number: int, line: str, separator: str) -> InputError:
    if line.count(separator) + 1 > MAX_COLUMNS:
        return _many(path, number)
    hint = "are there ends of lines in it?"
    return InputError(f"line longer than {MAX_LINE} characters", file=path, where=f"line {number}", hint=hint)


def _many(path: Path, number: int) -> InputError:
    hint = "export the columns of force, extension and time alone"
    return InputError(f"more than {MAX_COLUMNS} columns", file=path, where=f"line {number}", hint=hint)
