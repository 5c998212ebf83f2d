"""A sensor that cannot be believed."""

from __future__ import annotations

import math
from collections.abc import Callable

from benchlab.devices.interface import Status
from benchlab.runner.end import Cause
from benchlab.runner.guards.limits import Limits
from benchlab.runner.guards.timer import Timer
from benchlab.runner.tick import Tick


class SensorGuard:
    """One sensor: no number, off its scale, or exactly the same while the pressure asked for moves."""

    def __init__(
        self, name: str, unit: str, value: Callable[[Tick], float], low: float, high: float, limits: Limits
    ) -> None:
        self.name, self.unit, self.value, self.low, self.high, self.limits = name, unit, value, low, high, limits
        self.bad = Timer()
        self.same = self.same_since = math.nan
        self.asked = (math.inf, -math.inf)

    def check(self, tick: Tick) -> Cause | None:
        if tick.status & Status.NO_ANSWER.value:
            return None
        value = self.value(tick)
        good = self.low <= value <= self.high
        if self.bad.count(tick.time_s, not good) >= self.limits.sensor_s:
            return Cause("sensor", f"{self._fault(value)} for {self.bad.for_s:.2g} s: look at the sensor and its wires")
        return self._stuck(tick, value)

    def _fault(self, value: float) -> str:
        if not math.isfinite(value):
            return f"the {self.name} gives no number"
        return f"the {self.name} reads {value:.4g} {self.unit}, outside {self.low:.4g} to {self.high:.4g} {self.unit},"

    def _stuck(self, tick: Tick, value: float) -> Cause | None:
        if value != self.same:
            self.same, self.same_since, self.asked = value, tick.time_s, (tick.command_MPa, tick.command_MPa)
            return None
        low, high = self.asked
        if not low <= tick.command_MPa <= high:
            low, high = min(low, tick.command_MPa), max(high, tick.command_MPa)
            self.asked = low, high
        stuck_s = tick.time_s - self.same_since
        if high - low < self.limits.stuck_MPa or stuck_s < self.limits.stuck_s:
            return None
        words = f"the {self.name} reads exactly {value:.4g} {self.unit} for {stuck_s:.2g} s while the pressure asked for went by"
        return Cause("sensor", f"{words} {1e3 * (high - low):.0f} kPa: stuck, or not connected")
