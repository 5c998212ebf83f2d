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
    """The angle against the least that this pressure must bend the actuator by. Without a response curve, 10° at 0.2 MPa are expected."""

    name = "bending"
    WORTH_DEG = 10.0
    REST_MPa = 0.02

    def __init__(self, limits: Limits, expected_deg: Callable[[float], float]) -> None:
        self.limits, self.expected_deg = limits, expected_deg
        self.lag, self.timer, self.at_rest = Lag(limits.lag_s), Timer(), Timer()
        self.rest_deg = math.nan

    def check(self, tick: Tick) -> Cause | None:
        angle = tick.angle_deg
        if math.isnan(angle):
            return None
        slow = min(self.lag.after(tick.time_s, tick.command_MPa), tick.command_MPa)
        resting = self.at_rest.count(tick.time_s, slow <= self.REST_MPa) >= self.limits.bend_s
        if math.isnan(self.rest_deg) or (resting and slow <= self.REST_MPa):
            self.rest_deg = angle
        expected, moved = self.expected_deg(slow), angle - self.rest_deg
        idle = expected >= self.WORTH_DEG and moved < self.limits.bend_share * expected
        if self.timer.count(tick.time_s, idle) < self.limits.bend_s:
            return None
        words = f"{1e3 * tick.command_MPa:.0f} kPa asked for and the angle is {moved:.1f}° from rest for {self.timer.for_s:.2g} s, where"
        return Cause(
            "not following",
            f"{words} {self.limits.bend_share * expected:.1f}° are the least: burst, tube off, or the flex sensor came off",
        )


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
