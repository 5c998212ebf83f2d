"""Rows of a table of measurements in the names and units of benchlab, each checked for what it says alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.measured import QUANTITIES
from benchlab.errors import InputError, UsageError, counted, printable
from benchlab.io.measured_cells import Cells
from benchlab.io.measured_columns import Columns, vague_column
from benchlab.io.measured_units import converted
from benchlab.io.pressure import MIN_PRESSURE_MPA
from benchlab.units import FloatArray
from benchlab.vision.series import SURE_FLAGS

if TYPE_CHECKING:
    import pandas

MAX_PRESSURE_MPA = 2.0
"""A soft actuator is not driven beyond: a larger number is in another unit."""

NAMES = ("design", "sample", "run")
UNNAMED = {"design": "unnamed", "sample": "s1"}
"""What rows without a column of these are called."""


@dataclass(frozen=True)
class RunName:
    """What a file is of, where its rows do not say: as a pattern reads it from the file's name. "" is not known."""

    design: str = ""
    sample: str = ""
    run: str = ""


@dataclass(frozen=True)
class Rows:
    """Rows of one source. frame: design, sample, run (categories), numbers by the names of benchlab (`angle_deg`, `angle_deg sd`), columns
    of `against`; its index is the line. word: what a line is called. x: the column of the pressure, or of what takes its place. unsaid: of
    design, sample and run those that neither a column nor the file's name says."""

    frame: pandas.DataFrame
    source: str
    word: str = "line"
    x: str = "pressure_MPa"
    against: tuple[str, ...] = ()
    simulated: bool = False
    warnings: list[str] = field(default_factory=list)
    unsaid: tuple[str, ...] = ()

    def refused(self, what: str, at: int, hint: str) -> InputError:
        return InputError(what, file=self.source, where=f"{self.word} {self.frame.index[at]}", hint=hint)


def rows_of(cells: Cells, source: str, word: str, against: Sequence[str], name: RunName, samples: bool) -> Rows:
    """The rows of a table. samples: whether it matters of which one a row is. Raises InputError, with the line, for what no row may say."""
    warnings = list(cells.warnings)
    frame = _converted(cells)
    _settle_against(frame, against)
    x = _x_of(cells.columns, frame, source, against, warnings)
    unsaid = _unsaid(frame, name)
    warnings += _settle_names(frame, source, word, name, samples)
    simulated = "origin" in frame and any("simulated" in str(text) for text in frame["origin"].unique())
    rows = Rows(frame, source, word, x, tuple(against), simulated, warnings, unsaid)
    _check_names(rows)
    _check_numbers(rows)
    if x == "pressure_MPa":
        _check_pressures(rows)
    return rows


def _converted(cells: Cells) -> pandas.DataFrame:
    frame = cells.frame.copy(deep=False)
    for key, column in cells.columns.read.items():
        if column.meaning is not None and column.meaning.kind:
            frame[key] = converted(frame[key].to_numpy(dtype=float), column.meaning)
    return frame


def empty_words(columns: Columns, rows: Rows) -> list[str]:
    """Columns without a number, told; refused where the pressure, the time or all that was measured is among them."""
    frame = rows.frame
    numbers = [key for key in columns.read if key in frame and frame[key].dtype == float]
    labels = {
        key: printable(columns.read[key].label) for key in numbers if not np.isfinite(frame[key].to_numpy()).any()
    }
    values = values_in(frame)
    lacking = [key for key in (rows.x, "time_s") if key in labels] or (values if labels.keys() >= set(values) else [])
    if lacking:
        what = f"no number in column {', '.join(labels[key] for key in lacking)}"
        hint = (
            "fill it; a column of time may be left out"
            if lacking == ["time_s"]
            else "is it the right one? --columns names another"
        )
        raise InputError(what, file=rows.source, hint=hint)
    return [f"no number in column {label}: not used" for label in labels.values()]


