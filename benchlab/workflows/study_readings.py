"""One recording of a study as values: its angle at the study's pressure in each cycle, and its curve against pressure."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchlab.io.angle_table import AngleTable, is_series, read_angle_table
from benchlab.io.drive_file import SCHEMA as DRIVE
from benchlab.io.drive_file import is_replay, made_on, origin, read_drive_file, sensor_sd, unfit_words
from benchlab.io.drive_gaps import gaps_of
from benchlab.io.journal import Journal
from benchlab.io.nexus import schema_of
from benchlab.io.run_file import read_run_file
from benchlab.io.study_values import CycleValue, nan_mean
from benchlab.io.table import read_series_csv
from benchlab.units import FloatArray
from benchlab.vision.loading import Cycle, Trace, angle_at, find_cycles, rising_curve
from benchlab.vision.series import SURE_FLAGS
from benchlab.workflows.drawn_film import TWIN_CAMERA

CURVE_POINTS = 36
"""Pressures of a curve, from 0 to the study's."""

STATED = "table"
"""Method of an angle of a table without pressure: its maker says that it is at the study's."""

NOT_MEASURED = ("twin", "emulated")
"""Benches on which nothing is measured."""

NO_PRESSURE = "its pressure is not known"


@dataclass(frozen=True)
class Target:
    """The pressure at which designs are compared, how near counts as held, and (P,) the pressures of curves."""

    pressure_MPa: float
    tolerance_MPa: float
    curve_MPa: FloatArray

    @classmethod
    def of(cls, pressure_MPa: float, tolerance_MPa: float) -> Target:
        return cls(pressure_MPa, tolerance_MPa, np.linspace(0, pressure_MPa, CURVE_POINTS).round(9))


@dataclass(frozen=True)
class Readings:
    """cycles: never empty; one that has no value says why. curve_deg: (P,). warnings: of the source. origin: as of RecordingValues.

    unfit: why it does not count unless the study says that it does; never: why it does not whatever the study says. content: of what was
    measured, alike in copies, "" where only the file can tell.
    """

    cycles: tuple[CycleValue, ...]
    curve_deg: FloatArray
    warnings: tuple[str, ...] = ()
    origin: str = ""
    unfit: str = ""
    never: str = ""
    content: str = ""


def read_run(path: Path, target: Target) -> Readings:
    """The readings of a run file, or of a drive file. Raises UsageError or InputError."""
    if schema_of(path) == DRIVE.name:
        return _of_drive(path, target)
    run = read_run_file(path)
    series = run.series
    warnings = [*run.warnings, *(["interrupted: not all of the recording was analysed"] if run.partial else [])]
    if series.pressure_MPa is None:
        return _without(NO_PRESSURE, target, warnings)
    trace = Trace(series.pressure_MPa, np.degrees(series.angle_rad), np.degrees(series.angle_sd_rad), series.sure)
    readings = _of_trace(trace, series.flag, target, warnings)
    return replace(readings, origin="twin" if TWIN_CAMERA in str(run.recording.get("title", "")) else "")


def _of_drive(path: Path, target: Target) -> Readings:
    """What a drive file gives, where it is from, and whether it counts."""
    run = read_drive_file(path)
    kind, fields = made_on(run.header), ("monitor_V", "flex_V", "pressure_MPa", "angle_deg")
    known = any(np.isfinite(run.samples[name]).any() for name in fields)
    content = hashlib.sha256(b"".join(run.samples[name].tobytes() for name in fields)).hexdigest() if known else ""
    return replace(
        _by_flex(run, target),
        origin=kind if kind in NOT_MEASURED else "",
        unfit=unfit_words(run),
        never="a replay of a run is not another measurement" if is_replay(run.header) else "",
        content=content,
    )


def _by_flex(run: Journal, target: Target) -> Readings:
    """The angle by the flex sensor over the pressure that was measured or, where none was, asked for."""
    samples = run.samples
    origin_told = origin(run.header)
    warnings = [f"no run on a bench of metal: {origin_told}"] if origin_told else []
    warnings += ["its angle is by the flex sensor, not from a film"]
    if unfit := unfit_words(run):
        warnings.append(unfit)
    warnings += [f"lost {words}" for words in run.losses_told]
    warnings += [gap.words for gap in gaps_of(run)]
    angle, pressure = (np.asarray(samples[name], dtype=float) for name in ("angle_deg", "pressure_MPa"))
    if not np.isfinite(angle).any():
        return _without("no angle was measured: the flex sensor is not there, or not calibrated", target, warnings)
    if not np.isfinite(pressure).any():
        warnings.append("no pressure was measured: the pressure is what was asked for")
        pressure = np.asarray(samples["command_MPa"], dtype=float)
    known = np.isfinite(angle)
    trace = Trace(pressure, angle, np.where(known, sensor_sd(run.header, "flex"), np.nan), known)
    return _of_trace(trace, tuple("" if each else "no angle" for each in known), target, warnings)


