"""`benchlab bench vent`: opened, vented, and what was confirmed of it."""

from __future__ import annotations

import math
from typing import Any

from benchlab.bench import Bench
from benchlab.devices.interface import Device, Reading, Status
from benchlab.errors import BenchError
from benchlab.runner.clock import Clock
from benchlab.runner.empty import EMPTY_MPA
from benchlab.runner.run import vent
from benchlab.workflows.bench_hold import not_vented
from benchlab.workflows.bench_rest import WAIT_S, readings_at_rest


def vent_bench(device: Device, bench: Bench, clock: Clock) -> dict[str, Any]:
    """Vent an open bench and look at what can be seen of it: the DAC's code, the latch, and the pressure where a monitor is calibrated.

    Raises BenchError where the vent was not confirmed, the DAC holds another code than 0, or the monitor still shows pressure after 5 s.
    """
    vented, words = vent(device)
    if not vented:
        raise not_vented(words)
    clock.start()
    reading = _look(device, clock)
    while reading.pressure_MPa > EMPTY_MPA and clock.now_s() < WAIT_S:
        reading = _look(device, clock)
    if reading.code != 0 or reading.status & Status.ARMED:
        raise not_vented(f"the DAC's code is {reading.code if reading.code >= 0 else 'unknown'}")
    if reading.pressure_MPa > EMPTY_MPA:
        raise BenchError(
            f"asked to vent and the DAC is at 0, but the monitor shows {1000 * reading.pressure_MPa:.1f} kPa after {WAIT_S:g} s",
            hint="close the supply and open the relief valve by hand; is the regulator powered?",
        )
    about = device.about()
    return {
        "bench": bench.name,
        "kind": device.kind,
        "confirmed": True,
        "code": reading.code,
        "pressure_MPa": reading.pressure_MPa if math.isfinite(reading.pressure_MPa) else None,
        "after_s": round(clock.now_s(), 3),
        "read_back": about.get("reads_back", True),
        "dac_power_on_code": about.get("dac_power_on_code"),
        "unsafe": about.get("unsafe", []),
        "notes": about.get("notes", []),
        "faults": [fault.cause for fault in device.faults()],
    }


def _look(device: Device, clock: Clock) -> Reading:
    """The next reading that came. LostError by the device where none comes."""
    while True:
        (reading,) = readings_at_rest(device, clock, 1)
        if not reading.status & Status.NO_ANSWER:
            return reading
