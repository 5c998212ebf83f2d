"""A table of summaries, a row a group: mean, standard deviation and number of samples, as papers print them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

from benchlab.errors import InputError, UsageError
from benchlab.io.delimited import open_table
from benchlab.io.exact_numbers import ExactReader, check_column
from benchlab.io.group_names import NameReader

MOST_SAMPLES = 1_000_000_000


@dataclass(frozen=True)
class SummaryTable:
    """G rows in the order of the file: names, n, mean and sd, each (G,)."""

    names: tuple[str, ...]
    n: tuple[int, ...]
    mean: tuple[Decimal, ...]
    sd: tuple[float, ...]
    warnings: tuple[str, ...]


def read_summary_table(
    path: Path, group: Sequence[str], mean: str, sd: str, n: str, leave_out_missing: bool = False
) -> SummaryTable:
    """The columns named. Raises UsageError for columns that are not there; InputError, with the line, for a cell that is no number, an n
    that is no count, a negative SD, and a group that stands twice."""
    with open_table(path) as table:
        for name, option in ((mean, "--mean"), (sd, "--sd"), (n, "--n")):
            check_column(table, name, option)
        names = NameReader(table, group, "--group")
        if len({mean, sd, n, *group}) < 3 + len(group):
            raise UsageError("one column is named by two of --mean, --sd, --n and --group", file=path)
        reader = ExactReader(table)
        lines: dict[str, int] = {}
        rows: list[tuple[str, int, Decimal, float]] = []
        for line, cells in table.rows:
            name = names.read(cells, line)
            texts = [reader.read(cells, line, column) for column in (n, mean, sd)]
            if None in texts:
                continue
            count, centre, spread = (Decimal(text or 0) for text in texts)
            if name in lines:
                what = f"group {name[:40]!r} stands twice, in lines {lines[name]} and {line}"
                raise InputError(what, file=path, where=f"line {line}", hint="give one row a group")
            lines[name] = line
            if not 1 <= count <= MOST_SAMPLES or count != int(count):
                what = f"{n} is {count}, not a count from 1 to {MOST_SAMPLES}"
                raise InputError(what, file=path, where=f"line {line}, column {n}")
            if spread < 0:
                raise InputError(f"{sd} is {spread}, below 0", file=path, where=f"line {line}, column {sd}")
            rows.append((name, int(count), centre, float(spread)))
        warnings = [*table.warnings, *reader.close(leave_out_missing), *names.warnings]
    if not rows:
        raise InputError("no data rows", file=path, hint="the file holds only a header")
    found, counts, means, spreads = zip(*rows)
    return SummaryTable(found, counts, means, spreads, tuple(warnings))