def _settle_against(frame: pandas.DataFrame, against: Sequence[str]) -> None:
    """Make numbers of the user's columns that hold nothing else."""
    import pandas

    for name in against:
        texts = frame[name]
        if not isinstance(texts.dtype, pandas.CategoricalDtype):
            continue
        categories = pandas.Series(texts.cat.categories.astype(str))
        values = pandas.to_numeric(categories.str.replace(",", "."), errors="coerce").to_numpy(dtype=float)
        values = np.where(np.isfinite(values), values, np.nan)
        if not np.isnan(values[(categories != "").to_numpy()]).any():
            frame[name] = np.append(values, np.nan)[texts.cat.codes]


def left_words(columns: Columns) -> list[str]:
    """What is to be told of columns that were not read."""
    from benchlab.discrepancy.effects.catalogue import built_in

    left = [printable(label) for label in columns.left]
    if not left:
        return []
    told = [f"column {label} is called like an effect, and says nothing of it" for label in left if label in built_in()]
    listed = ", ".join(left[:8]) + (f" and {len(left) - 8} more" if len(left) > 8 else "")
    hint = "--columns says what is called otherwise, --against what may matter"
    return [*told, f"columns not read: {listed}; {hint}"]


def _x_of(columns: Columns, frame: pandas.DataFrame, source: str, against: Sequence[str], warnings: list[str]) -> str:
    """The column of the pressure, or the first numeric one of the user's, which is told."""
    if "pressure_MPa" in frame:
        return "pressure_MPa"
    numeric = [name for name in against if frame[name].dtype == float]
    if numeric:
        warnings.append(f"no column of pressure: {printable(numeric[0])!r} takes its place, in its own unit")
        return numeric[0]
    vague = vague_column(columns.left, "pressure")
    what = f"no unit that is known in {printable(vague)!r}" if vague else "no column of pressure"
    hint = (
        "call it pressure_MPa (or kPa, bar, psi ...), or say --columns pressure_kPa=NAME; another variable: --against"
    )
    raise InputError(what, file=source, hint=hint)


def _unsaid(frame: pandas.DataFrame, name: RunName) -> tuple[str, ...]:
    """A file whose name says the sample is one run of it, unless its rows say samples themselves."""
    said = {
        "design": name.design or {"tw_mm", "slw_mm"} <= set(frame),
        "sample": name.sample,
        "run": name.sample and "sample" not in frame,
    }
    return tuple(each for each in NAMES if each not in frame and not said[each])


def _settle_names(frame: pandas.DataFrame, source: str, word: str, name: RunName, samples: bool) -> list[str]:
    """Design, sample and run of every row, of columns, of the file's name, or else one for all; the last is told, unless samples have no
    part in it."""
    import pandas

    told = []
    if "design" not in frame and {"tw_mm", "slw_mm"} <= set(frame):
        frame["design"] = pandas.Categorical(_design_names(frame, source, word))
    for each in ("design", "sample"):
        if each not in frame:
            given = getattr(name, each)
            frame[each] = pandas.Categorical([given or UNNAMED[each]]).repeat(len(frame))
            if not given and (samples or each != "sample"):
                told.append(each)
    if "run" not in frame:
        frame["run"] = pandas.Categorical([name.run or "r1"]).repeat(len(frame))
    words = {"design": "all rows are of one design", "sample": "the rows of a design are of one sample"}
    return [f"no column {each}: {words[each]}, called {UNNAMED[each]!r}" for each in told]


def _design_names(frame: pandas.DataFrame, source: str, word: str) -> list[str]:
    """`tw3_slw10` of each row's dimensions."""
    named: dict[tuple[float, float], str] = {}
    for at, pair in enumerate(zip(frame["tw_mm"], frame["slw_mm"])):
        if pair not in named:
            try:
                named[pair] = ShellDesign(strip_width_mm=pair[1], window_width_mm=pair[0]).name
            except UsageError as error:
                where = f"{word} {frame.index[at]}"
                raise InputError(error.what, file=source, where=where, hint=error.hint) from None
    return [named[pair] for pair in zip(frame["tw_mm"], frame["slw_mm"])]


