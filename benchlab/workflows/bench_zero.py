"""A bench before it is armed: empty, and on the supply that it was calibrated with.

The supply of the microcontroller is the reference of its DAC and of its ADC. On another USB port it may be 5 % higher: then each code gives
5 % more pressure, and the monitor, read against the same reference, does not show it. What shows it is the monitor's zero: 1 V, say, is
made by the regulator, and reads as less.
"""

from __future__ import annotations

import math

import numpy as np

from benchlab.bench import Bench
from benchlab.devices.interface import Device
from benchlab.errors import BenchError
from benchlab.runner.clock import Clock
from benchlab.runner.empty import EMPTY_MPA
from benchlab.workflows.bench_rest import WAIT_S, readings_at_rest

READINGS = 25

HIGH_SHARE = 0.04
"""A supply may be so much above the calibrated one, by the monitor's zero: 40 mV of 1 V, by which a regulator's own zero may wander."""

HIGHEST_V = 5.75
"""More is no supply of an ATmega328P: its monitor is not there."""


def check_zero(device: Device, bench: Bench, clock: Clock) -> None:
    """Read the monitor of a vented bench. BenchError where it still holds pressure, or where its supply is above the calibrated one.

    A bench without a calibrated monitor cannot be checked and is not.
    """
    if bench.monitor is None:
        return
    clock.start()
    pressure, volts = _mean(device, clock)
    while pressure > EMPTY_MPA and clock.now_s() < WAIT_S:
        pressure, volts = _mean(device, clock)
    if pressure > EMPTY_MPA:
        raise BenchError(
            f"the bench is vented, and its monitor shows {1000 * pressure:.1f} kPa after {WAIT_S:g} s",
            hint="let the air out, wait, or calibrate it again: is the monitor wired to A1, has its zero moved, is the supply lower?",
        )
    share = bench.monitor.inverse(0.0) / volts - 1 if volts > 0 else math.inf
    if bench.supply_V * (1 + share) > HIGHEST_V:
        raise BenchError(
            f"the monitor of the vented bench reads {volts:.3f} V instead of {bench.monitor.inverse(0.0):.3f} V, which no supply explains",
            hint="is it wired to A1, and does its regulator have its own supply? else calibrate again, without its wire",
        )
    if share > HIGH_SHARE:
        raise BenchError(
            f"the monitor of the vented bench reads {volts:.3f} V instead of {bench.monitor.inverse(0.0):.3f} V, as if the supply were "
            f"{bench.supply_V * (1 + share):.2f} V, and each pressure {100 * share:.0f} % above what is asked for",
            hint=f"measure the supply, calibrated at {bench.supply_V:g} V; use the same USB port, or calibrate again",
        )


def _mean(device: Device, clock: Clock) -> tuple[float, float]:
    """Pressure and monitor volts over half a second. NaN where nothing was read."""
    readings = readings_at_rest(device, clock, READINGS)
    told = [(r.pressure_MPa, r.monitor_V) for r in readings if math.isfinite(r.pressure_MPa)]
    if not told:
        return math.nan, math.nan
    pressure, volts = np.mean(told, axis=0)
    return float(pressure), float(volts)
