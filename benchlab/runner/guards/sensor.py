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
        self.name, self.unit, self.value, self.scale, self.limits = name, unit, value, (low, high), limits
        self.bad = Timer()
        self.same = self.same_since = self.low = self.high = math.nan
        self.moved_at = math.inf

    def check(self, tick: Tick) -> Cause | None:
        if tick.status & Status.NO_ANSWER.value:
            return None
        value = self.value(tick)
        good = self.scale[0] <= value <= self.scale[1]
        if self.bad.count(tick.time_s, not good) >= self.limits.sensor_s:
            words = f"{self._fault(value)} for {self.bad.for_s:.2g} s: look at the sensor and its wires; --guard sensor_s=... waits longer"
            return Cause("sensor", words, sensor=self.name)
        return self._stuck(tick, value)

    def _fault(self, value: float) -> str:
        if not math.isfinite(value):
            return f"the {self.name} gives no number"
        return f"the {self.name} reads {value:.4g} {self.unit}, outside {self.scale[0]:.4g} to {self.scale[1]:.4g} {self.unit},"

    def _stuck(self, tick: Tick, value: float) -> Cause | None:
        """The pressure asked for has gone by stuck_MPa since the value was new, and stuck_s have passed since it had."""
        command, limits = tick.command_MPa, self.limits
        if value != self.same:
            self.same, self.same_since = value, tick.time_s
            self.low = self.high = command
            self.moved_at = math.inf
            return None
        self.low, self.high = min(self.low, command), max(self.high, command)
        if self.high - self.low < limits.stuck_MPa:
            return None
        self.moved_at = min(self.moved_at, tick.time_s)
        if tick.time_s - self.moved_at < limits.stuck_s:
            return None
        words = f"the {self.name} reads exactly {value:.4g} {self.unit} for {tick.time_s - self.same_since:.2g} s"
        moved = f"while the pressure asked for went by {1e3 * (self.high - self.low):.0f} kPa"
        return Cause(
            "sensor", f"{words} {moved}: stuck, or not connected; --guard stuck_s=... waits longer", sensor=self.name
        )
