"""A bench that is not empty, or whose supply has risen since its calibration, is not armed."""

import pytest

from benchlab.bench import Bench, Line
from benchlab.devices.interface import Reading, Status
from benchlab.errors import BenchError
from benchlab.runner.clock import VirtualClock
from benchlab.workflows.bench_zero import check_zero

BENCH = Bench("left", monitor=Line(0.12, -0.12), supply_V=4.9, calibrated=True)


class Vented:
    """Holds a pressure that goes down with a time constant, on some supply."""

    def __init__(self, supply_V: float = 4.9, pressure_MPa: float = 0.0, half_s: float = 0.0) -> None:
        self.supply_V, self.pressure_MPa, self.half_s = supply_V, pressure_MPa, half_s
        self.asked: list[float] = []

    def exchange(self, time_s: float, pressure_MPa: float, trigger: bool = False) -> Reading:
        self.asked.append(pressure_MPa)
        now = self.pressure_MPa * (0.5 ** (time_s / self.half_s) if self.half_s else 1.0)
        assert BENCH.monitor is not None
        volts = BENCH.monitor.inverse(now) * BENCH.supply_V / self.supply_V
        return Reading(BENCH.monitor.of(volts), 1.0, 0, time_s, Status(0), volts)


@pytest.mark.parametrize("supply_V", [4.6, 4.9, 5.0])
def test_an_empty_bench_on_its_supply_or_a_lower_one_is_let_pass(supply_V: float) -> None:
    device = Vented(supply_V)
    check_zero(device, BENCH, VirtualClock())
    assert set(device.asked) == {0.0}


def test_a_higher_supply_is_told_with_how_much_too_much_it_gives() -> None:
    with pytest.raises(BenchError, match=r"supply were 5\.25 V, and each pressure 7 % above"):
        check_zero(Vented(5.25), BENCH, VirtualClock())


def test_a_bench_that_is_emptying_is_waited_for_and_one_that_stays_full_is_told() -> None:
    check_zero(Vented(pressure_MPa=0.3, half_s=0.5), BENCH, VirtualClock())
    with pytest.raises(BenchError, match=r"shows 50\.0 kPa after 5 s"):
        check_zero(Vented(pressure_MPa=0.05), BENCH, VirtualClock())


def test_a_monitor_that_is_not_wired_is_told_from_a_supply() -> None:
    with pytest.raises(BenchError, match=r"reads 0\.490 V.*no supply explains"):
        check_zero(Vented(10.0), BENCH, VirtualClock())


def test_without_a_monitor_nothing_is_asked() -> None:
    device = Vented()
    check_zero(device, Bench("left", calibrated=True), VirtualClock())
    assert not device.asked
