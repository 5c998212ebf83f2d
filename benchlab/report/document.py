"""A report before it is dressed: sections of words, tables and pictures, told once for the page, the PDF and the CSV files."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from benchlab.errors import printable
from benchlab.io.files import written_whole
from benchlab.io.table import guarded

Value = str | float | int | None

NONE = "–"
"""What stands on the page where there is no value."""


class Cell(NamedTuple):
    """A value as a machine reads it, and as a person does."""

    value: Value
    text: str


@dataclass(frozen=True)
class Column:
    """name: in the CSV file, with its unit (`mean_deg`). head: on the page (`mean (°)`). Either may be "": not there.
    number: set right."""

    name: str
    head: str = ""
    number: bool = True


@dataclass(frozen=True)
class Table:
    """name: of its CSV file. rows: a cell a column. by: a column whose text stands as a line over the rows that share it, on the page.
    most: rows shown on the page; the CSV file has all."""

    name: str
    caption: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""
    by: str = ""
    most: int = 60

    @property
    def heads(self) -> tuple[Column, ...]:
        """The columns of the page."""
        return tuple(self.columns[index] for index in self._kept)

    @property
    def shown(self) -> tuple[tuple[str, ...], ...]:
        """The texts of the page, row by row."""
        return tuple(tuple(row[index].text for index in self._kept) for row in self.rows[: self.most])

    @property
    def _kept(self) -> list[int]:
        """Columns with a head and, of a table with rows, with something in them."""
        return [
            index
            for index, column in enumerate(self.columns)
            if column.head and (not self.rows or any(row[index].text not in ("", NONE) for row in self.rows))
        ]

    @property
    def lines(self) -> tuple[str, ...]:
        """For each row of the page: what stands as a line over it, or ""."""
        at = next((index for index, column in enumerate(self.columns) if self.by and column.name == self.by), None)
        over = ["" if at is None else row[at].text for row in self.rows[: self.most]]
        return tuple("" if index and over[index - 1] == text else text for index, text in enumerate(over))

    @property
    def notes(self) -> tuple[str, ...]:
        """What stands under it, first of all that the page does not have all rows."""
        left_off = f"The first {self.most} of {len(self.rows)} rows; all are in {self.name}.csv."
        return tuple(line for line in (left_off * (len(self.rows) > self.most), self.note) if line)


@dataclass(frozen=True)
class Panel:
    """One figure: name of its files, svg: the text of an SVG file, words: what it shows, for those who do not see it; png: its bytes."""

    name: str
    svg: str
    words: str
    png: bytes = b""


@dataclass(frozen=True)
class Pictures:
    """Panels that share a caption, side by side as they fit; stacked: in two columns, each filled from the top."""

    panels: tuple[Panel, ...]
    caption: str
    stacked: bool = False


@dataclass(frozen=True)
class Words:
    """A paragraph. kind: plain, lead (large), warning or small. head: bold words before it."""

    text: str
    kind: str = "plain"
    head: str = ""


class Tile(NamedTuple):
    """A number to be seen from afar, what it is, and what belongs to it in small letters."""

    value: str
    name: str
    note: str = ""


@dataclass(frozen=True)
class Tiles:
    """Tiles in a row."""

    row: tuple[Tile, ...]


@dataclass(frozen=True)
class Items:
    """A list; each with what it is about and what is said of it."""

    rows: tuple[tuple[str, str], ...]


Block = Words | Tiles | Items | Table | Pictures


@dataclass(frozen=True)
class Section:
    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Document:
    """statement: what must be known before anything is read (drawn data), or empty. facts: the lines under the title.
    data: tables that are CSV files and not on the page."""

    title: str
    statement: str
    facts: tuple[str, ...]
    sections: tuple[Section, ...]
    foot: str = ""
    data: tuple[Table, ...] = ()

    def blocks(self) -> Iterator[Block]:
        for section in self.sections:
            yield from section.blocks

    @property
    def tables(self) -> tuple[Table, ...]:
        """All that are CSV files."""
        return (*(block for block in self.blocks() if isinstance(block, Table)), *self.data)

    @property
    def panels(self) -> tuple[Panel, ...]:
        return tuple(panel for block in self.blocks() if isinstance(block, Pictures) for panel in block.panels)


def write_table(path: Path, table: Table) -> None:
    """A table as CSV: every row, every digit, an empty cell for what is not known. InputError where the disk refuses."""
    with (
        written_whole(path) as temporary,
        temporary.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        kept = [index for index, column in enumerate(table.columns) if column.name]
        writer.writerow([table.columns[index].name for index in kept])
        writer.writerows([_machine(row[index].value) for index in kept] for row in table.rows)


def cut(text: object, length: int = 60) -> str:
    """Text as the page shows it: control characters escaped, the middle of a long one cut out.

    >>> cut("slw\\x1b5"), cut("a" * 30 + ".mp4", 12)
    ('slw\\\\x1b5', 'aaaaaaa….mp4')
    """
    plain = printable(text)
    if len(plain) <= length:
        return plain
    tail = min(max(4, length // 4), length // 2)
    return plain[: length - tail - 1] + "…" + plain[-tail:]


def listed(rows: Sequence[tuple[str, str]], whole: str, most: int = 100) -> Items:
    """A list of what and why, cut. whole: the file that has all of a longer one."""
    shown = [(cut(what, 160), cut(why, 400)) for what, why in rows[:most]]
    if len(rows) > most:
        shown.append((f"and {len(rows) - most} more", f"all are in {whole}"))
    return Items(tuple(shown))


def marked(section: Section, mark: str) -> Section:
    """The section with a mark before the captions of its tables and pictures; as it is for ""."""
    if not mark:
        return section
    blocks = (
        replace(block, caption=f"{mark.capitalize()}. {block.caption}")
        if isinstance(block, Pictures | Table)
        else block
        for block in section.blocks
    )
    return replace(section, blocks=tuple(blocks))


def _machine(value: Value) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return guarded(value)
    return repr(value) if isinstance(value, float) else str(value)
