"""Which guards a bench has: one whose sensor is not there, or not calibrated, is left out, and so is one that is switched off."""

from __future__ import annotations

import math
import typing
from collections.abc import Callable

from benchlab.bench import Bench
from benchlab.runner.empty import FLEX_MARGIN_V
from benchlab.runner.end import Cause
from benchlab.runner.guards.bend import BendGuard, least_expected_deg
from benchlab.runner.guards.device import DeviceGuard, FaultGuard
from benchlab.runner.guards.limits import Limits
from benchlab.runner.guards.pressure import AboveGuard, FollowGuard
from benchlab.runner.guards.rest import RestGuard
from benchlab.runner.guards.sensor import SensorGuard
from benchlab.runner.guards.swing import SwingGuard
from benchlab.runner.tick import Tick

ABOVE_S = 0.1
"""How long a measured pressure may be above the limit."""


class Guard(typing.Protocol):
    name: str

    def check(self, tick: Tick) -> Cause | None: ...


def guards_of(
    bench: Bench,
    rate_Hz: float,
    limits: Limits | None = None,
    expected_deg: Callable[[float], float] = least_expected_deg,
) -> list[Guard]:
    """The guards for what this bench can measure, without those that are off.

    expected_deg: the angle over the pressure (MPa), of a simulated response.
    """
    limits = limits or Limits()
    found: list[Guard] = [DeviceGuard(), FaultGuard(limits.fault_share, rate_Hz)]
    if bench.monitor is not None:
        above_MPa = limits.above_MPa if math.isfinite(limits.above_MPa) else Limits.above_MPa
        top = max(bench.monitor.of(bench.supply_V), bench.limit_MPa + 2 * above_MPa)
        found += [
            AboveGuard(bench.limit_MPa, limits.above_MPa, ABOVE_S),
            SensorGuard("pressure sensor", "MPa", lambda tick: tick.reading.pressure_MPa, -0.02, top, limits),
            FollowGuard(limits),
        ]
    if bench.flex is not None:
        high = bench.supply_V - FLEX_MARGIN_V
        found += [
            SensorGuard("flex sensor", "V", lambda tick: tick.reading.flex_V, FLEX_MARGIN_V, high, limits),
            BendGuard(limits, expected_deg),
            RestGuard(limits),
            SwingGuard(limits),
        ]
    return [guard for guard in found if not is_off(guard, limits)]


OFF_BY = {
    FaultGuard: ("fault_share",),
    AboveGuard: ("above_MPa",),
    FollowGuard: ("follow_MPa", "follow_s"),
    BendGuard: ("bend_s",),
    RestGuard: ("rest_deg",),
    SwingGuard: ("swings",),
}
"""Each guard with the limits any of which switches it off."""


def is_off(guard: Guard, limits: Limits) -> bool:
    """Whether a guard cannot stop anything with these limits."""
    off = limits.off
    if isinstance(guard, SensorGuard):
        return "sensor_s" in off and not {"stuck_s", "stuck_MPa"}.isdisjoint(off)
    return not set(OFF_BY.get(type(guard), ())).isdisjoint(off)
