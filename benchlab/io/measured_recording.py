"""A run as it was recorded: the film that `benchlab analyze` went through, or the drive file of `benchlab run`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.discrepancy.measured import QUANTITIES, Run
from benchlab.errors import InputError, counted
from benchlab.io.drive_file import SCHEMA as DRIVE
from benchlab.io.drive_file import cycles_of, is_replay, origin, read_drive_file, trigger_times_s, unfit_words
from benchlab.io.drive_gaps import gaps_of
from benchlab.io.hdf5 import is_hdf5
from benchlab.io.measured_frame import MAX_PRESSURE_MPA, RunName
from benchlab.io.nexus import schema_of
from benchlab.io.run_file import RunFile, read_run_file
from benchlab.units import FloatArray

SAME_MPA = 1e-6
"""Two pressures that are the same reading differ by less."""

REPLAY = "a replay of a run is not another measurement"


@dataclass(frozen=True)
class Recorded:
    """A run, whether it is of a simulated bench, and what is to be told. title: of the film. never: why it counts for nothing, "" where it
    does. unfit: why it is no whole measurement."""

    run: Run
    simulated: bool = False
    warnings: tuple[str, ...] = ()
    title: str = ""
    never: str = ""
    unfit: str = ""


def read_recording(path: Path, name: RunName) -> Recorded:
    """The run in a run file or a drive file, called as told. Raises UsageError or InputError: a damaged file, no pressure, no value."""
    recorded = _of_drive(path, name) if schema_of(path) == DRIVE.name else _of_film(path, name)
    if (recorded.run.pressure_MPa > MAX_PRESSURE_MPA).any():
        what = f"pressure of {recorded.run.pressure_MPa.max():g} MPa, more than {MAX_PRESSURE_MPA:g}"
        raise InputError(what, file=path, hint="was the pressure given in another unit?")
    if not recorded.run.values:
        hint = "is the sensor calibrated, and was the actuator found in the film?"
        raise InputError("nothing was measured in it", file=path, hint=hint)
    return recorded


def _of_film(path: Path, name: RunName) -> Recorded:
    """The angle over the film's time. Frames in doubt have none."""
    film = read_run_file(path)
    series = film.series
    if series.pressure_MPa is None:
        hint = "analyze the film again with --pressure FILE or --ramp START:END:SECONDS"
        raise InputError("its pressure is not known", file=path, hint=hint)
    told = list(film.warnings)
    if film.partial:
        told.append("interrupted: not all of the recording was analysed")
    doubtful = series.measured & ~series.sure
    if doubtful.any():
        told.append(f"{counted(int(doubtful.sum()), 'frame')} in doubt: no value there")
    angle, sd = np.degrees(series.angle_rad), np.degrees(series.angle_sd_rad)
    columns = {
        "angle_deg": np.where(series.sure, angle, np.nan),
        "angle_deg sd": np.where(series.sure, sd, np.nan),
        **_driven(path, film, series.pressure_MPa, told),
    }
    run = _run(name, series.time_s, series.pressure_MPa, columns, told)
    return Recorded(run, warnings=tuple(told), title=str(film.recording.get("title", "")))


def _driven(path: Path, film: RunFile, seen_MPa: FloatArray, told: list[str]) -> dict[str, FloatArray]:
    """What the drive file that the pressure is from tells beside it: command and cycle at each frame; nothing where it is gone or where
    it does not give the film's pressure, which is told."""
    named, sync = film.settings.get("pressure"), film.settings.get("sync")
    places = [Path(str(named)), path.parent / Path(str(named)).name]
    drive = next((p for p in places if named and p.is_file() and is_hdf5(p) and schema_of(p) == DRIVE.name), None)
    if drive is None:
        return {}
    journal = read_drive_file(drive)
    triggers = trigger_times_s(journal)
    offset_s = -float(sync) if sync is not None else float(triggers[0]) if len(triggers) else 0.0
    samples = journal.driven
    at = film.series.time_s + offset_s
    clock = np.asarray(samples["time_s"], dtype=float)
    pressure, command = (np.interp(at, clock, samples[key], np.nan, np.nan) for key in ("pressure_MPa", "command_MPa"))
    both = np.isfinite(pressure) & np.isfinite(seen_MPa)
    if not both.any() or np.abs(pressure - seen_MPa)[both].max() > SAME_MPA:
        told.append(
            f"{drive.name} does not give the film's pressure at its trigger: command and cycle are not taken from it"
        )
        return {}
    number = cycles_of(journal)[np.clip(np.searchsorted(clock, at, side="right") - 1, 0, len(clock) - 1)].astype(float)
    return {"command_MPa": command, "cycle": np.where((number > 0) & np.isfinite(command), number, np.nan)}


def _of_drive(path: Path, name: RunName) -> Recorded:
    """The flex sensor's volts up to the vent; its angle where no volts were read. The pressure is what was measured or, without that, asked
    for, which is told."""
    journal = read_drive_file(path)
    samples = journal.driven
    told = [f"lost {words}" for words in journal.losses_told] + [gap.words for gap in gaps_of(journal)]
    told += [f"no run on a bench of metal: {words}"] if (words := origin(journal.header)) else []
    unfit = unfit_words(journal)
    told += [unfit] if unfit else []
    pressure, command = (np.asarray(samples[key], dtype=float) for key in ("pressure_MPa", "command_MPa"))
    if not np.isfinite(pressure).any():
        told.append("no pressure was measured: the pressure is what was asked for")
        pressure = command
    value = "flex_V" if np.isfinite(samples["flex_V"]).any() else "angle_deg"
    cycle = cycles_of(journal)[: len(samples)].astype(float)
    columns = {
        value: np.asarray(samples[value], dtype=float),
        "command_MPa": command,
        "cycle": np.where(cycle > 0, cycle, np.nan),
    }
    run = _run(name, np.asarray(samples["time_s"], dtype=float), pressure, columns, told)
    never = REPLAY if is_replay(journal.header) else ""
    return Recorded(run, "simulated" in words, tuple(told), never=never, unfit=unfit)


def _run(name: RunName, time_s: FloatArray, pressure: FloatArray, columns: dict[str, Any], told: list[str]) -> Run:
    """The run at its rows with a pressure, each time once."""
    timed = np.isfinite(time_s).any()
    known = np.isfinite(pressure) & (np.isfinite(time_s) if timed else True)
    if not known.all():
        told.append(f"{counted(int((~known).sum()), 'moment')} without a pressure left out")
    if timed:
        known &= np.diff(time_s, prepend=-np.inf) > 0
    kept = {key: values[known] for key, values in columns.items()}
    return Run(
        name.design,
        name.sample,
        name.run,
        time_s[known],
        pressure[known],
        {key: kept[key] for key in QUANTITIES if key in kept and np.isfinite(kept[key]).any()},
        command_MPa=kept.get("command_MPa"),
        cycle=kept.get("cycle"),
        sd={"angle_deg": kept["angle_deg sd"]} if "angle_deg sd" in kept else {},
    )
