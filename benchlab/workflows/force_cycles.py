"""One record of force as the cycles of an actuator: where its cycles are, their peaks, and the pressure of each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from benchlab.errors import InputError, UsageError
from benchlab.force.curve import ActuatorCycles
from benchlab.force.levels import TOLERANCE, level_of, nearest_steps, stated_steps
from benchlab.force.loading import Loading, find_loadings
from benchlab.force.peaks import ForcePeak, ForceRecord, loadings_of_cycles, peaks_of, pushes_down
from benchlab.io.export_tests import MachineTest
from benchlab.io.machine_export import ExportOptions
from benchlab.io.pressure import MAX_PRESSURE_MPA, PressureRecord
from benchlab.units import FloatArray
from benchlab.workflows.force_doubts import doubt_of_clocks, doubts_of, doubts_of_cycles, named_cycles

NEGATE = "turn it round with --negate, if pressing is negative in this export"


@dataclass(frozen=True)
class ForceSettings:
    """How force files are read and their cycles are given pressures; None and empty are not told.

    steps_MPa: growing; cycles: of each step. pressure: a log on the clock of the force file. tolerance_MPa: within which pressures are of
    one step. negate: forces with the other sign. lever_arm_mm: from the clamp to where the force acts.
    """

    options: ExportOptions = field(default_factory=ExportOptions)
    steps_MPa: tuple[float, ...] = ()
    cycles: int | None = None
    pressure: Path | None = None
    tolerance_MPa: float | None = None
    negate: bool = False
    lever_arm_mm: float | None = None

    @property
    def wanted(self) -> bool:
        """Whether blocked force is asked for, whatever the files hold."""
        return bool(self.steps_MPa) or self.pressure is not None

    def check(self) -> None:
        """Raises UsageError for values out of range, or without meaning together."""
        if self.steps_MPa and max(self.steps_MPa) > MAX_PRESSURE_MPA:
            most = max(self.steps_MPa)
            hint = f"pressures are in MPa: {most:g} kPa is {most / 1000:g}"
            raise UsageError(f"--steps-MPa goes to {most:g}, at most {MAX_PRESSURE_MPA:g} MPa are read", hint=hint)
        if self.steps_MPa and not (min(self.steps_MPa) > 0 and all(np.diff(self.steps_MPa) > 0)):
            raise UsageError(
                "steps of pressure do not grow from above 0 MPa", hint="give them as 0.035:0.35:0.035, or 0.1,0.2"
            )
        if self.cycles is not None and not self.steps_MPa:
            raise UsageError("cycles of steps that are not told", hint="give the pressures too, with --steps-MPa")
        for value, option in ((self.tolerance_MPa, "--tolerance-MPa"), (self.lever_arm_mm, "--lever-arm-mm")):
            if value is not None and not value > 0:
                raise UsageError(f"{option} is {value:g}", hint="give a number above 0")


@dataclass(frozen=True)
class FoundCycles:
    """The cycles of one actuator. pressure_MPa: (P,) of each peak of the record, NaN where it is not known or does not count; cycles:
    those that count, None where no pressure is known. inferred: what they were found from, in words."""

    actuator: str
    record: ForceRecord
    pressure_MPa: FloatArray
    cycles: ActuatorCycles | None
    inferred: dict[str, str]
    warnings: tuple[str, ...]


def find_cycles(
    test: MachineTest, actuator: str, settings: ForceSettings, log: PressureRecord | None = None
) -> FoundCycles:
    """The cycles of a record, by pressure where it is known, else by the file's column of cycles, else in the force alone.

    Raises UsageError where the force is negative or a log has no time to go by, InputError where cycles do not fit the steps.
    """
    force = test.columns["force_N"] * (-1.0 if settings.negate else 1.0)
    time = test.columns.get("time_s")
    warnings: list[str] = []
    pressure, loadings, source = _loadings(test, force, log, warnings)
    if pushes_down(force):
        record = _downwards(force, refused=settings.wanted or pressure is not None)
    else:
        record = peaks_of(force, time, loadings or None)
    levels, how = _levels(record, pressure, settings, warnings)
    warnings += doubts_of(record)
    if how:
        warnings += doubts_of_cycles(record, pressure)
    if pressure is not None and time is not None and record.contact:
        warnings += doubt_of_clocks(record, time, force, pressure)
    cycles = _counted(actuator, record, levels)
    if settings.wanted and not record.peaks and not record.untouched:
        raise InputError(record.notes[-1], hint="record from before the first loading until after the last")
    if settings.steps_MPa and record.untouched and pressure is None:
        cycles = _untouched(actuator, settings)
    return FoundCycles(actuator, record, levels, cycles, {"cycles": source, **how}, tuple(warnings))


def _loadings(
    test: MachineTest, force: FloatArray, log: PressureRecord | None, warnings: list[str]
) -> tuple[FloatArray | None, tuple[Loading, ...], str]:
    """(n,) pressure where it has cycles, the loadings where something but the force tells them, and what does."""
    pressure, source = _pressure(test, log)
    if pressure is not None:
        vacuum = pushes_down(pressure)
        if not vacuum and (found := find_loadings(pressure)):
            return pressure, found, source
        what = (
            f"the pressure goes below its rest, to {np.nanmin(pressure):.3g} MPa"
            if vacuum
            else "the pressure does not rise and fall"
        )
        if log is not None:
            raise InputError(
                what, hint="is it the log of this record, on the same clock, of an actuator under pressure?"
            )
        warnings.append(f"{what}: no cycles from it")
    if "cycle" in test.columns and (found := loadings_of_cycles(test.columns["cycle"], force)):
        return None, found, "the file's column of cycles"
    return None, (), "rises and falls of the force"


def _pressure(test: MachineTest, log: PressureRecord | None) -> tuple[FloatArray | None, str]:
    """(n,) pressure of each reading and where it is from."""
    if log is None:
        return test.columns.get("pressure_MPa"), "the file's column of pressure"
    if "time_s" not in test.columns:
        what = "no time in the file, and a log of pressure goes by time"
        raise UsageError(what, hint="give --steps-MPa and --cycles instead")
    return log.at(test.columns["time_s"]), f"the pressure in {log.source}"


def _downwards(force: FloatArray, refused: bool) -> ForceRecord:
    """A record of cycles that go down: without peaks, or refused where they are wanted."""
    low = float(np.nanmin(force))
    if refused:
        raise UsageError(f"the force goes down in its cycles, to {low:.4g} N", hint=NEGATE)
    note = f"the force goes down, to {low:.4g} N: {NEGATE}"
    return ForceRecord((), (), None, low, float(np.nanmax(force)), None, (note,))


def _counted(actuator: str, record: ForceRecord, levels: FloatArray) -> ActuatorCycles | None:
    """The peaks with a pressure."""
    kept = np.flatnonzero(np.isfinite(levels))
    if not len(kept):
        return None
    peaks = [record.peaks[i] for i in kept]
    force_N = np.array([peak.peak_N for peak in peaks])
    return ActuatorCycles(actuator, force_N, levels[kept], np.array([peak.lower_bound for peak in peaks]))


def _untouched(actuator: str, settings: ForceSettings) -> ActuatorCycles:
    """Of a load cell that was never touched: no force at any of the stated steps."""
    steps = np.repeat(settings.steps_MPa, settings.cycles or 1)
    return ActuatorCycles(actuator, np.zeros(len(steps)), steps, np.zeros(len(steps), dtype=bool))


def _levels(
    record: ForceRecord, pressure: FloatArray | None, settings: ForceSettings, warnings: list[str]
) -> tuple[FloatArray, dict[str, str]]:
    """(P,) pressure of each peak, and how it is known."""
    levels = np.full(len(record.peaks), np.nan)
    whole = np.array([not peak.cut for peak in record.peaks], dtype=bool)
    if pressure is not None and len(levels):
        found = [level_of(pressure, cycle) for cycle in record.loadings]
        levels[whole] = np.array([level.pressure_MPa for level in found])[whole]
        if passing := [n for n, level in enumerate(found, start=1) if not level.held]:
            warnings.append(f"the pressure is not held in {named_cycles(passing)}: its largest value counts")
        if not settings.steps_MPa:
            return levels, {"pressure": "mean of each hold"}
        tolerance = settings.tolerance_MPa or TOLERANCE * max(settings.steps_MPa)
        steps = nearest_steps(levels[whole], settings.steps_MPa, tolerance)
        levels[whole] = np.array(settings.steps_MPa)[steps]
        warnings += _counts(steps, settings)
        return levels, {"pressure": f"the stated step within {tolerance:.2g} MPa of each hold"}
    if settings.steps_MPa and record.contact:
        count = int(whole.sum())
        steps = stated_steps(count, len(settings.steps_MPa), settings.cycles, _where(record.peaks))
        levels[whole] = np.array(settings.steps_MPa)[steps]
        each = "" if settings.cycles else f", {count // len(settings.steps_MPa)} cycles each, as {count} were found"
        return levels, {"pressure": f"the stated steps in order of time{each}"}
    return levels, {}


def _counts(steps: np.ndarray, settings: ForceSettings) -> Iterator[str]:
    if settings.cycles is not None:
        for step, pressure in enumerate(settings.steps_MPa):
            if (count := int((steps == step).sum())) != settings.cycles:
                yield f"{count} cycles at {pressure:g} MPa, {settings.cycles} are stated"


def _where(peaks: tuple[ForcePeak, ...]) -> str:
    """Where whole peaks are, the first and last of many."""
    if not peaks:
        return "none"
    timed = np.isfinite(peaks[0].time_s)
    shown = [f"{p.time_s:.4g} s" if timed else f"reading {p.row + 1}" for p in peaks if not p.cut]
    if len(shown) > 8:
        shown = [*shown[:4], "…", *shown[-3:]]
    cut = sum(p.cut for p in peaks)
    return f"peaks at {', '.join(shown)}" + (f"; {cut} more are cut by the record's ends" if cut else "")
