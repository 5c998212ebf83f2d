"""Clocks: what they promise to the loop."""

import time

import pytest

from benchlab.runner.clock import RealClock, VirtualClock


def test_the_real_clock_is_not_early_and_the_past_does_not_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    slept: list[float] = []
    sleep = time.sleep

    def counted(seconds: float) -> None:
        slept.append(seconds)
        sleep(seconds)

    monkeypatch.setattr(time, "sleep", counted)
    clock = RealClock()
    clock.start()
    began = time.perf_counter()
    for deadline in (0.005, 0.0055, 0.02):
        clock.wait_until(deadline)
        assert clock.now_s() >= deadline
    assert time.perf_counter() - began > 0.0195 and 0 < sum(slept) < 0.02
    slept.clear()
    clock.wait_until(0.001)
    assert not slept


def test_the_real_clock_does_not_follow_the_clock_on_the_wall(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = RealClock()
    clock.start()
    monkeypatch.setattr(time, "time", lambda: 4e9)
    assert clock.now_s() < 1000


def test_the_virtual_clock_never_goes_back() -> None:
    clock = VirtualClock()
    clock.wait_until(3.0)
    clock.wait_until(1.0)
    assert clock.now_s() == 3.0
    clock.start()
    assert clock.now_s() == 0.0
