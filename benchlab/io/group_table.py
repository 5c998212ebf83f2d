"""A table of measured values, a row a sample or a row a cycle of a sample, read as decimal texts with the names of their groups.

Rows that repeat a sample are its cycles. Cycles taken for samples make differences out of nothing, so a table that looks as if its
rows were cycles is refused until it is said what tells the samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from benchlab.errors import InputError, UsageError
from benchlab.io.delimited import Table, open_table
from benchlab.io.exact_numbers import ExactReader, check_column
from benchlab.io.group_names import NameReader

SAMPLE_COLUMNS, CYCLE_COLUMNS = ("sample", "specimen", "actuator"), ("cycle",)
"""Names, in any case, of columns that say what the rows are."""


@dataclass(frozen=True)
class GroupTable:
    """R rows in the order of the file: groups, samples and values, each (R,). samples: None where each row is a sample."""

    groups: tuple[str, ...]
    samples: tuple[str, ...] | None
    values: tuple[str, ...]
    warnings: tuple[str, ...]


def read_group_table(
    path: Path,
    value: str,
    group: Sequence[str],
    sample: str | None = None,
    rows_are_samples: bool = False,
    leave_out_missing: bool = False,
) -> GroupTable:
    """The columns named. rows_are_samples: although other columns look as if they were cycles.

    Raises UsageError for columns that are not there; InputError, with the line, for a cell that is no number or no name, for rows that
    seem to be cycles without `sample`, and for a cycle of a sample that stands twice.
    """
    with open_table(path) as table:
        check_column(table, value, "--value")
        names = NameReader(table, group, "--group")
        samples = None if sample is None else NameReader(table, [sample], "--sample")
        used = (value, *group, *((sample,) if sample else ()))
        if len(set(used)) < len(used):
            raise UsageError("one column is named by two of --value, --group and --sample", file=path)
        repeats = _Repeats(table, sample, used)
        reader = ExactReader(table)
        rows = []
        for line, cells in table.rows:
            text, name = reader.read(cells, line, value), names.read(cells, line)
            of = "" if samples is None else samples.read(cells, line)
            if text is not None:
                repeats.note(name, cells, line)
                rows.append((name, of, text))
        warnings = [*table.warnings, *reader.close(leave_out_missing), *names.warnings]
    if not rows:
        raise InputError("no data rows", file=path, hint="the file holds only a header")
    warnings += [] if samples is None else samples.warnings
    warnings += repeats.judge(rows_are_samples)
    groups, of_samples, values = zip(*rows)
    return GroupTable(groups, None if sample is None else of_samples, values, tuple(warnings))


class _Repeats:
    """Which rows repeat a sample of a group, by --sample or by a column that is called so."""

    def __init__(self, table: Table, sample: str | None, used: Sequence[str]) -> None:
        def called(names: Sequence[str]) -> str | None:
            return next((c for c in table.header if c.casefold() in names and c not in used), None)

        self.table, self.chosen = table, sample
        self.sample, self.cycle = sample or called(SAMPLE_COLUMNS), called(CYCLE_COLUMNS)
        self._lines: dict[tuple[str, str], list[int]] = {}
        self._cycles: dict[tuple[str, str, str], int] = {}

    def note(self, group: str, cells: list[str], line: int) -> None:
        sample = self._cell(cells, self.sample)
        if self.sample is not None:
            self._lines.setdefault((group, sample), []).append(line)
        if self.cycle is None:
            return
        key = (group, sample, self._cell(cells, self.cycle))
        first = self._cycles.setdefault(key, line)
        if self.sample is not None and first != line:
            what = f"{self.cycle} {key[2]} of {self.sample} {sample} of {group[:40]} stands twice, in lines {first} and {line}"
            hint = "keep one of them; of several pressures, keep the rows of one"
            raise InputError(what, file=self.table.path, where=f"line {line}", hint=hint)

    def judge(self, rows_are_samples: bool) -> list[str]:
        """Raises InputError where rows look like cycles and nobody said what tells the samples; warns where few of them do."""
        repeated = {key: lines for key, lines in self._lines.items() if len(lines) > 1}
        what = ""
        if repeated:
            (group, sample), lines = next(iter(repeated.items()))
            what = f"{self.sample} {sample[:40]!r} of {group[:40]!r} stands in lines {_listed(lines)}"
        if self.chosen is not None:
            few = 0 < 2 * len(repeated) <= len(self._lines) and self.cycle is None
            return [f"{what}: taken as cycles of one sample; was a row copied?"] if few else []
        hint = "cycles are not samples: say which column tells samples with --sample, or that each row is one with --rows-are-samples"
        if self.sample is None and len({cycle for _, _, cycle in self._cycles}) > 1:
            what = f"column {self.cycle!r} says that rows are cycles"
            hint = hint.replace("say which column tells", "add a column that tells", 1)
        if not what:
            return []
        if rows_are_samples:
            return [f"{what}; each row is taken as a sample all the same, as was asked for"]
        raise InputError(what, file=self.table.path, hint=hint)

    def _cell(self, cells: list[str], column: str | None) -> str:
        return "" if column is None else cells[self.table.header.index(column)].strip()


def _listed(lines: Sequence[int]) -> str:
    shown = [str(line) for line in lines[:3]]
    return f"{', '.join(shown)}, …" if len(lines) > 3 else " and ".join([", ".join(shown[:-1]), shown[-1]])
