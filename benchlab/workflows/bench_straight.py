"""A bench before it is armed: its actuator is straight, by a flex sensor that is calibrated for it."""

from __future__ import annotations

import math

import numpy as np

from benchlab.bench import Bench, Line
from benchlab.devices.interface import Device
from benchlab.errors import BenchError
from benchlab.runner.clock import Clock
from benchlab.workflows.bench_rest import WAIT_S, readings_at_rest

READINGS = 15
"""To one angle."""


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
    """Median over a third of a second. NaN where nothing was read."""
    volts = [reading.flex_V for reading in readings_at_rest(device, clock, READINGS)]
    known = [each for each in volts if math.isfinite(each)]
    return flex.of(float(np.median(known))) if known else math.nan
