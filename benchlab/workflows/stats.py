"""`benchlab stats`: a table of values or of summaries in; what differs, by how much, and how well it repeats out."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.errors import InputError, UsageError
from benchlab.io.files import cannot_write, check_new_file, check_new_folder, reason_of, sha256
from benchlab.io.group_table import read_group_table
from benchlab.io.summary_table import read_summary_table
from benchlab.report.comparison_tables import comparison_tables
from benchlab.report.document import Table, cut, write_table
from benchlab.report.figures import save_png
from benchlab.report.study.bars_figure import Bar, draw_bars
from benchlab.report.study.figures import Interval, draw_intervals
from benchlab.report.svg import svg_of
from benchlab.stats.comparison import Comparison, compare, compare_summaries
from benchlab.stats.measurements import measurements_of
from benchlab.stats.wording import p_equals, stars
from benchlab.workflows.provenance import made_by


@dataclass(frozen=True)
class StatsColumns:
    """Which columns are what: value and, if rows can be cycles, sample; or mean, sd and n of summaries, a row a group."""

    group: tuple[str, ...]
    value: str | None = None
    sample: str | None = None
    mean: str | None = None
    sd: str | None = None
    n: str | None = None
    rows_are_samples: bool = False

    def __post_init__(self) -> None:
        summary = {"--mean": self.mean, "--sd": self.sd, "--n": self.n}
        absent = [option for option, column in summary.items() if column is None]
        if self.value is not None and len(absent) < 3:
            raise UsageError("--value and --mean, --sd, --n are two kinds of table", hint="give one or the other")
        if self.value is None and absent:
            what = "no --value" if len(absent) == 3 else f"no {' and '.join(absent)}"
            raise UsageError(what, hint="give --value COLUMN, or --mean, --sd and --n of a table of summaries")
        if self.sample is not None and (self.rows_are_samples or self.value is None):
            raise UsageError("--sample does not go with --rows-are-samples or with summaries", hint="leave one out")

    @property
    def compared(self) -> str:
        return self.value or self.mean or ""


@dataclass(frozen=True)
class StatsFound:
    """A comparison with what it was made of. tables: for a terminal and as CSV. document: what `--json` shows."""

    comparison: Comparison
    tables: tuple[Table, ...]
    document: dict[str, Any] = field(repr=False)


def stats(
    source: Path,
    columns: StatsColumns,
    confidence: float = 0.95,
    difference: float | None = None,
    leave_out_missing: bool = False,
    out: Path | None = None,
    overwrite: bool = False,
) -> StatsFound:
    """Read, compare, and, with `out`, write all into this folder. Raises UsageError and InputError; then nothing was written."""
    if out is not None:
        _check_outputs(out, source, overwrite)
    found = _compared(source, columns, confidence, difference, leave_out_missing)
    tables = tuple(comparison_tables(found, columns.compared))
    document = {
        "file": str(source),
        "columns": {name: value for name, value in vars(columns).items() if value},
        **found.as_json(),
        "outputs": [] if out is None else [str(out / name) for name in _names(tables, found)],
        "provenance": {**made_by("numpy", "scipy"), "sha256": sha256(source)},
    }
    if out is not None:
        _write(out, found, columns.compared, tables, document)
    return StatsFound(found, tables, document)


def _compared(
    source: Path, columns: StatsColumns, confidence: float, difference: float | None, leave_out_missing: bool
) -> Comparison:
    try:
        if columns.value is None:
            summary = read_summary_table(
                source, columns.group, columns.mean or "", columns.sd or "", columns.n or "", leave_out_missing
            )
            found = compare_summaries(summary.names, summary.n, summary.mean, summary.sd, confidence, difference)
            return replace(found, warnings=(*summary.warnings, *found.warnings))
        table = read_group_table(
            source, columns.value, columns.group, columns.sample, columns.rows_are_samples, leave_out_missing
        )
        found = compare(measurements_of(table.groups, table.values, table.samples), confidence, difference)
        return replace(found, warnings=(*table.warnings, *found.warnings))
    except InputError as error:
        raise InputError(error.what, file=error.file or source, where=error.where, hint=error.hint) from error


def _names(tables: Sequence[Table], found: Comparison) -> list[str]:
    figures = ["bars"] + ["intervals"] * bool(found.tukey)
    return [
        "comparison.json",
        *(f"{table.name}.csv" for table in tables),
        *(f"{name}.{kind}" for name in figures for kind in ("svg", "png")),
    ]


_ALL = frozenset(
    ("comparison.json", "groups.csv", "tests.csv", "pairs.csv", "components.csv", "consistency.csv", "power.csv",
     "bars.svg", "bars.png", "intervals.svg", "intervals.png")
)  # fmt: skip


def _check_outputs(out: Path, source: Path, overwrite: bool) -> None:
    check_new_folder(out)
    for path in (out / name for name in sorted(_ALL) if (out / name).exists()):
        if path.resolve() == source.resolve():
            raise UsageError("is read here and would be replaced", file=path, hint="choose another --out")
        check_new_file(path, overwrite)


def _write(out: Path, found: Comparison, value: str, tables: Sequence[Table], document: dict[str, Any]) -> None:
    """All files into a hidden folder first; they are moved to their places together."""
    try:
        out.mkdir(exist_ok=True)
        with tempfile.TemporaryDirectory(dir=out, prefix=".stats-") as hidden:
            stage = Path(hidden)
            text = json.dumps(document, indent=2, allow_nan=False, ensure_ascii=False)
            (stage / "comparison.json").write_text(text + "\n", encoding="utf-8", errors="backslashreplace")
            for table in tables:
                write_table(stage / f"{table.name}.csv", table)
            for name, figure in _figures(found, value, document["file"]).items():
                (stage / f"{name}.svg").write_text(svg_of(figure), encoding="utf-8")
                save_png(figure, stage / f"{name}.png")
            made = {path.name for path in stage.iterdir()}
            for name in sorted(made):
                (stage / name).replace(out / name)
        for name in _ALL.difference(made):  # of a comparison before this one, which would tell another story
            (out / name).unlink(missing_ok=True)
    except OSError as error:
        if error.filename is None:
            raise cannot_write(error, out) from error
        raise InputError(f"cannot write here: {reason_of(error)}", file=out, hint="choose another --out") from error


def _figures(found: Comparison, value: str, title: str) -> dict[str, Any]:
    """Bars of the groups with brackets of Tukey's test, and the intervals of the differences."""
    bars = [
        Bar(group.name, np.array([float(group.origin) + x for x in group.deviations.tolist()]), group.mean, group.sd)
        for group in found.groups
    ]
    at = {group.name: index for index, group in enumerate(found.groups)}
    brackets = [(at[p.a], at[p.b], stars(p.p) or p_equals(p.p)) for p in found.tukey if p.p is not None]
    figures = {"bars": draw_bars(bars, brackets, cut(value, 60), title)}
    if found.tukey:
        rows = [_interval(*pair) for pair in zip(found.tukey, found.games_howell)]
        figures["intervals"] = draw_intervals(rows, f"difference of mean {cut(value, 50)}", found.confidence, title)
    return figures


def _interval(tukey: Any, games_howell: Any) -> Interval:
    ends = [None if one.low is None else (one.difference, one.low, one.high) for one in (tukey, games_howell)]
    return Interval(f"{cut(tukey.b, 20)} − {cut(tukey.a, 20)}", *ends)
