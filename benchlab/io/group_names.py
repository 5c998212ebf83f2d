"""Names of groups and samples as the cells of a table give them."""

from __future__ import annotations

from collections.abc import Sequence

from benchlab.errors import InputError, UsageError
from benchlab.io.delimited import Table
from benchlab.io.exact_numbers import check_column
from benchlab.io.table import unguarded


class NameReader:
    """Reads the name that one or more columns of a row give. Blanks around it do not count; where that makes two one, `warnings` says so.

    option: that named the columns, for what is refused.
    """

    def __init__(self, table: Table, columns: Sequence[str], option: str) -> None:
        for column in columns:
            check_column(table, column, option)
        if len(set(columns)) < len(columns):
            raise UsageError(f"{option} names column {columns[0]!r} twice", hint="name it once")
        self.table, self.columns = table, tuple(columns)
        self._places = [table.header.index(column) for column in columns]
        self._parts: dict[str, list[str]] = {}
        self._written: dict[str, str] = {}
        self._blanks: dict[str, None] = {}

    def read(self, cells: list[str], line: int) -> str:
        """The name: the cell of the one column, or `3 / 10` for two. InputError for an empty cell, or where two names would read alike."""
        texts = [unguarded(cells[place].strip()) for place in self._places]
        if "" in texts:
            column = self.columns[texts.index("")]
            where = f"line {line}, column {column}"
            raise InputError("empty cell where a name should stand", file=self.table.path, where=where)
        name = " / ".join(texts)
        if self._parts.setdefault(name, texts) != texts:
            what = f"two groups would both be called {name[:40]!r}"
            raise InputError(what, file=self.table.path, where=f"line {line}", hint="write names without strokes")
        written = "\0".join(cells[place] for place in self._places)
        if self._written.setdefault(name, written) != written:
            self._blanks[name] = None
        return name

    @property
    def warnings(self) -> list[str]:
        named = ", ".join(repr(name[:40]) for name in list(self._blanks)[:5])
        return [f"names that differ only in blanks around them are taken as one: {named}"] * bool(self._blanks)
