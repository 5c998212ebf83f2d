"""The pressure in the actuator while it was filmed: a record from a file, or a ramp that was set on the regulator."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from benchlab.errors import InputError, UsageError
from benchlab.io.drive_file import SCHEMA as DRIVE
from benchlab.io.hdf5 import is_hdf5
from benchlab.io.nexus import schema_of
from benchlab.io.pressure_driven import read_driven_pressure
from benchlab.io.pressure_group import read_pressure_group
from benchlab.io.pressure_table import read_pressure_table
from benchlab.vision.picture import FloatArray

MAX_PRESSURE_MPA = 10.0
MIN_PRESSURE_MPA = -0.11
"""Gauge pressures beyond these are a wrong unit or a broken sensor: there is no vacuum below −0.1013 MPa."""


@dataclass(frozen=True)
class PressureRecord:
    """Gauge pressure against the record's own time.

    time_s: (M,) never going back. pressure_MPa: (M,) NaN where the record has no number.
    source: the file. warnings: what was left out or assumed in reading it. trigger_s: the record's time at which the camera was
    triggered; None where it does not tell.
    """

    time_s: FloatArray
    pressure_MPa: FloatArray
    source: str
    warnings: tuple[str, ...] = ()
    trigger_s: float | None = None

    def at(self, times_s: ArrayLike, offset_s: float = 0.0) -> FloatArray:
        """(T,) pressure in MPa at the video times `times_s` (T,), linear between the record's rows.

        offset_s: the record's time at video time 0. NaN outside the record and beside a row without a number.

        >>> record = PressureRecord(np.array([0.0, 2.0]), np.array([0.0, 0.2]), "log.csv")
        >>> record.at([0.0, 1.0, 3.0], offset_s=0.5).round(6).tolist()
        [0.05, 0.15, nan]
        """
        times = np.asarray(times_s, dtype=float) + offset_s
        return np.interp(times, self.time_s, self.pressure_MPa, left=np.nan, right=np.nan)


@dataclass(frozen=True)
class Ramp:
    """Pressure that starts at start_MPa at time 0, changes linearly to end_MPa within duration_s, and stays there."""

    start_MPa: float
    end_MPa: float
    duration_s: float

    def at(self, times_s: ArrayLike, offset_s: float = 0.0) -> FloatArray:
        """(T,) pressure in MPa at the video times `times_s` (T,). offset_s: the ramp's time at video time 0.

        >>> Ramp(0.0, 0.35, 2.5).at([-1.0, 0.0, 1.25, 9.0]).tolist()
        [0.0, 0.0, 0.175, 0.35]
        """
        times = np.asarray(times_s, dtype=float) + offset_s
        return np.interp(times, [0.0, self.duration_s], [self.start_MPa, self.end_MPa])


def ramp(text: str) -> Ramp:
    """The ramp written as start:end:duration in MPa, MPa and s. UsageError for anything else.

    >>> ramp("0:0.35:2.5")
    Ramp(start_MPa=0.0, end_MPa=0.35, duration_s=2.5)
    """
    hint = "write start:end:duration in MPa, MPa and s, e.g. 0:0.35:2.5"
    try:
        start, end, duration = (float(part) for part in text.split(":"))
    except ValueError:
        raise UsageError(f"not a pressure ramp: {text!r}", hint=hint) from None
    if not all(math.isfinite(value) for value in (start, end, duration)):
        raise UsageError(f"pressure ramp with a value that is not finite: {text!r}", hint=hint)
    if duration <= 0:
        raise UsageError(f"pressure ramp of {duration:g} s", hint="its duration has to be more than 0 s")
    for value in (start, end):
        if not MIN_PRESSURE_MPA <= value <= MAX_PRESSURE_MPA:
            limits = f"{MIN_PRESSURE_MPA:g} to {MAX_PRESSURE_MPA:g} MPa"
            kpa = f"; {value:g} kPa would be {value / 1000:g}" if value > MAX_PRESSURE_MPA else ""
            raise UsageError(f"pressure of {value:g} MPa in the ramp, outside {limits}", hint=f"ramps are in MPa{kpa}")
    return Ramp(start, end, duration)


def read_pressure(path: Path) -> PressureRecord:
    """The pressure record in a text table (units in its header), in a drive file, or in an HDF5 file with time_s and pressure_MPa.

    Raises UsageError or InputError, with the line, for what cannot be read in exactly one way.
    """
    trigger_s = None
    if is_hdf5(path) and schema_of(path) == DRIVE.name:
        run = read_driven_pressure(path)
        time_s, pressure, trigger_s, warnings = run.time_s, run.pressure_MPa, run.trigger_s, run.warnings
        word, lines = "row", list(range(1, len(time_s) + 1))
    elif is_hdf5(path):
        word, (lines, time_s, pressure, warnings) = "row", read_pressure_group(path)
    else:
        word, (lines, time_s, pressure, warnings) = "line", read_pressure_table(path)
    known = np.isfinite(time_s)
    if not known.all():
        warnings.append(f"{_rows((~known).sum())} without a time left out")
    lines = [line for line, keep in zip(lines, known) if keep]
    time_s, pressure = time_s[known], pressure[known]
    if np.isfinite(pressure).sum() < 2:
        hint = "a record needs at least two rows with time and pressure"
        raise InputError("no data rows" if not lines else "fewer than two pressures", file=path, hint=hint)
    if without := int((~np.isfinite(pressure)).sum()):
        warnings.append(f"{_rows(without)} without a pressure: no pressure beside {'it' if without == 1 else 'them'}")
    _check_order(path, time_s, [f"{word} {line}" for line in lines] if (np.diff(time_s) < 0).any() else [])
    if repeated := int((np.diff(time_s) == 0).sum()):
        warnings.append(f"{_rows(repeated)} repeat{'s' if repeated == 1 else ''} the time of the row before")
    _check_range(path, pressure, lines, word)
    return PressureRecord(time_s, pressure, str(path), tuple(warnings), trigger_s)


def _rows(count: int) -> str:
    return f"{count} row" if count == 1 else f"{count} rows"


def _check_order(path: Path, time_s: FloatArray, places: list[str]) -> None:
    if places:
        at = int(np.argmax(np.diff(time_s) < 0)) + 1
        what = f"time goes back, from {time_s[at - 1]:g} s to {time_s[at]:g} s"
        raise InputError(
            what, file=path, where=places[at], hint="sort the rows by time, or keep one recording per file"
        )


def _check_range(path: Path, pressure: FloatArray, lines: list[int], word: str) -> None:
    outside = (pressure < MIN_PRESSURE_MPA) | (pressure > MAX_PRESSURE_MPA)
    if outside.any():
        at = int(np.argmax(outside))
        what = f"pressure of {pressure[at]:g} MPa, outside {MIN_PRESSURE_MPA:g} to {MAX_PRESSURE_MPA:g} MPa"
        raise InputError(what, file=path, where=f"{word} {lines[at]}", hint="is the unit in the header right?")
