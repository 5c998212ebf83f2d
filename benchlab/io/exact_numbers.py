"""Numbers of a table as they are written, in decimals, so that no digit is lost before anything is subtracted."""

from __future__ import annotations

import difflib
import re

from benchlab.errors import InputError, UsageError, printable
from benchlab.io.delimited import Table
from benchlab.io.numbers import NumberReader

_NO_NUMBER = re.compile(r"|[+-]?(nan|inf|infinity)|n/?a|null|none|-+|–|—", re.IGNORECASE)
"""What loggers and spreadsheets write where there is no number."""

MOST_TOLD = 5


class ExactReader:
    """Reads cells of one table as decimal texts with a point. Cells without a number are counted in `missing`: line, column, text."""

    def __init__(self, table: Table) -> None:
        self.table = table
        self.missing: list[tuple[int, str, str]] = []
        self._numbers = NumberReader(table.path, table.delimiter)

    def read(self, cells: list[str], line: int, column: str) -> str | None:
        """The number in a column of a row; None where the cell says that there is none. InputError for any other text."""
        cell = cells[self.table.header.index(column)].strip()
        if _NO_NUMBER.fullmatch(cell):
            self.missing.append((line, column, cell or "empty"))
            return None
        where = f"line {line}, column {printable(column)}"
        try:
            self._numbers.read(cell, line)
        except InputError as error:
            raise InputError(error.what, file=self.table.path, where=where, hint=error.hint) from error
        if self._numbers.unreadable:
            raise InputError(f"not a number: {cell!r}", file=self.table.path, where=where)
        return cell.replace(",", ".")

    def close(self, leave_out: bool) -> list[str]:
        """What must be told once all rows are read. Raises InputError for missing numbers unless they may be left out."""
        if self._numbers.commas_may_be_thousands:
            what = "commas in numbers could be decimal commas or thousands separators"
            raise InputError(what, file=self.table.path, hint="write a decimal point, and no thousands separators")
        if not self.missing:
            return []
        rows = {line: f"line {line} {printable(column)}: {text}" for line, column, text in reversed(self.missing)}
        told = "; ".join(rows[line] for line in sorted(rows)[:MOST_TOLD])
        more = f" and {len(rows) - MOST_TOLD} more" * (len(rows) > MOST_TOLD)
        what = f"{len(rows)} row{'s' * (len(rows) > 1)} without a number ({told}{more})"
        if not leave_out:
            hint = "complete them, or leave these rows out with --leave-out-missing"
            raise InputError(what, file=self.table.path, hint=hint)
        return [f"left out: {what}"]


def check_column(table: Table, name: str, option: str) -> None:
    """Raises UsageError unless the table has one column of this name."""
    count = table.header.count(name)
    if count == 1:
        return
    where = f"line {table.header_line}"
    if count > 1:
        raise UsageError(f"{count} columns are named {name!r}", file=table.path, where=where, hint="rename one")
    close = difflib.get_close_matches(name, table.header, n=1, cutoff=0.5)
    listed = ", ".join(table.header[:10]) + ", …" * (len(table.header) > 10)
    hint = f"did you mean {close[0]!r}? columns: {listed}" if close else f"columns: {listed}"
    raise UsageError(f"no column {name!r} for {option}", file=table.path, where=where, hint=hint)
