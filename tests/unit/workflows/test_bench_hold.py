"""A bench is held, spoken to all the time, and vented at every end of the holding."""

import math
import os
import signal
import time
from collections.abc import Callable
from typing import Any

import pytest

from benchlab.bench import Bench
from benchlab.devices.interface import LostError, Reading, Status
from benchlab.errors import BenchError
from benchlab.workflows.bench_hold import ThreadHold, VirtualHold
from tests.unit.workflows.small_bench import SILENCE_S, Metronome, SmallBench

FAST = {"period_s": 0.005, "rise_MPa_per_s": 5.0}


def small(**changes) -> SmallBench:
    return SmallBench(Bench("new"), **changes)


def until(so: Callable[[], Any]) -> None:
    """Wait until it is so."""
    end = time.monotonic() + 60
    while not so():
        assert time.monotonic() < end
        time.sleep(0.005)


def test_it_is_never_silent_while_the_caller_waits() -> None:
    with Metronome() as metronome:
        device = small(clock_s=metronome.now_s)
        with ThreadHold(device) as hold:
            hold.stand(0.02, 0.01)
            began_s = metronome.now_s()
            until(lambda: metronome.now_s() > began_s + 2 * SILENCE_S)  # somebody reads a gauge
            assert device.armed and device.pressure_MPa > 0
            hold.check()
    assert device.longest_silence_s < SILENCE_S
    assert not device.armed and device.vents == 1


def test_a_level_is_gone_to_slowly_and_its_readings_are_of_the_end() -> None:
    device = small()
    with ThreadHold(device, 0.005, 0.5) as hold:
        began = time.monotonic()
        readings = hold.stand(0.1, 0.06)
        assert time.monotonic() - began >= 0.2 + 0.06 - 0.01
        assert {r.code for r in readings} == {Bench("new").code(0.1)}


@pytest.mark.parametrize("hold", [ThreadHold, VirtualHold])
def test_whatever_is_raised_inside_it_vents_and_lets_it_through(hold) -> None:
    device = small()
    with pytest.raises(KeyboardInterrupt), hold(device, **FAST) as held:
        held.stand(0.05, 0.01)
        assert device.pressure_MPa > 0
        raise KeyboardInterrupt
    assert not device.armed and device.code == 0


def test_the_thread_vents_so_that_no_signal_can_interrupt_it() -> None:
    device = small()
    with ThreadHold(device, **FAST) as hold:
        hold.stand(0.05, 0.01)
    assert device.vented_by == ["benchlab holds the bench"]


@pytest.mark.parametrize("error", [LostError("pulled"), BenchError("refused"), ZeroDivisionError("a bug")])
def test_what_ends_the_thread_reaches_whoever_waits_and_it_is_vented(error: Exception) -> None:
    def before(n: int) -> None:
        if n == 20:
            raise error

    device = small(before=before)
    with pytest.raises(type(error)), ThreadHold(device, **FAST) as hold:
        hold.stand(0.05, 5.0)
    assert not device.armed and device.vents == 1


def test_an_error_of_the_thread_is_seen_at_the_end_too() -> None:
    def before(n: int) -> None:
        if n == 20:
            raise LostError("pulled")

    device = small(before=before)
    with pytest.raises(LostError), ThreadHold(device, **FAST):
        until(lambda: device.vents)


def test_a_bench_that_vented_itself_ends_the_holding() -> None:
    device = small()

    def before(n: int) -> None:
        if n == 20:
            device.armed = False

    device.before = before
    with pytest.raises(BenchError), ThreadHold(device, **FAST) as hold:
        hold.stand(0.05, 5.0)
    assert device.vents == 1


def test_more_ctrl_c_wait_for_the_vent() -> None:
    came: list[int] = []

    def interrupt(*_: object) -> None:
        came.append(1)
        raise KeyboardInterrupt

    class Interrupted(SmallBench):
        def vent(self) -> None:
            for count in (1, 2, 3):
                os.kill(os.getpid(), signal.SIGINT)
                until(lambda count=count: len(came) == count)
            time.sleep(0.05)
            super().vent()

    device = Interrupted(Bench("new"))
    before = signal.signal(signal.SIGINT, interrupt)
    try:
        with pytest.raises(KeyboardInterrupt), ThreadHold(device, **FAST) as hold:
            hold.stand(0.05, 0.01)
            raise KeyboardInterrupt
    finally:
        signal.signal(signal.SIGINT, before)
    assert device.vents == 1 and not device.armed and len(came) == 3


def test_whoever_has_gone_leaves_a_vented_bench() -> None:
    device = small()
    with pytest.raises(BenchError, match="nobody asked"), ThreadHold(device, **FAST, patience_s=0.3) as hold:
        hold.stand(0.05, 0.05)
        until(lambda: not device.armed)
        assert device.vents == 1
        hold.check()


def test_a_bench_that_refuses_to_arm_says_so() -> None:
    class Stubborn(SmallBench):
        def arm(self) -> None:
            raise BenchError("its DAC does not acknowledge")

    device = Stubborn(Bench("new"))
    with pytest.raises(BenchError, match="acknowledge"), ThreadHold(device):
        pass
    assert device.vents == 1


@pytest.mark.parametrize("hold", [ThreadHold, VirtualHold])
@pytest.mark.parametrize("status", [Status.SILENCE, Status.ARMED | Status.DAC_LOST, Status.REBOOTED])
def test_a_bench_that_says_that_it_is_not_armed_is_held_no_longer(hold, status: Status) -> None:
    class Says(SmallBench):
        def exchange(self, time_s: float, pressure_MPa: float, trigger: bool = False) -> Reading:
            return Reading(math.nan, 1.0, 0, time_s, status)

    device = Says(Bench("new"))
    with pytest.raises(BenchError, match="no longer armed"), hold(device, **FAST) as held:
        held.stand(0.05, 0.1)
    assert device.vents == 1


@pytest.mark.parametrize("hold", [ThreadHold, VirtualHold])
def test_a_vent_that_nobody_confirms_is_tried_again_and_then_told_with_what_to_do(hold) -> None:
    device = small(vent_fails=2)
    with hold(device, **FAST):
        pass
    assert device.vents == 3
    with pytest.raises(BenchError, match="NOT CONFIRMED VENTED") as told, hold(small(vent_fails=9), **FAST):
        pass
    assert "relief valve" in str(told.value)


def test_an_unconfirmed_vent_is_louder_than_what_came_before_it() -> None:
    with pytest.raises(BenchError, match="NOT CONFIRMED VENTED"), ThreadHold(small(vent_fails=9), **FAST):
        raise KeyboardInterrupt
