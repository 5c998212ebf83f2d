"""What every bench does, whatever it is made of: one body of checks, run over all of them by test_devices.py.

Each check gets a Bed: an open device, disarmed, and its bench. Times are the run's; where the device lives in real time, `go` waits.
"""

from __future__ import annotations

import itertools
import json
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import pytest

from benchlab.bench import Bench, LimitError
from benchlab.devices.interface import Device, Reading, Status
from benchlab.errors import BenchError

LOW_MPA = 0.05


@dataclass
class Bed:
    """live: whether the device's time is real. over_limit: what it raises above the limit. time_s: of the next exchange."""

    device: Device
    bench: Bench
    live: bool = False
    over_limit: type[BenchError] = LimitError
    time_s: float = 0.0
    began_s: float = field(default_factory=time.monotonic)

    def exchange(self, pressure_MPa: float, trigger: bool = False) -> Reading:
        """One exchange at 100 Hz."""
        if self.live:
            time.sleep(max(0.0, self.began_s + self.time_s - time.monotonic()))
        reading = self.device.exchange(self.time_s, pressure_MPa, trigger)
        self.time_s += 0.01
        return reading

    def go(self, pressure_MPa: float, seconds: float = 0.3) -> list[Reading]:
        """Ask for a pressure at 100 Hz; the readings that were answered."""
        wanted, answered, asked = round(100 * seconds), [], 0
        while len(answered) < wanted:  # on a busy computer some come late
            assert asked < (20 * wanted if self.live else wanted)
            asked += 1
            reading = self.exchange(pressure_MPa)
            if not reading.status & Status.NO_ANSWER:
                answered.append(reading)
        return answered


def tells_itself_in_json(bed: Bed) -> None:
    about = bed.device.about()
    assert json.loads(json.dumps(about, allow_nan=False))["kind"] == bed.device.kind


def disarmed_gives_no_pressure(bed: Bed) -> None:
    for reading in bed.go(0.0, 0.05):
        assert not reading.status & Status.ARMED and reading.code == 0
    with pytest.raises(BenchError):
        bed.exchange(LOW_MPA)
    assert bed.go(0.0, 0.05)[-1].code == 0


def armed_gives_what_is_asked(bed: Bed) -> None:
    bed.device.arm()
    reading = bed.go(LOW_MPA, 1.0)[-1]
    assert reading.status & Status.ARMED and not reading.status & ~(Status.ARMED | Status.WATCHDOG)
    assert reading.code == bed.bench.code(LOW_MPA)
    if bed.bench.monitor is not None:
        assert reading.pressure_MPa == pytest.approx(LOW_MPA, abs=0.005)
    assert math.isfinite(reading.flex_V)


def above_the_limit_raises_and_never_clips(bed: Bed) -> None:
    bed.device.arm()
    before = bed.go(LOW_MPA)[-1].code
    for pressure in (bed.bench.ceiling_MPa + 0.001, 1.0, -0.01, math.nan, math.inf):
        with pytest.raises(bed.over_limit):
            bed.exchange(pressure)
    assert bed.go(LOW_MPA, 0.05)[-1].code == before


def the_limit_itself_is_given(bed: Bed) -> None:
    bed.device.arm()
    assert bed.go(bed.bench.ceiling_MPa)[-1].code == bed.bench.ceiling_code


def a_vent_latches(bed: Bed) -> None:
    bed.device.arm()
    bed.go(LOW_MPA)
    bed.device.vent()
    with pytest.raises(BenchError):
        bed.exchange(LOW_MPA)
    reading = bed.go(0.0, 0.05)[-1]
    assert reading.code == 0 and not reading.status & Status.ARMED


def a_vent_may_be_done_at_any_time_and_again(bed: Bed) -> None:
    bed.device.vent()
    bed.device.vent()
    bed.device.arm()
    bed.device.vent()
    bed.device.vent()


def it_can_be_armed_again(bed: Bed) -> None:
    for _ in range(2):
        bed.device.arm()
        assert bed.go(LOW_MPA)[-1].code == bed.bench.code(LOW_MPA)
        bed.device.vent()


def closing_vents_and_may_be_done_again(bed: Bed) -> None:
    bed.device.arm()
    bed.go(LOW_MPA)
    bed.device.close()
    bed.device.close()
    with pytest.raises(BenchError):
        bed.exchange(LOW_MPA)


def its_clock_goes_with_the_runs(bed: Bed) -> None:
    bed.device.arm()
    readings = bed.go(LOW_MPA, 0.5)
    steps = [b.device_time_s - a.device_time_s for a, b in itertools.pairwise(readings)]
    assert min(steps) > 0
    if bed.live:  # a computer that is busy elsewhere holds some steps up
        assert sorted(steps)[len(steps) // 2] == pytest.approx(0.01, abs=0.003)
    else:
        assert sum(steps) == pytest.approx(0.49, abs=0.002)


def faults_are_told_once(bed: Bed) -> None:
    bed.device.arm()
    bed.go(LOW_MPA)
    for fault in bed.device.faults():
        assert fault.cause and fault.count > 0
        assert bed.live, "nothing goes wrong in virtual time"
    assert bed.device.faults() == []


def a_trigger_is_taken(bed: Bed) -> None:
    bed.device.arm()
    bed.go(LOW_MPA, 0.05)
    bed.exchange(LOW_MPA, trigger=True)
    assert bed.go(LOW_MPA, 0.05)[-1].status & Status.ARMED


CHECKS: tuple[Callable[[Bed], None], ...] = (
    tells_itself_in_json,
    disarmed_gives_no_pressure,
    armed_gives_what_is_asked,
    above_the_limit_raises_and_never_clips,
    the_limit_itself_is_given,
    a_vent_latches,
    a_vent_may_be_done_at_any_time_and_again,
    it_can_be_armed_again,
    closing_vents_and_may_be_done_again,
    its_clock_goes_with_the_runs,
    faults_are_told_once,
    a_trigger_is_taken,
)
