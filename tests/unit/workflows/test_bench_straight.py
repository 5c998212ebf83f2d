"""A bench whose flex sensor does not read 0° at rest is not armed."""

import math

import pytest

from benchlab.bench import Bench, Line
from benchlab.devices.interface import Reading, Status
from benchlab.errors import BenchError
from benchlab.runner.clock import VirtualClock
from benchlab.workflows.bench_straight import check_straight

BENCH = Bench("left", flex=Line(66.667, -66.667), calibrated=True)


class Vented:
    """Its flex sensor reads these volts, then those of the second time."""

    def __init__(self, volts: float, later_V: float | None = None, later_s: float = 1.0) -> None:
        self.volts, self.later_V, self.later_s = volts, later_V, later_s
        self.asked: list[float] = []

    def exchange(self, time_s: float, pressure_MPa: float, trigger: bool = False) -> Reading:
        self.asked.append(pressure_MPa)
        late = self.later_V is not None and time_s > self.later_s
        return Reading(math.nan, self.later_V if late else self.volts, 0, time_s, Status(0), math.nan)


@pytest.mark.parametrize("volts", [1.0, 1.1, 0.9, math.nan])
def test_a_straight_actuator_or_one_without_a_number_is_let_pass(volts: float) -> None:
    device = Vented(volts)
    check_straight(device, BENCH, VirtualClock(), 10.0)
    assert set(device.asked) == {0.0}


def test_a_wrong_offset_is_told_before_arming() -> None:
    wrong = Bench("left", flex=Line(66.667, 66.667), calibrated=True)
    with pytest.raises(BenchError, match=r"reads 133\.3°, more than 10° from straight.*offset_deg"):
        check_straight(Vented(1.0), wrong, VirtualClock(), 10.0)
    with pytest.raises(BenchError, match=r"reads −33\.3°"):
        check_straight(Vented(0.5), BENCH, VirtualClock(), 10.0)
    check_straight(Vented(0.5), BENCH, VirtualClock(), 40.0)
    check_straight(Vented(0.5), BENCH, VirtualClock(), math.inf)


def test_an_actuator_that_is_emptying_is_waited_for() -> None:
    clock = VirtualClock()
    check_straight(Vented(2.0, later_V=1.0), BENCH, clock, 10.0)
    assert 1.0 < clock.now_s() < 2.0
    with pytest.raises(BenchError):
        check_straight(Vented(2.0, later_V=1.0, later_s=9.0), BENCH, VirtualClock(), 10.0)


def test_without_a_flex_line_nothing_is_asked() -> None:
    device = Vented(5.0)
    check_straight(device, Bench("left", calibrated=True), VirtualClock(), 10.0)
    assert not device.asked
