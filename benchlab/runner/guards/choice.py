"""Which guards a bench has: one that needs a sensor which is not there, or not calibrated, is left out."""

from __future__ import annotations

import typing
from collections.abc import Callable

from benchlab.bench import Bench
from benchlab.runner.end import Cause
from benchlab.runner.guards.bend import BendGuard, least_expected_deg
from benchlab.runner.guards.device import DeviceGuard, FaultGuard
from benchlab.runner.guards.limits import Limits
from benchlab.runner.guards.pressure import AboveGuard, FollowGuard
from benchlab.runner.guards.rest import RestGuard
from benchlab.runner.guards.sensor import SensorGuard
from benchlab.runner.guards.swing import SwingGuard
from benchlab.runner.tick import Tick


class Guard(typing.Protocol):
    name: str

    def check(self, tick: Tick) -> Cause | None: ...


def guards_of(
    bench: Bench,
    rate_Hz: float,
    limits: Limits | None = None,
    expected_deg: Callable[[float], float] = least_expected_deg,
) -> list[Guard]:
    """The guards for what this bench can measure. expected_deg: the angle over the pressure (MPa), of a simulated response."""
    limits = limits or Limits()
    found: list[Guard] = [DeviceGuard(), FaultGuard(limits.fault_share, rate_Hz)]
    if bench.monitor is not None:
        top = max(bench.monitor.of(bench.supply_V), bench.limit_MPa + 2 * limits.above_MPa)
        found += [
            AboveGuard(bench.limit_MPa, limits.above_MPa, limits.sensor_s),
            SensorGuard("pressure sensor", "MPa", lambda tick: tick.reading.pressure_MPa, -0.02, top, limits),
            FollowGuard(limits),
        ]
    if bench.flex is not None:
        high = bench.supply_V - 0.02
        found += [
            SensorGuard("flex sensor", "V", lambda tick: tick.reading.flex_V, 0.02, high, limits),
            BendGuard(limits, expected_deg),
            RestGuard(limits),
            SwingGuard(limits),
        ]
    return found