def read_table(path: Path, design: str, sample: str, target: Target) -> Readings:
    """The readings of a table of `benchlab analyze`, or of the sample's rows in a plain one. Raises UsageError or InputError."""
    if not is_series(path):
        return _of_table(read_angle_table(path, design, sample), target)
    frame = read_series_csv(path)
    flags = tuple(frame["flag"])
    if "pressure_MPa" not in frame:
        return _without(NO_PRESSURE, target, [])
    angle = frame["angle_deg"].to_numpy()
    sure = np.isfinite(angle) & np.array([flag in SURE_FLAGS for flag in flags], dtype=bool)
    trace = Trace(frame["pressure_MPa"].to_numpy(), angle, frame["angle_sd_deg"].to_numpy(), sure)
    return _of_trace(trace, flags, target, [])


def _of_trace(trace: Trace, flags: tuple[str, ...], target: Target, warnings: Sequence[str]) -> Readings:
    known = trace.pressure_MPa[np.isfinite(trace.pressure_MPa)]
    if not len(known):
        return _without(NO_PRESSURE, target, warnings)
    cycles = find_cycles(trace.pressure_MPa, target.pressure_MPa)
    if not cycles:
        most = f"its pressure reaches {known.max():.4g} MPa at most, {target.pressure_MPa:g} MPa are wanted"
        return _without(most, target, warnings)
    values = tuple(_value(number, cycle, trace, flags, target) for number, cycle in enumerate(cycles, start=1))
    curve = rising_curve(target.curve_MPa, target.tolerance_MPa, trace, cycles)
    return Readings(values, curve, tuple(warnings))


def _value(number: int, cycle: Cycle, trace: Trace, flags: tuple[str, ...], target: Target) -> CycleValue:
    reading = angle_at(target.pressure_MPa, target.tolerance_MPa, trace, cycle)
    doubts = dict.fromkeys(flags[frame] for frame in reading.frames if not trace.sure[frame])
    return CycleValue(
        cycle=number,
        angle_deg=round(reading.angle, 6),
        angle_sd_deg=round(reading.sd, 6),
        method=reading.method,
        flag=reading.why or ";".join(doubts),
        peak_MPa=float(trace.pressure_MPa[cycle.peak]),
    )


def _of_table(table: AngleTable, target: Target) -> Readings:
    """Without pressure, each row is the angle of a cycle at the study's pressure, as the table's maker says; else a trace."""
    if table.pressure_MPa is None:
        numbers = range(1, len(table.line) + 1) if table.cycle is None else table.cycle.tolist()
        return Readings(
            tuple(_stated(*row) for row in zip(numbers, table.angle_deg, table.angle_sd_deg)),
            np.full(len(target.curve_MPa), np.nan),
            table.warnings,
        )
    flags = ("",) * len(table.line)
    trace = Trace(table.pressure_MPa, table.angle_deg, table.angle_sd_deg, np.isfinite(table.angle_deg))
    if table.cycle is None:
        return _of_trace(trace, flags, target, table.warnings)
    values, curves = [], []
    for number in dict.fromkeys(table.cycle.tolist()):
        rows = table.cycle == number
        part = Trace(trace.pressure_MPa[rows], trace.angle[rows], trace.sd[rows], trace.sure[rows])
        if not np.isfinite(part.pressure_MPa).any():
            values.append(CycleValue(number, math.nan, flag=NO_PRESSURE))
            continue
        cycle = Cycle(0, int(np.nanargmax(part.pressure_MPa)), len(part.angle))
        values.append(_value(number, cycle, part, flags, target))
        curves.append(rising_curve(target.curve_MPa, target.tolerance_MPa, part, (cycle,)))
    return Readings(tuple(values), nan_mean(np.array(curves).reshape(-1, len(target.curve_MPa))), table.warnings)


def _stated(number: int, angle: float, sd: float) -> CycleValue:
    if not math.isfinite(angle):
        return CycleValue(number, math.nan, flag="no angle in the table")
    return CycleValue(number, round(float(angle), 6), round(float(sd), 6), STATED)


def _without(why: str, target: Target, warnings: Sequence[str]) -> Readings:
    cycle = CycleValue(1, math.nan, flag=why)
    return Readings((cycle,), np.full(len(target.curve_MPa), np.nan), tuple(warnings))
