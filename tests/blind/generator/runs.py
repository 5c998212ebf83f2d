"""What is commanded in a run: times and pressures, and which cycle each belongs to."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchlab.io.protocol_file import protocol_path, read_protocol
from tests.blind.generator.station import FloatArray

SUBSTEPS = 2
"""Steps of the simulation for each reading."""


@dataclass(frozen=True)
class Run:
    """knots_s, knots_MPa: the command, straight between. rate_Hz: of the readings. blocked: held straight, force is read.

    shut_s: from when to when the valve behind the regulator is closed.
    """

    name: str
    knots_s: tuple[float, ...]
    knots_MPa: tuple[float, ...]
    rate_Hz: float
    blocked: bool = False
    shut_s: tuple[float, float] = field(default=(np.inf, np.inf))

    @property
    def duration_s(self) -> float:
        return self.knots_s[-1]

    @property
    def rows(self) -> int:
        return len(self.times_s(1))

    def times_s(self, substeps: int = SUBSTEPS) -> FloatArray:
        count = int(np.floor(self.duration_s * self.rate_Hz)) * substeps
        return np.arange(count + 1) / (self.rate_Hz * substeps)

    def command_MPa(self, time_s: FloatArray) -> FloatArray:
        return np.interp(time_s, self.knots_s, self.knots_MPa)

    def shut(self, time_s: FloatArray) -> NDArray[np.bool_]:
        return (time_s >= self.shut_s[0]) & (time_s < self.shut_s[1])


def _path(*legs: tuple[float, float], start_MPa: float = 0.0) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Legs of (duration, pressure at its end), straight."""
    times, pressures = [0.0], [start_MPa]
    for duration, end in legs:
        times.append(times[-1] + duration)
        pressures.append(end)
    return tuple(times), tuple(pressures)


def slow_run(rng: np.random.Generator, rate_Hz: float, peak_MPa: float = 0.35) -> Run:
    """Up and down in about a minute."""
    leg = rng.uniform(26, 33)
    return Run("slow", *_path((1, 0), (leg, peak_MPa), (leg, 0), (1, 0)), rate_Hz)


def fast_run(rng: np.random.Generator, rate_Hz: float, peak_MPa: float = 0.35, cycles: int = 3) -> Run:
    """Up and down in 2 to 3 s each, some cycles."""
    up, down, rest = rng.uniform(2, 3), rng.uniform(2, 3), rng.uniform(0.2, 0.6)
    return Run("fast", *_path((0.5, 0), *[(up, peak_MPa), (down, 0), (rest, 0)] * cycles), rate_Hz)


def hold_run(rng: np.random.Generator, rate_Hz: float, shut: bool = False) -> Run:
    """Up in some seconds, held, down, rest."""
    level, ramp, hold = rng.uniform(0.25, 0.35), rng.uniform(2.5, 4), rng.uniform(28, 36)
    knots = _path((0.5, 0), (ramp, level), (hold, level), (ramp, 0), (2, 0))
    closed = (0.5 + ramp + 1.0, 0.5 + ramp + hold - 0.5) if shut else (np.inf, np.inf)
    return Run("hold", *knots, rate_Hz, shut_s=closed)


def blocked_run(rng: np.random.Generator, rate_Hz: float) -> Run:
    """Three pressings, the actuator held straight."""
    leg = rng.uniform(4, 6)
    return Run("blocked", *_path((0.5, 0), *[(leg, 0.35), (1, 0.35), (leg, 0), (0.5, 0)] * 3), rate_Hz, blocked=True)


def protocol_run(protocol: str | Path, name: str, most_rows: float) -> Run:
    """A protocol file (its text, its path, or the name of a shipped one) as a run; readings at 30 Hz, fewer where they would be too many.

    Raises ValueError for a protocol in which a controller decides.
    """
    if isinstance(protocol, str) and "\n" in protocol:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "protocol.yaml"
            path.write_text(protocol, encoding="utf-8")
            plan = read_protocol(path)
    else:
        plan = read_protocol(protocol_path(protocol))
    if plan.closed_loop:
        raise ValueError("this bench follows pressures, and the protocol asks for angles")
    time_s, pressure_MPa = plan.time_s, plan.pressure_MPa
    rate = float(np.clip(most_rows / plan.duration_s, 2.0, 30.0))
    bends = np.abs(np.diff(pressure_MPa, 2)) > 1e-12
    kept = np.r_[True, bends, True]
    return Run(name, tuple(time_s[kept]), tuple(pressure_MPa[kept]), rate)


def cycles_of(command_MPa: FloatArray) -> NDArray[np.int64]:
    """From 1: a new cycle begins at the last lowest point before the command goes up again, once it has been up and down.

    >>> cycles_of(np.array([0, 0.3, 0, 0, 0.3, 0])).tolist()
    [1, 1, 1, 2, 2, 2]
    """
    span = np.ptp(command_MPa)
    cycle = np.ones(len(command_MPa), dtype=np.int64)
    if span == 0:
        return cycle
    part = (command_MPa - command_MPa.min()) / span
    been_high, low_at, number = False, None, 1
    for i, f in enumerate(part):
        if f > 0.75:
            if low_at is not None:
                number += 1
                cycle[low_at:] = number
                low_at = None
            been_high = True
        elif been_high and f < 0.25 and (low_at is None or f <= part[low_at]):
            low_at = i
    return cycle
