"""Text tables as loggers and spreadsheets write them, read strictly: every row counted, every refusal with its line.

Separators `,` `;` and tab; UTF-8, UTF-16 and Latin-1; decimal points or decimal commas. Nothing is unpacked, and file,
line, column and cell sizes have limits, so that no file can take more memory or time than its size lets expect.
"""

from __future__ import annotations

import codecs
import csv
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from benchlab.errors import InputError
from benchlab.io.encoding import check_text, unicode_encoding
from benchlab.io.files import check_regular_file

MAX_BYTES = 200_000_000
MAX_COLUMNS = 1000
MAX_LINE = 100_000
"""Limits: bytes in a file, columns, characters in a line."""

_DELIMITERS = ("\t", ";", ",")


@dataclass
class Table:
    """An open table. `rows` gives (line number, cells), each with as many cells as `header`; blank lines are left out.

    A last row with fewer cells than the header was cut while it was written: it is left out, and `warnings` says so.
    """

    path: Path
    encoding: str
    delimiter: str
    header: tuple[str, ...]
    header_line: int
    rows: Iterator[tuple[int, list[str]]]
    warnings: list[str] = field(default_factory=list)


@contextmanager
def open_table(path: Path) -> Iterator[Table]:
    """The table in a text file, its header read and its rows still to come.

    Raises UsageError or InputError for a file that is missing, too large, not text, or without a header.
    """
    if (size := check_regular_file(path).st_size) > MAX_BYTES:
        raise InputError(f"{size / 1e6:.0f} MB, more than the limit of {MAX_BYTES / 1e6:.0f} MB", file=path)
    encoding = encoding_of(path)
    try:
        with path.open(encoding=encoding, newline=None) as file:
            lines = Lines(path, file)
            first, delimiter = _sniff_delimiter(lines)
            records = _records(path, lines, first, delimiter)
            header_line, header = next(records)
            if len(header) > MAX_COLUMNS:
                raise InputError(f"{len(header)} columns, more than the limit of {MAX_COLUMNS}", file=path)
            names = tuple(cell.strip() for cell in header)
            table = Table(path, encoding, delimiter, names, header_line, iter(()))
            table.rows = _counted(table, records)
            yield table
    except UnicodeError as error:
        raise InputError(f"not readable as {encoding} text", file=path, hint="save it as UTF-8") from error
    except OSError as error:
        raise InputError(f"could not be read: {error.strerror or error}", file=path) from error


class Lines:
    """The lines of a file, counted, each checked for its length and for bytes that no text has."""

    def __init__(self, path: Path, file: IO[str]) -> None:
        self.path, self.file, self.number = path, file, 0

    def __iter__(self) -> Iterator[str]:
        while line := self.file.readline(MAX_LINE + 1):
            self.number += 1
            if len(line) > MAX_LINE:
                raise InputError(f"line longer than {MAX_LINE} characters", file=self.path, where=f"line {self.number}")
            if "\0" in line:
                raise InputError(
                    "binary data", file=self.path, where=f"line {self.number}", hint="this is not a text table"
                )
            yield line


def encoding_of(path: Path) -> str:
    """Encoding by byte order mark, by the zeros of plain UTF-16, or UTF-8 where all bytes fit it, else Latin-1."""
    with path.open("rb") as file:
        head = file.read(4096)
        check_text(path, head)
        if found := unicode_encoding(head):
            return found
        decoder = codecs.getincrementaldecoder("utf-8")()
        file.seek(0)
        try:
            while block := file.read(1 << 20):
                decoder.decode(block)
            decoder.decode(b"", final=True)
        except UnicodeDecodeError:
            return "latin-1"
    return "utf-8"


def _sniff_delimiter(lines: Lines) -> tuple[list[tuple[int, str]], str]:
    """The header line and the one after it, each with its number, and the separator that splits both alike.

    Before the header, blank lines, comments with # and a spreadsheet's `sep=` are passed over.
    """
    found: list[tuple[int, str]] = []
    for line in lines:
        if not line.strip() or (not found and line.lstrip().lower().startswith(("#", "sep="))):
            continue
        found.append((lines.number, line))
        if len(found) == 2:
            break
    if not found:
        raise InputError("no data rows", file=lines.path, hint="the file holds no text")
    counts = {d: [len(_split(line, d)) for _, line in found] for d in _DELIMITERS}
    possible = [d for d in _DELIMITERS if counts[d][0] > 1]
    if not possible:
        hint = "separate the columns by a comma, a semicolon or a tab"
        raise InputError("only one column", file=lines.path, where=f"line {found[0][0]}", hint=hint)
    return found, next((d for d in possible if len(set(counts[d])) == 1), possible[0])


def _split(line: str, delimiter: str) -> list[str]:
    return next(csv.reader([line], delimiter=delimiter), [])


def _records(
    path: Path, lines: Lines, first: Iterable[tuple[int, str]], delimiter: str
) -> Iterator[tuple[int, list[str]]]:
    """(number of the record's first line, cells) for each record that is not blank."""
    start = 0

    def numbered() -> Iterator[str]:
        nonlocal start
        for number, line in first:
            start = start or number
            yield line
        for line in lines:
            start = start or lines.number
            yield line

    reader = csv.reader(numbered(), delimiter=delimiter, strict=True)
    while True:
        start = 0
        try:
            cells = next(reader)
        except StopIteration:
            return
        except csv.Error as error:
            hint = "is there a quotation mark without its partner?"
            raise InputError(f"not a table row: {error}", file=path, where=f"line {start}", hint=hint) from error
        if any(cell.strip() for cell in cells):
            yield start, cells


def _counted(table: Table, records: Iterator[tuple[int, list[str]]]) -> Iterator[tuple[int, list[str]]]:
    short: tuple[int, list[str]] | None = None
    for line, cells in records:
        if short is not None or len(cells) > len(table.header):
            at, wrong = short or (line, cells)
            what = f"row has {len(wrong)} fields, header {len(table.header)}"
            hint = None
            if table.delimiter == "," and len(wrong) > len(table.header):
                hint = "a decimal comma, or a comma within a cell? separate the columns by semicolons"
            raise InputError(what, file=table.path, where=f"line {at}", hint=hint)
        if len(cells) < len(table.header):
            short = line, cells
            continue
        yield line, cells
    if short is not None:
        table.warnings.append(f"the last row (line {short[0]}) is cut and was left out")
