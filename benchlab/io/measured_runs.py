"""Runs out of the rows of tables: each in the order of its time, each once, and what belongs to a whole run said once.

Nothing here depends on the order of rows; where a time went back in a file that is otherwise in order, that is told.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.measured import Measured, Run
from benchlab.errors import InputError, counted, printable
from benchlab.io.measured_doubts import copies, unit_jumps
from benchlab.io.measured_frame import NAMES, Rows, values_in, without_gaps
from benchlab.io.measured_order import check_one_run, remedy, run_words
from benchlab.units import FloatArray

if TYPE_CHECKING:
    import pandas

OF_A_RUN = ("run_index", "start_s", "orientation_deg")
"""What has one value a run."""

REPEATED_SHARE, REPEATED_RANGE = 0.1, 0.05
"""A clock may repeat a time: at most so many rows of a run, with values that differ by at most this share of their range. They are
averaged. More is no clock, but rows of two runs under one name. Both chosen."""

MOST_BACK = 0.1
"""A file whose time goes back at more of its rows is in no order of time, and none is expected of it."""

MOST_TOLD = 5
"""Warnings of one kind that are told one by one."""

NO_TIME = "no column of time: rows are in the order of their pressure, and nothing can be said of direction, rate, order or creep"


def runs_of(rows: Rows) -> tuple[list[Run], list[str]]:
    """The runs in the rows of one source, and what is to be told. Raises InputError, with the line, for a run that says two things."""
    rows = without_gaps(rows)
    frame, told = rows.frame, rows.warnings
    if not values_in(frame):
        hint = "name one angle_deg, force_N, volume_mL or flex_V (or another unit), or say --columns angle_deg=NAME"
        raise InputError("no column of a measured quantity", file=rows.source, hint=hint)
    if "time_s" not in frame:
        told.append(NO_TIME)
    told += _back_in_time(rows) if "time_s" in frame else []
    found: list[Run] = []
    empty: list[Run] = []
    repeats = _Repeats()
    for name, part in _groups(frame):
        run = _run(replace(rows, frame=part), name, repeats)
        (found if run.values else empty).append(run)
    told += repeats.words()
    if empty:
        told.append(f"{counted(len(empty), 'run')} without a value left out, the first {_words(empty[0])}")
    if not found:
        raise InputError("no value in any run", file=rows.source, hint="are the columns of values empty?")
    return found, told


def measured_of_runs(
    runs: Iterable[Run], source: str, files: Sequence[str], simulated: bool, warnings: Sequence[str]
) -> Measured:
    """Runs of one or several sources together; files: the source of each run. Raises InputError for a run that stands in two sources."""
    runs = list(runs)
    seen: dict[tuple[str, str, str], str] = {}
    for run, file in zip(runs, files):
        other = seen.setdefault((run.design, run.sample, run.run), file)
        if other != file:
            hint = f"it is in {printable(other)} too: give one of them another name, or leave it out"
            raise InputError(f"{_words(run)} stands in two files", file=file, hint=hint)
    told = [*dict.fromkeys(warnings), *_first(unit_jumps(runs)), *_first(copies(runs)), *_few(runs)]
    order = sorted(runs, key=lambda run: (run.design, run.sample, _number(run.run_index), run.run))
    return Measured(tuple(order), source, simulated, tuple(told))


def _first(words: Iterable[str]) -> list[str]:
    """The first few of what could be said of each run, and how many more there are."""
    found = list(words)
    return [*found[:MOST_TOLD], *([f"and of {len(found) - MOST_TOLD} runs more"] if len(found) > MOST_TOLD else [])]


def _words(run: Run) -> str:
    return printable(f"run {run.run} of {run.design} {run.sample}")


def _number(value: float | None) -> float:
    return np.inf if value is None else value


def _few(runs: Sequence[Run]) -> Iterator[str]:
    """Designs with one sample, which say nothing of how samples scatter."""
    samples: dict[str, set[str]] = {}
    for run in runs:
        samples.setdefault(run.design, set()).add(run.sample)
    single = sorted(design for design, found in samples.items() if len(found) == 1)
    if single:
        listed = ", ".join(map(printable, single[:5])) + (" …" if len(single) > 5 else "")
        yield f"one sample only of {counted(len(single), 'design')} ({listed}): how samples scatter is not known there"


def _groups(frame: pandas.DataFrame) -> Iterator[tuple[tuple[str, str, str], pandas.DataFrame]]:
    """Design, sample and run, and its rows in the order of time (or of cycle and pressure), whatever order they came in."""
    key = _key(frame)
    order = _order(frame, key, ["time_s"] if "time_s" in frame else [])
    if "time_s" not in frame or (np.diff(frame["time_s"].to_numpy()[order]) == 0).any():
        order = _order(frame, key, ["time_s", "cycle", "pressure_MPa", *values_in(frame)])
    ordered, key = frame.take(order), key[order]
    starts = np.flatnonzero(np.diff(key, prepend=-1))
    for start, stop in zip(starts, [*starts[1:], len(key)]):
        part = ordered.iloc[start:stop]
        design, sample, run = (str(part[name].iloc[0]) for name in NAMES)
        yield (design, sample, run), part


def _order(frame: pandas.DataFrame, key: NDArray[np.int64], by: Sequence[str]) -> NDArray[np.int64]:
    """By key, and in a key by columns, the first one first; those that are not there are passed over."""
    return np.lexsort([*(frame[name].to_numpy() for name in reversed(by) if name in frame), key])


def _key(frame: pandas.DataFrame) -> NDArray[np.int64]:
    """A number for each row that is the same for the rows of a run."""
    key = np.zeros(len(frame), dtype=np.int64)
    for name in NAMES:
        key = key * len(frame[name].cat.categories) + frame[name].cat.codes.to_numpy()
    return np.unique(key, return_inverse=True)[1]


def _run(rows: Rows, name: tuple[str, str, str], repeats: _Repeats) -> Run:
    rows = _each_time_once(rows, name, repeats)
    check_one_run(rows, name)
    frame = rows.frame
    told = {key: frame[key].to_numpy(dtype=float) for key in frame if frame[key].dtype == float}
    values = {key: told[key] for key in values_in(told) if np.isfinite(told[key]).any()}
    whole = {key: _one(rows, key, name) for key in OF_A_RUN}
    return Run(
        *name,
        time_s=told["time_s"] if "time_s" in told else np.full(len(frame), np.nan),
        pressure_MPa=told[rows.x],
        values=values,
        command_MPa=_known(told, "command_MPa"),
        cycle=_known(told, "cycle"),
        sd={key: told[f"{key} sd"] for key in values if _known(told, f"{key} sd") is not None},
        temperature_C=_known(told, "temperature_C"),
        against={key: told[key] if key in told else _word(rows, key, name) for key in rows.against},
        run_index=whole["run_index"],
        start_s=whole["start_s"],
        orientation_deg=whole["orientation_deg"],
    )


def _known(told: dict[str, FloatArray], key: str) -> FloatArray | None:
    values = told.get(key)
    return values if values is not None and np.isfinite(values).any() else None


def _one(rows: Rows, key: str, name: tuple[str, str, str]) -> float | None:
    """The one value that a run has of something, None where it has none."""
    if key not in rows.frame:
        return None
    values = rows.frame[key].to_numpy()
    known = np.flatnonzero(np.isfinite(values))
    if not len(known):
        return None
    other = known[values[known] != values[known[0]]]
    if len(other):
        first = f"{values[known[0]]:g} in {rows.word} {rows.frame.index[known[0]]}"
        what = f"{key} of run {printable(name[2])} is {values[other[0]]:g} here and {first}"
        raise rows.refused(
            what, int(other[0]), "it has one value a run: is a column `run` missing, or a run named twice?"
        )
    return float(values[known[0]])


def _word(rows: Rows, key: str, name: tuple[str, str, str]) -> str:
    texts = rows.frame[key].astype(str).to_numpy()
    other = np.flatnonzero(texts != texts[0])
    if len(other):
        what = f"{printable(key)} of run {printable(name[2])} is {printable(texts[other[0]])!r} here and {printable(texts[0])!r} elsewhere"
        raise rows.refused(what, int(other[0]), "words have one value a run: name the parts as runs of their own")
    return str(texts[0])


@dataclass
class _Repeats:
    """How many rows of which run repeat another one, or its time."""

    equal: dict[str, int] = field(default_factory=dict)
    averaged: dict[str, int] = field(default_factory=dict)

    def words(self) -> Iterator[str]:
        for counts, what in ((self.equal, "equal rows counted once"), (self.averaged, "rows of one time averaged")):
            if counts:
                more = f" and {counted(len(counts) - 1, 'other run')}" if len(counts) > 1 else ""
                yield f"{what}: {sum(counts.values())}, in {next(iter(counts))}{more}"


def _each_time_once(rows: Rows, name: tuple[str, str, str], repeats: _Repeats) -> Rows:
    """The rows with each time once: equal rows are one, and the few times that a clock repeats are averaged; both are noted.

    Raises InputError, with both lines, where rows of one time differ by more.
    """
    frame = rows.frame
    if "time_s" not in frame or not (np.diff(frame["time_s"].to_numpy()) == 0).any():
        return rows
    measured = [key for key in frame if key not in NAMES]
    single = frame.drop_duplicates(subset=measured)
    of = run_words(name)
    if len(single) < len(frame):
        repeats.equal[of] = len(frame) - len(single)
    time = single["time_s"].to_numpy()
    again = np.flatnonzero(np.diff(time) == 0)
    if len(again):
        _check_clock(rows, single, again, of)
        repeats.averaged[of] = len(again)
        single = _averaged(single)
    return replace(rows, frame=single)


def _check_clock(rows: Rows, frame: pandas.DataFrame, again: np.ndarray, of: str) -> None:
    """Raises InputError where rows that repeat a time are too many, or too different, to be of one clock."""
    at = len(again) > REPEATED_SHARE * len(frame)
    place = int(again[0])
    for key, most in {**dict.fromkeys([rows.x, *values_in(frame)], REPEATED_RANGE), "cycle": 0.0}.items():
        values = frame[key].to_numpy() if key in frame else np.zeros(len(frame))
        steps = np.abs(np.diff(values)[again])
        wide = np.nan_to_num(steps) > most * (np.nanmax(values) - np.nanmin(values))
        if wide.any() and not at:
            at, place = True, int(again[int(np.argmax(wide))])
    if at:
        lines = sorted(frame.index[[place, place + 1]].tolist())
        what = f"{of} has two rows with other values at {frame['time_s'].iloc[place]:g} s, {rows.word}s {lines[0]} and {lines[1]}"
        hint = "are two runs called alike, or does time begin again in each cycle? name each run, and let time go on"
        raise InputError(what, file=rows.source, where=f"{rows.word} {lines[1]}", hint=remedy(rows, hint))


def _averaged(frame: pandas.DataFrame) -> pandas.DataFrame:
    """One row a time, at the first line of it: the mean of numbers, the first of words."""
    numeric = {key: "mean" if frame[key].dtype == float else "first" for key in frame if key != "time_s"}
    first = frame.index[~frame["time_s"].duplicated().to_numpy()]
    return frame.groupby("time_s", sort=True, as_index=False).agg(numeric).set_index(first)


def _back_in_time(rows: Rows) -> list[str]:
    """Where, within a run, time goes back from a row of the file to the next, if that is rare."""
    key, line = _key(rows.frame), rows.frame.index.to_numpy()
    order = np.lexsort([line, key])
    time = rows.frame["time_s"].to_numpy()[order]
    back = np.flatnonzero((np.diff(key[order]) == 0) & (np.diff(time) < 0))
    if not len(back) or len(back) > MOST_BACK * len(time):
        return []
    words = f"from {time[back[0]]:g} s to {time[back[0] + 1]:g} s in {rows.word} {line[order][back[0] + 1]}"
    more = f" and {len(back) - 1} times more" if len(back) > 1 else ""
    return [f"time goes back within a run, {words}{more}: rows are taken in the order of their time"]
