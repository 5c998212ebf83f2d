"""Pressure that is too high, or is not what was asked for."""

from __future__ import annotations

from benchlab.runner.end import Cause
from benchlab.runner.guards.limits import Limits
from benchlab.runner.guards.timer import Lag, Timer
from benchlab.runner.tick import Tick


class AboveGuard:
    """The measured pressure is above what the bench may have, whatever was asked for."""

    name = "pressure above the limit"

    def __init__(self, limit_MPa: float, above_MPa: float, for_s: float) -> None:
        self.limit_MPa, self.above_MPa, self.for_s = limit_MPa, above_MPa, for_s
        self.timer = Timer()

    def check(self, tick: Tick) -> Cause | None:
        pressure = tick.reading.pressure_MPa
        if self.timer.count(tick.time_s, pressure > self.limit_MPa + self.above_MPa) < self.for_s:
            return None
        words = f"measured {pressure:.3f} MPa, above the limit of {self.limit_MPa:g} MPa"
        look = "the regulator does not hold, or its calibration is wrong; --guard above_MPa=... allows more"
        return Cause("above limit", f"{words}: {look}")


class FollowGuard:
    """The measured pressure against the range that regulators reach, from one without lag to one with lag_s."""

    name = "pressure follows"
    FAR, SOON = 5.0, 0.25

    def __init__(self, limits: Limits) -> None:
        self.limits, self.lag = limits, Lag(limits.lag_s)
        self.near, self.far = Timer(), Timer()

    def check(self, tick: Tick) -> Cause | None:
        limits, command, measured = self.limits, tick.command_MPa, tick.reading.pressure_MPa
        slow = self.lag.after(tick.time_s, command)
        low, high = (command, slow) if command < slow else (slow, command)
        off = measured - low if measured < low else measured - high if measured > high else 0.0
        near = self.near.count(tick.time_s, abs(off) > limits.follow_MPa)
        far = self.far.count(tick.time_s, abs(off) > self.FAR * limits.follow_MPa)
        if near < limits.follow_s and far < self.SOON * limits.follow_s:
            return None
        below = off < 0
        words = f"pressure {abs(1e3 * off):.0f} kPa {'below' if below else 'above'} set for {max(near, far):.2g} s"
        look = "leak, burst or tube off, or no supply of air" if below else "exhaust blocked, or the regulator is stuck"
        less = f"or a regulator slower than {limits.lag_s:g} s (--guard lag_s=...), or less exact (follow_MPa=..., follow_s=...)"
        return Cause("not following", f"{words}: {look}, {less}")
