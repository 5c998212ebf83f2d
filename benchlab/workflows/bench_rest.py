"""A vented bench, looked at: 0 MPa is asked for, which needs no arming."""

from __future__ import annotations

from benchlab.devices.interface import Device, Reading
from benchlab.runner.clock import Clock

PERIOD_S = 0.02

WAIT_S = 5.0
"""How long is waited for a bench that is still emptying."""


def readings_at_rest(device: Device, clock: Clock, count: int) -> list[Reading]:
    """So many readings, one every 20 ms."""
    began, readings = clock.now_s(), []
    for index in range(count):
        clock.wait_until(began + (index + 1) * PERIOD_S)
        readings.append(device.exchange(clock.now_s(), 0.0))
    return readings