def _check_names(rows: Rows) -> None:
    """No empty name; names that differ only in case, or in how a number is written, are told, not taken as one."""
    for each in NAMES:
        texts = rows.frame[each]
        empty = (texts == "").to_numpy()
        if empty.any():
            hint = f"write the {each} into every row, or leave the whole column out"
            raise rows.refused(f"no {each}", int(np.argmax(empty)), hint)
        seen: dict[str, str] = {}
        for text in map(str, texts.cat.categories):
            other = seen.setdefault(_alike(text), text)
            if other != text:
                rows.warnings.append(f"{each}s {printable(other)!r} and {printable(text)!r} are taken as two")


def _alike(text: str) -> str:
    try:
        return f"{float(text):g}"
    except ValueError:
        return text.casefold()


def _check_numbers(rows: Rows) -> None:
    frame = rows.frame
    for key in frame:
        if str(key).split()[-1] == "sd" and (frame[key] < 0).any():
            at = int(np.argmax((frame[key] < 0).to_numpy()))
            what = f"standard deviation of {frame[key].iloc[at]:g}, below 0"
            raise rows.refused(what, at, "leave the cell empty where it is not known")
    if "cycle" in frame:
        cycle = frame["cycle"].to_numpy()
        wrong = np.isfinite(cycle) & ((cycle < 0) | (cycle != np.round(cycle)))
        if wrong.any():
            at = int(np.argmax(wrong))
            raise rows.refused(f"cycle {cycle[at]:g} is not a whole number", at, "count cycles as 1, 2, 3")
        frame["cycle"] = np.where(cycle == 0, np.nan, cycle)  # 0 is how drive files write "in no cycle"


def _check_pressures(rows: Rows) -> None:
    for key in ("pressure_MPa", "command_MPa"):
        values = rows.frame[key].to_numpy() if key in rows.frame else np.empty(0)
        outside = (values > MAX_PRESSURE_MPA) | (values < MIN_PRESSURE_MPA)
        if outside.any():
            at = int(np.argmax(outside))
            what = f"{key.partition('_')[0]} of {values[at]:g} MPa, outside {MIN_PRESSURE_MPA:g} to {MAX_PRESSURE_MPA:g} MPa"
            near = f"{values[at]:g} kPa would be {values[at] / 1000:g} MPa: " if values[at] > 0 else ""
            raise rows.refused(what, at, f"{near}is the unit in the name of the column right?")


def without_gaps(rows: Rows) -> Rows:
    """The rows that have a pressure and, where there is one, a time; what is left out and what is missing is told."""
    frame, warnings = rows.frame, rows.warnings
    for key in (rows.x, "time_s"):
        if key in frame:
            missing = ~np.isfinite(frame[key].to_numpy(dtype=float))
            if missing.any():
                first = frame.index[missing].min()
                warnings.append(
                    f"{counted(int(missing.sum()), 'row')} without {key} left out, the first in {rows.word} {first}"
                )
                frame = frame[~missing]
    if frame.empty:
        raise InputError("no data rows", file=rows.source, hint=f"no row has a number for {rows.x}")
    frame = _without_doubtful(frame, warnings)
    for key in values_in(frame):
        missing = ~np.isfinite(frame[key].to_numpy())
        if missing.any():
            first = frame.index[missing].min()
            warnings.append(f"{key} is missing in {missing.sum()} of {len(frame)} rows, the first {rows.word} {first}")
    return replace(rows, frame=frame)


def _without_doubtful(frame: pandas.DataFrame, warnings: list[str]) -> pandas.DataFrame:
    """Frames that `benchlab analyze` doubts have no value."""
    if "flag" not in frame:
        return frame
    doubtful = ~frame["flag"].isin(SURE_FLAGS).to_numpy()
    if doubtful.any():
        warnings.append(f"{counted(int(doubtful.sum()), 'row')} with a flag of doubt: no value there")
        frame = frame.assign(**{key: frame[key].where(~doubtful) for key in values_in(frame)})
    return frame


def values_in(frame: pandas.DataFrame | Mapping[str, FloatArray]) -> list[str]:
    """Which quantities are in a table."""
    return [name for name in QUANTITIES if name in frame]
