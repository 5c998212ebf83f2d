"""The guards of the angle at rest and of a loop that swings: what they stop, when, with which words, and what they let pass."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from benchlab.devices.interface import Reading, Status
from benchlab.runner.clock import VirtualClock
from benchlab.runner.end import RunEnd
from benchlab.runner.guards.limits import Limits
from benchlab.runner.guards.rest import RestGuard
from benchlab.runner.guards.swing import SwingGuard, Turns
from benchlab.runner.run import execute
from benchlab.runner.tick import Tick
from tests.unit.runner.fakes import BENCH, FakeDevice, FakeJournal, plan_of, ramp


def run(offset_deg: float, pressure: np.ndarray, limits: Limits | None = None) -> tuple[RunEnd, FakeDevice]:
    """On a bench file whose flex line is off by so much."""
    assert BENCH.flex is not None
    bench = replace(BENCH, flex=replace(BENCH.flex, offset=BENCH.flex.offset + offset_deg))
    device = FakeDevice()
    return execute(plan_of(pressure), device, bench, FakeJournal(), VirtualClock(), limits=limits), device


@pytest.mark.parametrize("offset_deg", [200.0, -11.0, 10.5])
def test_a_wrong_offset_is_seen_before_any_pressure(offset_deg: float) -> None:
    end, device = run(offset_deg, ramp())
    assert end.reason == "sensor" and end.exit_code == 5 and end.ticks == 5
    assert f"the flex sensor reads {offset_deg:.1f}°".replace("-", "−") in end.cause.words
    assert "offset_deg" in end.cause.words
    assert all(pressure == 0 for _, pressure, _ in device.asked)


def test_a_run_that_asks_for_pressure_at_once_is_looked_at_by_its_first_tick() -> None:
    def tick(angle: float, command: float) -> Tick:
        return Tick(0, 0.0, 0.0, command, Reading(0.0, 1.0, 0, 0.0, Status.ARMED), 0, angle)

    cause = RestGuard(Limits()).check(tick(60.0, 0.3))
    assert cause is not None and cause.reason == "sensor"
    healthy = RestGuard(Limits())
    assert healthy.check(tick(0.5, 0.3)) is None and healthy.check(tick(60.0, 0.3)) is None


def test_a_little_off_one_bad_value_and_a_limit_that_is_off_are_let_pass() -> None:
    assert run(9.0, ramp())[0].reason == "completed"
    assert run(-60.0, ramp(), Limits(rest_deg=math.inf))[0].reason == "completed"
    guard = RestGuard(Limits())
    for index, angle in enumerate((80.0, 0.1, math.nan, -0.1, 0.2, 0.0)):
        tick = Tick(index, 0.01 * index, 0.0, 0.0, Reading(0.0, 1.0, 0, 0.0, Status.ARMED), 0, angle)
        assert guard.check(tick) is None


def test_turns_are_those_of_a_zigzag() -> None:
    turns = Turns()
    values = [0.0, 1.0, 2.0, 1.8, 2.1, 0.5, 0.2, 0.6, 0.1, 1.5, 1.4, 0.0]
    assert [turns.turned(value, 1.0) for value in values] == [i in (5, 9, 11) for i in range(12)]


def swings(pressure: np.ndarray, reference: np.ndarray, limits: Limits | None = None) -> tuple[int, str] | None:
    """The tick at 100 Hz at which the guard stops, and its reason."""
    guard = SwingGuard(limits or Limits())
    for index, (p, r) in enumerate(zip(pressure.tolist(), reference.tolist(), strict=True)):
        tick = Tick(index, index * 0.01, 0.0, p, Reading(p, 1.0, 0, 0.0, Status.ARMED), 0, 0.0, r)
        if cause := guard.check(tick):
            assert "the loop oscillates" in cause.words and "control tune" in cause.words
            return index, cause.reason
    return None


TIME = np.arange(0, 40, 0.01)
HELD = np.full(len(TIME), 60.0)


def test_bang_bang_between_the_limits_is_stopped_after_four_swings() -> None:
    for frequency in (0.5, 2.0, 5.0):
        bang = 0.35 * (np.sin(2 * np.pi * frequency * TIME) > 0)
        found = swings(bang, HELD)
        assert found is not None and found[1] == "oscillating"
        assert found[0] * 0.01 < 5.5 / frequency
    assert swings(bang, HELD, Limits(swings=math.inf)) is None
    assert swings(bang, np.full(len(TIME), np.nan)) is None  # in open loop it is the protocol's


def test_smaller_swings_about_a_pressure_are_stopped_and_a_wiggle_is_not() -> None:
    sine = np.sin(2 * np.pi * 2.0 * TIME)
    assert swings(0.1 + 0.02 * sine, HELD) is not None
    assert swings(0.1 + 0.01 * sine, HELD) is None
    assert swings(0.3 + 0.02 * sine, HELD) is None


def test_what_a_reference_asks_for_is_no_oscillation() -> None:
    for frequency in (0.2, 1.0, 3.0):
        wave = np.sin(2 * np.pi * frequency * TIME)
        assert swings(0.17 + 0.17 * wave, 60 + 50 * wave) is None
    square = np.sign(np.sin(2 * np.pi * 1.0 * TIME))
    overshoot = np.sin(2 * np.pi * 1.0 * TIME) ** 8
    assert swings(0.15 + square * (0.05 + 0.08 * overshoot), 60 + 30 * square) is None


def test_a_loop_that_swings_faster_than_its_reference_is_stopped() -> None:
    fast = np.sin(2 * np.pi * 4 * TIME) > 0
    assert swings(0.35 * fast, 60 + 50 * np.sin(2 * np.pi * 0.5 * TIME)) is not None
