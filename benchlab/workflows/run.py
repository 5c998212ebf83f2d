"""`benchlab run`: a protocol on a bench, from its journal to its files."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.bench import LimitError
from benchlab.devices.interface import Device
from benchlab.errors import InputError
from benchlab.io.files import make_folder
from benchlab.io.journal import JournalWriter
from benchlab.runner.clock import Clock, RealClock, VirtualClock
from benchlab.runner.end import RunEnd
from benchlab.runner.run import execute
from benchlab.runner.stop import Stop, signals_to
from benchlab.runner.tick import Tick
from benchlab.runner.undisturbed import undisturbed
from benchlab.workflows.bench_straight import check_straight
from benchlab.workflows.bench_supply import check_supply
from benchlab.workflows.bench_zero import check_zero
from benchlab.workflows.open_bench import open_bench
from benchlab.workflows.run_header import header_of
from benchlab.workflows.run_prepare import Prepared


@dataclass(frozen=True)
class Driven:
    """A run that is over: its end, its journal, and the twin's truth if it ran on one. went_first: whether the loop went before other
    programs."""

    end: RunEnd
    journal: Path
    about: dict[str, Any]
    truth: Any = None
    went_first: bool = False


def drive(prepared: Prepared, stop: Stop, on_tick: Callable[[Tick], None] | None = None) -> Driven:
    """Open the bench, begin the journal, execute the plan, vent, let go. Signals go to `stop` meanwhile.

    Whatever happens after the bench has answered is told by the end of what is returned. Raises BenchError where the bench cannot be
    opened, gives less than the plan asks for, is not empty, not straight or not on its supply, and UsageError or InputError where the
    journal cannot be begun; then nothing was armed and no file is left.
    """
    path = prepared.path(".journal")
    with signals_to(stop):
        device = open_prepared(prepared)
        try:
            make_folder(path.parent)
            about = device.about()
            _check_ceiling(prepared, about)
            if prepared.spec.kind != "replay":  # whose supply was judged when it ran
                check_supply(about, prepared.bench)
            if prepared.spec.kind == "serial":
                check_zero(device, prepared.bench, RealClock())
                check_straight(device, prepared.bench, RealClock(), prepared.limits.rest_deg)
            journal = JournalWriter(path, header_of(prepared, about))
            try:
                end, went_first = _executed(prepared, device, journal, stop, on_tick)
            finally:
                trouble = _closed(journal)
        finally:
            device.close()
    return Driven(end.with_trouble(trouble), path, about, getattr(device, "truth", None), went_first)


def open_prepared(prepared: Prepared) -> Device:
    """The bench of a prepared run, open and disarmed."""
    return open_bench(str(prepared.spec), prepared.bench, fast=prepared.fast, twin=prepared.twin)


def _executed(
    prepared: Prepared, device: Device, journal: JournalWriter, stop: Stop, on_tick: Callable[[Tick], None] | None
) -> tuple[RunEnd, bool]:
    """The end, and whether the loop went before other programs."""
    clock: Clock = VirtualClock() if prepared.fast else RealClock()
    with undisturbed(real_time=not prepared.fast) as went_first:
        end = execute(
            prepared.plan,
            device,
            prepared.bench,
            journal,
            clock,
            prepared.controller,
            prepared.guards(),
            on_tick,
            stop,
            prepared.limits,
            prepared.settings.pause_limit_s,
        )
    return end, went_first


def _check_ceiling(prepared: Prepared, about: dict[str, Any]) -> None:
    """Where the device itself gives less than the bench's calibration says, that is refused before it is armed."""
    peak_MPa = max(0.0, float(np.nanmax(prepared.plan.pressure_MPa, initial=0.0)))
    ceiling_MPa = float(about.get("ceiling_MPa", math.inf))
    if peak_MPa > ceiling_MPa + 1e-9:
        raise LimitError(
            f"the protocol asks for {peak_MPa:.4g} MPa, and the firmware of this bench gives at most {ceiling_MPa:.4g} MPa",
            hint="ask for less, or flash what `benchlab bench firmware --calibration FILE` writes",
        )


def _closed(journal: JournalWriter) -> str:
    """Close the journal; what went wrong with it, in words."""
    try:
        journal.close()
    except (InputError, OSError) as error:
        return str(error)
    return ""
