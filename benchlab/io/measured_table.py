"""Measurements in tables: of runs, row by row, or of means.

    design, sample, run, cycle, time_s, pressure_MPa, and any of angle_deg, force_N, volume_mL, flex_V, each in another unit if its name
    says so (pressure_kPa, angle_rad, force_lbf, time_ms); command_MPa, run_index, start_s, orientation_deg, temperature_C, sd
    design, pressure_MPa, mean, sd, n (or angle_mean_deg, angle_sd_deg, force_mean_N ...)

The order of rows and columns says nothing. No unit is guessed; what is missing stays missing, counted and told.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.discrepancy.measured import QUANTITIES, Measured, Summary
from benchlab.errors import InputError, UsageError, printable
from benchlab.io.measured_cells import Cells, is_text, read_cells
from benchlab.io.measured_columns import find_columns
from benchlab.io.measured_frame import Rows, RunName, empty_words, left_words, rows_of, values_in
from benchlab.io.measured_runs import measured_of_runs, runs_of
from benchlab.io.measured_summary import summary_of

if TYPE_CHECKING:
    import pandas


def read_measured(
    paths: Sequence[Path],
    columns: Mapping[str, str] | None = None,
    against: Sequence[str] = (),
    named: Mapping[Path, RunName] | None = None,
) -> Measured | Summary:
    """What was measured, from one table or several of the same kind.

    columns: names of ours with their unit, and what the table calls them (or their places from 1). against: further columns, of numbers
    or words; where there is no pressure, the first one of numbers takes its place. named: of files whose rows do not say what they are
    of; without it, a file without a column `run` is one run of each sample, called after the file.
    Raises UsageError or InputError naming file, line and remedy.
    """
    read = []
    for path in paths:
        name = (named or {}).get(path, RunName())
        cells = read_cells(path, functools.partial(find_columns, source=str(path), columns=columns, against=against))
        read.append((cells, _rows(cells, str(path), "line", against, replace(name, run=name.run or path.stem))))
    return _together(read, ", ".join(map(str, paths)))


def measured_of_frame(
    frame: pandas.DataFrame,
    source: str,
    columns: Mapping[str, str] | None = None,
    against: Sequence[str] = (),
) -> Measured | Summary:
    """The same of a DataFrame with such columns. Rows are counted from 1 in what is told.

    >>> import pandas
    >>> numbers = {"time_s": [1, 0], "pressure_kPa": [350, 0], "angle_deg": [125.7, 0]}
    >>> table = pandas.DataFrame({"design": "tw3_slw10", "sample": "s1", **numbers})
    >>> measured_of_frame(table, "a test").runs[0].pressure_MPa.tolist()
    [0.0, 0.35]
    """
    header = [str(label).strip() for label in frame.columns]
    found = find_columns(header, source, columns, against, may_be_data=False)
    data: dict[str, Any] = {}
    for key, column in found.read.items():
        values = frame.iloc[:, column.index]
        data[key] = _texts(values) if is_text(column) else _numbers(values, source, column.label)
    import pandas

    cells = Cells(pandas.DataFrame(data, index=np.arange(1, len(frame) + 1)), found, ())
    return _together([(cells, _rows(cells, source, "row", against, RunName()))], source)


def _rows(cells: Cells, source: str, word: str, against: Sequence[str], name: RunName) -> Rows:
    if cells.frame.empty:
        raise InputError("no data rows", file=source, hint="the table holds only a header")
    rows = rows_of(cells, source, word, against, name, samples=not cells.columns.of_means)
    rows.warnings.extend([*empty_words(cells.columns, rows), *left_words(cells.columns)])
    return rows


def _texts(values: pandas.Series) -> pandas.Categorical:
    """Names as texts: a whole number is one without a point, what is missing is empty."""
    import pandas

    def text(value: object) -> str:
        if isinstance(value, float | np.floating):
            return "" if np.isnan(value) else f"{value:g}" if float(value).is_integer() else repr(float(value))
        return "" if value is None or value is pandas.NA else str(value).strip()

    codes, unique = pandas.factorize(values, use_na_sentinel=False)
    return pandas.Categorical(np.array([text(value) for value in unique], dtype=object)[codes])


def _numbers(values: pandas.Series, source: str, label: str) -> np.ndarray:
    import pandas

    try:
        numbers = pandas.to_numeric(values).to_numpy(dtype=float, na_value=np.nan)
    except (ValueError, TypeError):
        raise InputError(f"column {printable(label)!r} holds no numbers", file=source, hint="give numbers") from None
    return np.where(np.isfinite(numbers), numbers, np.nan)


def _together(read: Sequence[tuple[Cells, Rows]], source: str) -> Measured | Summary:
    summaries = [rows for cells, rows in read if cells.columns.of_means]
    if not read:
        raise UsageError("no table to read", hint="give the files with what was measured")
    if summaries and len(summaries) < len(read):
        hint = "explain them one after the other"
        raise UsageError("a table of means beside tables of runs", file=summaries[0].source, hint=hint)
    if summaries:
        return _one_summary(summaries)
    runs, warnings, files = [], [], []
    for _, rows in read:
        _settle_sd(rows)
        found, told = runs_of(rows)
        runs += found
        warnings += [f"{Path(rows.source).name}: {each}" if len(read) > 1 else each for each in told]
        files += [rows.source] * len(found)
    return measured_of_runs(runs, source, files, any(rows.simulated for _, rows in read), warnings)


def _one_summary(summaries: Sequence[Rows]) -> Summary:
    if len(summaries) > 1:
        hint = "write them into one table"
        raise UsageError(f"{len(summaries)} tables of means", file=summaries[1].source, hint=hint)
    return summary_of(summaries[0])


def _settle_sd(rows: Rows) -> None:
    """A plain column `sd` is of the only quantity. Raises InputError where there are several."""
    if "sd" not in rows.frame:
        return
    quantities = values_in(rows.frame)
    if len(quantities) > 1:
        listed = ", ".join(
            f"{name.partition('_')[0]}_sd_{name.partition('_')[2]}" for name in QUANTITIES if name in quantities
        )
        raise InputError("column sd, of which quantity?", file=rows.source, hint=f"name it {listed}")
    for name in itertools.islice(quantities, 1):
        rows.frame[f"{name} sd"] = rows.frame["sd"]
