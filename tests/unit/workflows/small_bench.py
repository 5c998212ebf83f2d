"""A bench that vents by itself when nobody speaks to it, with a regulator that nobody knows."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

from benchlab.bench import Bench, Line
from benchlab.devices.interface import Fault, LostError, Reading, Status
from benchlab.errors import BenchError

SILENCE_S = 0.5
TICK_S = 0.01
TRUE, MONITOR = Line(0.0965, -0.001), Line(0.12, -0.12)


class Metronome:
    """Seconds as a thread gets them that sleeps for ten milliseconds at a time: where the whole machine stands still, so do they."""

    def __init__(self) -> None:
        self.ticks, self._stop = 0, threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> Metronome:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()

    def now_s(self) -> float:
        return self.ticks * TICK_S

    def _run(self) -> None:
        while not self._stop.wait(TICK_S):
            self.ticks += 1


class SmallBench:
    """true: pressure over volts of its regulator, at a supply of true_supply_V. monitor: pressure over the monitor's volts. before: is
    called before each exchange, with their number so far, and may raise. vent_fails: how many vents nobody confirms. clock_s: what
    silence is measured by."""

    kind = "small"

    def __init__(
        self,
        bench: Bench,
        true: Line = TRUE,
        true_supply_V: float = 4.9,
        monitor: Line | None = MONITOR,
        before: Callable[[int], None] = lambda n: None,
        vent_fails: int = 0,
        clock_s: Callable[[], float] = time.monotonic,
    ) -> None:
        self.bench, self.true, self.true_supply_V, self.monitor = bench, true, true_supply_V, monitor
        self.before, self.vent_fails = before, vent_fails
        self.code = self.exchanges = self.vents = self.highest_code = 0
        self.armed, self.silent = False, False
        self.clock_s = clock_s
        self.longest_silence_s, self.last_s = 0.0, clock_s()
        self.vented_by: list[str] = []

    @property
    def pressure_MPa(self) -> float:
        """What a gauge on it shows."""
        return max(0.0, self.true.of(self.true_supply_V * self.code / 4096)) if self.armed else 0.0

    def about(self) -> dict[str, Any]:
        return {"kind": self.kind}

    def arm(self) -> None:
        self.armed, self.last_s = True, self.clock_s()

    def exchange(self, time_s: float, pressure_MPa: float, trigger: bool = False) -> Reading:
        self.before(self.exchanges)
        now = self.clock_s()
        self.longest_silence_s, self.last_s = max(self.longest_silence_s, now - self.last_s), now
        self.exchanges += 1
        code = self.bench.code(pressure_MPa)
        if code and not self.armed:
            raise BenchError("not armed")
        self.code = code
        self.highest_code = max(self.highest_code, code)
        monitor_V = float("nan") if self.monitor is None else self.monitor.inverse(self.pressure_MPa)
        monitor_V *= (
            self.bench.supply_V / self.true_supply_V
        )  # the ADC's reference is the supply that the host takes for another
        return Reading(float("nan"), 1.0, code, time_s, Status.ARMED if self.armed else Status(0), monitor_V)

    def vent(self) -> None:
        self.vents += 1
        self.vented_by.append(threading.current_thread().name)
        if self.vent_fails:
            self.vent_fails -= 1
            raise LostError("nobody answered `vent`")
        self.armed, self.code = False, 0

    def faults(self) -> list[Fault]:
        return []

    def close(self) -> None:
        pass
