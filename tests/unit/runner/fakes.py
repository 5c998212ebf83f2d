"""A bench, a plan and a journal that tests can look into."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from benchlab.bench import Bench, Line
from benchlab.devices.interface import Fault, Reading, Status
from benchlab.protocol.plan import Plan, PlanEvent, Step
from benchlab.runner.clock import VirtualClock
from benchlab.runner.end import RunEnd
from benchlab.runner.run import execute

BENCH = Bench("fake", monitor=Line(0.12, -0.12), flex=Line(100.0, -100.0), calibrated=True)
"""Monitor 1 to 5 V over 0 to 0.48 MPa, flex 1 V at 0° and 10 mV per degree."""

DEG_PER_MPA = 300.0

Change = Callable[[int, dict[str, Any]], None]


class FakeDevice:
    """Follows at once, and bends by 300° per MPa. change(n, fields): falsifies the n-th reading or raises.

    asked: while it was armed, each logged as `exchange`; watched: after its vent. after_vent(n, fields): falsifies the n-th of those."""

    kind = "fake"

    def __init__(self, change: Change | None = None, vent_fails: int = 0, after_vent: Change | None = None) -> None:
        self.calls: list[str] = []
        self.asked: list[tuple[float, float, bool]] = []
        self.watched: list[tuple[float, float, bool]] = []
        self.after_vent = after_vent
        self.change, self.vent_fails = change, vent_fails
        self.armed = False
        self.pending: list[Fault] = []

    def about(self) -> dict[str, Any]:
        return {"kind": "fake"}

    def arm(self) -> None:
        self.calls.append("arm")
        self.armed = True

    def exchange(self, time_s: float, pressure_MPa: float, trigger: bool = False) -> Reading:
        if self.armed:
            self.calls.append("exchange")
        here, change = (self.asked, self.change) if self.armed else (self.watched, self.after_vent)
        here.append((time_s, pressure_MPa, trigger))
        wiggle = 1e-4 * math.sin(len(here))
        fields: dict[str, Any] = {
            "pressure_MPa": pressure_MPa + wiggle / 10,
            "flex_V": 1.0 + DEG_PER_MPA * pressure_MPa / 100 + wiggle,
            "code": BENCH.code(pressure_MPa),
            "device_time_s": time_s,
            "status": Status.ARMED if self.armed else Status(0),
        }
        if change is not None:
            change(len(here) - 1, fields)
        return Reading(**fields)

    def vent(self) -> None:
        self.calls.append("vent")
        self.armed = False
        if self.vent_fails > 0:
            self.vent_fails -= 1
            from benchlab.devices.interface import LostError

            raise LostError("nobody answers")

    def faults(self) -> list[Fault]:
        told, self.pending = self.pending, []
        return told

    def close(self) -> None:
        self.calls.append("close")


class FakeJournal:
    """Keeps all; `log` has the order of everything, device calls too if it shares the device's list. watched: samples after the vent."""

    def __init__(self, log: list[str] | None = None) -> None:
        self.samples: list[tuple[Any, ...]] = []
        self.watched: list[tuple[Any, ...]] = []
        self.events: list[tuple[str, dict[str, Any]]] = []
        self.log = [] if log is None else log

    def sample(self, *values: Any) -> None:
        if "vent" in self.kinds():
            self.watched.append(values)
            return
        self.log.append("sample")
        self.samples.append(values)

    def event(self, kind: str, **content: Any) -> None:
        self.log.append("vented" if kind == "vent" else kind)
        self.events.append((kind, content))

    def kinds(self) -> list[str]:
        return [kind for kind, _ in self.events]


class BusyClock:
    """Virtual, and each tick costs `costs_s(now)` more than nothing."""

    def __init__(self, costs_s: Callable[[float], float]) -> None:
        self.now, self.costs_s = 0.0, costs_s

    def start(self) -> None:
        self.now = 0.0

    def now_s(self) -> float:
        return self.now

    def wait_until(self, time_s: float) -> None:
        self.now = max(self.now, time_s) + self.costs_s(time_s)


def plan_of(
    pressure_MPa: np.ndarray, rate_Hz: float = 100.0, events: tuple[PlanEvent, ...] = (), **changes: Any
) -> Plan:
    ticks = len(pressure_MPa)
    fields: dict[str, Any] = {
        "title": "test",
        "rate_Hz": rate_Hz,
        "limit_MPa": 0.35,
        "steps": (Step("hold", 0.0, ticks / rate_Hz, "all of it"),),
        "events": events,
        "time_s": np.arange(ticks) / rate_Hz,
        "pressure_MPa": np.asarray(pressure_MPa, float),
        "reference_deg": np.full(ticks, np.nan),
        "step": np.zeros(ticks, np.int64),
    }
    return Plan(**{**fields, **changes})


def ramp(seconds: float = 3.0, top_MPa: float = 0.3, rate_Hz: float = 100.0) -> np.ndarray:
    """Half a second at 0, a second of ramp, and at the top for the rest."""
    time_s = np.arange(round(seconds * rate_Hz)) / rate_Hz
    return np.clip(time_s - 0.5, 0, 1) * top_MPa


def run(
    pressure: np.ndarray | None = None, device: FakeDevice | None = None, **options: Any
) -> tuple[RunEnd, Any, Any]:
    """A run on the fake bench; device and journal share one log of what came after what."""
    device = device or FakeDevice()
    journal = options.pop("journal", None) or FakeJournal(device.calls)
    plan = options.pop("plan", None) or plan_of(ramp() if pressure is None else pressure)
    clock = options.pop("clock", None) or VirtualClock()
    return execute(plan, device, BENCH, journal, clock, **options), device, journal
