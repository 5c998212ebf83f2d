"""`benchlab bench monitor`: readings of a bench that is not armed, one after the other."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.bench import Bench
from benchlab.devices.interface import Device, Fault, Reading, Status
from benchlab.io.files import written_whole
from benchlab.runner.clock import Clock

NUMBERS = ("time_s", "pressure_MPa", "monitor_V", "flex_V", "angle_deg")
COLUMNS = (*NUMBERS, "code", "status", "faults")


@dataclass(frozen=True)
class Seen:
    """A reading and what follows from it. faults: those told since the last one."""

    time_s: float
    reading: Reading
    angle_deg: float
    faults: tuple[Fault, ...]

    @property
    def flags(self) -> str:
        """The status in words: `dac lost, silence`. That it booted is no news of a bench that nobody armed."""
        told = self.reading.status & ~Status.REBOOTED
        return ", ".join((flag.name or "").lower().replace("_", " ") for flag in Status if flag in told)

    def row(self) -> dict[str, Any]:
        """By COLUMNS; None for what is not known."""
        told = [f"{fault.cause} ({fault.count} times)" if fault.count > 1 else fault.cause for fault in self.faults]
        values = (self.time_s, self.reading.pressure_MPa, self.reading.monitor_V, self.reading.flex_V, self.angle_deg)
        numbers = {name: round(value, 7) if math.isfinite(value) else None for name, value in zip(NUMBERS, values)}
        code = self.reading.code if self.reading.code >= 0 else None
        return {**numbers, "code": code, "status": self.flags, "faults": "; ".join(told)}


def watch(device: Device, bench: Bench, clock: Clock, rate_Hz: float, seconds: float | None) -> Iterator[Seen]:
    """Readings at rate_Hz, for `seconds` or without end. 0 MPa is asked for each time, so that a bench that is not armed stays vented.

    Raises LostError where the bench does not answer any more.
    """
    clock.start()
    tick = 0
    while seconds is None or tick / rate_Hz < seconds:
        clock.wait_until(tick / rate_Hz)
        now = clock.now_s()
        reading = device.exchange(now, 0.0)
        angle = math.nan if bench.flex is None else bench.flex.of(reading.flex_V)
        yield Seen(now, reading, angle, tuple(device.faults()))
        tick = max(tick + 1, math.floor(clock.now_s() * rate_Hz))


def write_seen(path: Path, seen: Iterable[Seen]) -> None:
    """The readings as a CSV table, written whole: UTF-8, commas, an empty cell for what is not known."""
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(one.row() for one in seen)


def summary(seen: list[Seen]) -> dict[str, Any]:
    """Mean and standard deviation of each number, and how often which flag was seen."""
    columns = {
        name: np.array([np.nan if (v := one.row()[name]) is None else v for one in seen]) for name in NUMBERS[1:]
    }
    flags: dict[str, int] = {}
    for one in seen:
        for flag in filter(None, one.flags.split(", ")):
            flags[flag] = flags.get(flag, 0) + 1
    return {
        "readings": len(seen),
        "seconds": round(seen[-1].time_s, 3) if seen else 0.0,
        **{name: _spread(values) for name, values in columns.items()},
        "flags": flags,
        "faults": [text for one in seen if (text := one.row()["faults"])],
    }


def _spread(values: np.ndarray) -> dict[str, float] | None:
    known = values[np.isfinite(values)]
    if not len(known):
        return None
    return {"mean": float(known.mean()), "sd": float(known.std(ddof=1)) if len(known) > 1 else 0.0}
