"""A bench before it is armed: its actuator is straight, by a flex sensor that is calibrated for it."""

from __future__ import annotations

import math

import numpy as np

from benchlab.bench import Bench, Line
from benchlab.devices.interface import Device
from benchlab.errors import BenchError
from benchlab.runner.clock import Clock

READINGS, PERIOD_S, WAIT_S = 15, 0.02, 5.0
"""Readings to one angle, and how long is waited for an actuator that is still emptying."""


def check_straight(device: Device, bench: Bench, clock: Clock, most_deg: float) -> None:
    """Read the flex sensor of a vented bench. BenchError where it shows more than most_deg either way and that does not pass.

    A bench without a calibrated flex sensor, or one that gives no number, cannot be checked and is not: the run's guards see the last.
    """
    if bench.flex is None or math.isinf(most_deg):
        return
    clock.start()
    angle = _angle_deg(device, bench.flex, clock)
    while abs(angle) > most_deg and clock.now_s() < WAIT_S:
        angle = _angle_deg(device, bench.flex, clock)
    if abs(angle) > most_deg:
        raise BenchError(
            f"the bench is vented and the flex sensor reads {angle:.1f}°, more than {most_deg:g}° from straight".replace(
                "-", "−"
            ),
            hint="is offset_deg of the bench file right (its sign too), is it this actuator's sensor, is air left inside? "
            "`benchlab control flex` calibrates it, and --guard rest_deg=DEG allows more",
        )


def _angle_deg(device: Device, flex: Line, clock: Clock) -> float:
    """Median over a third of a second; 0 MPa is asked for, which needs no arming. NaN where nothing was read."""
    began, volts = clock.now_s(), []
    for index in range(READINGS):
        clock.wait_until(began + (index + 1) * PERIOD_S)
        volts.append(device.exchange(clock.now_s(), 0.0).flex_V)
    known = [each for each in volts if math.isfinite(each)]
    return flex.of(float(np.median(known))) if known else math.nan
