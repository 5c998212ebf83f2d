"""An actuator that does not bend."""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from benchlab.runner.end import Cause
from benchlab.runner.guards.limits import Limits
from benchlab.runner.guards.timer import Lag, Timer
from benchlab.runner.tick import Tick


class BendGuard:
    """The angle against the least that this pressure must bend the actuator by; without a response curve, 10° at 0.2 MPa are expected. And
    against the most that may be left of it once nothing is asked for."""

    name = "bending"
    WORTH_DEG, LEFT_SHARE = 10.0, 0.5
    REST_MPa = 0.02

    def __init__(self, limits: Limits, expected_deg: Callable[[float], float]) -> None:
        self.limits, self.expected_deg = limits, expected_deg
        self.lag = Lag(limits.lag_s)
        self.idle, self.bent, self.resting = Timer(), Timer(), Timer()
        self.rest_deg, self.peak_deg, self.expected_at_rest_deg = math.nan, 0.0, 0.0
        self.vented_at_s = math.nan

    def check(self, tick: Tick) -> Cause | None:
        angle, time_s = tick.angle_deg, tick.time_s
        if math.isnan(angle):
            return None
        lagging = self.lag.after(time_s, tick.command_MPa)
        surely = min(lagging, tick.command_MPa)
        if math.isnan(self.rest_deg):
            self.rest_deg, self.expected_at_rest_deg = angle, self.expected_deg(surely)
        moved, expected = angle - self.rest_deg, self.expected_deg(surely) - self.expected_at_rest_deg
        self.peak_deg = max(self.peak_deg, moved)
        share = 0.0 if math.isinf(self.limits.bend_share) else self.limits.bend_share
        idle = expected >= self.WORTH_DEG and moved < share * expected
        if self.idle.count(time_s, idle) >= self.limits.bend_s:
            return self._idle(tick, moved, expected)
        asked = tick.command_MPa > self.REST_MPa
        if asked or math.isnan(self.vented_at_s):
            self.vented_at_s = math.nan if asked else time_s
        rest = lagging <= self.REST_MPa and not asked
        bent = rest and self.peak_deg >= self.WORTH_DEG and moved > self.LEFT_SHARE * self.peak_deg
        if self.bent.count(time_s, bent) >= self.limits.bend_s:
            words = f"nothing asked for since {time_s - self.vented_at_s:.1f} s and the angle is still {moved:.1f}° of {self.peak_deg:.1f}°"
            look = "exhaust blocked, tube kinked or a valve shut, or it empties slowly (--guard lag_s=..., bend_s=...)"
            return Cause("not following", f"{words}: {look}")
        if self.resting.count(time_s, rest and not bent) >= self.limits.bend_s and rest:
            self.rest_deg, self.peak_deg, self.expected_at_rest_deg = angle, 0.0, self.expected_deg(surely)
        return None

    def _idle(self, tick: Tick, moved: float, expected: float) -> Cause:
        words = f"{1e3 * tick.command_MPa:.0f} kPa asked for and the angle is {moved:.1f}° from rest for {self.idle.for_s:.2g} s"
        least = f"where {self.limits.bend_share * expected:.1f}° are the least"
        look = "burst, tube off, the flex sensor came off, or it is held straight (--guard bend_s=off)"
        return Cause("not following", f"{words}, {least}: {look}")


def least_expected_deg(pressure_MPa: float) -> float:
    """The angle that any actuator of this kind reaches (the stiffest of the paper, slw 30: 7.8° at 0.35 MPa, a quarter is asked for)."""
    return pressure_MPa * BendGuard.WORTH_DEG / 0.2


def expected_along(pressure_MPa: ArrayLike, angle_deg: ArrayLike) -> Callable[[float], float]:
    """The angle over the pressure by straight lines through the points of a response curve, (P,) growing pressures each with its angle.

    >>> expected_along([0.0, 0.1, 0.3], [0.0, 40.0, 100.0])(0.2)
    70.0
    """
    pressures, angles = np.asarray(pressure_MPa, float).tolist(), np.asarray(angle_deg, float).tolist()

    def expected(pressure: float) -> float:
        if not pressures[0] < pressure < pressures[-1]:
            return angles[0] if pressure <= pressures[0] else angles[-1]
        after = bisect.bisect_right(pressures, pressure)
        share = (pressure - pressures[after - 1]) / (pressures[after] - pressures[after - 1])
        return angles[after - 1] + share * (angles[after] - angles[after - 1])

    return expected
