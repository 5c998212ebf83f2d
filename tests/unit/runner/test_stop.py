"""What comes from outside: signals, keys, pauses. None comes between the loop and its vent."""

from __future__ import annotations

import math
import signal
from typing import Any

import numpy as np
import pytest

from benchlab.control.pi import PI
from benchlab.runner.stop import QUIT, SIGNALS, Stop
from tests.unit.runner.fakes import FakeDevice, plan_of, ramp, run


@pytest.mark.parametrize("name", SIGNALS)
def test_a_signal_ends_the_run_between_ticks_and_a_second_one_changes_nothing(name: str) -> None:
    stop = Stop()

    def at(tick: Any) -> None:
        if tick.index >= 40:
            stop.on_signal(getattr(signal, name), None)

    end, _, _ = run(stop=stop, on_tick=at)
    assert (end.reason, end.exit_code, end.ticks, end.vented) == (SIGNALS[name].reason, 130, 41, True)
    stop._asked_at -= 5
    stop.on_signal(signal.SIGINT, None)  # while it vents, and after
    assert stop.cause == SIGNALS[name]


def test_a_second_interrupt_gets_through_to_a_loop_that_hangs_and_still_vents() -> None:
    stop = Stop()

    def hang(n: int, fields: dict[str, Any]) -> None:
        if n == 30:
            stop.on_signal(signal.SIGINT, None)
            stop._asked_at -= 2  # two seconds later, nothing has happened
            stop.on_signal(signal.SIGINT, None)

    end, _, _ = run(device=FakeDevice(hang), stop=stop)
    assert end.reason == "interrupted" and end.vented and end.ticks == 30
    stop.on_signal(signal.SIGINT, None)  # a third one is without effect


def test_the_key_q_stops_too() -> None:
    stop = Stop()
    end, _, _ = run(stop=stop, on_tick=lambda tick: stop.ask(QUIT) if tick.index == 3 else None)
    assert end.reason == "quit" and end.exit_code == 130 and end.ticks == 4


def test_in_a_pause_the_pressure_holds_and_the_plan_stands_still() -> None:
    stop = Stop()

    def pause(tick: Any) -> None:
        if (tick.index == 100 and not tick.held) or (tick.held and tick.time_s > 3.0):
            stop.toggle_pause()

    pressure = ramp()
    end, device, journal = run(pressure, stop=stop, on_tick=pause)
    assert end.reason == "completed" and end.ticks == 300 and end.paused_s == pytest.approx(2.0, abs=0.03)
    held = [s for s in journal.samples if s[0] == 100]
    assert len(held) == pytest.approx(201, abs=2) and {s[5] for s in held} == {pressure[100]}
    assert [p for _, p, _ in device.asked][-199:] == pressure[101:].tolist()
    assert journal.kinds() == ["pause", "resume", "vent", "stop"]
    assert np.allclose(np.diff([t for t, _, _ in device.asked]), 0.01, atol=1e-6)  # kept alive throughout


def test_a_pause_ends_in_a_vent_after_its_limit() -> None:
    stop = Stop()
    end, _, _ = run(stop=stop, pause_limit_s=1.5, on_tick=lambda t: t.index == 10 and setattr(stop, "paused", True))
    assert (end.reason, end.exit_code, end.ticks) == ("pause", 5, 11)
    assert end.vented and end.paused_s == pytest.approx(1.5, abs=0.02)


def test_in_virtual_time_nothing_is_paused() -> None:
    stop = Stop(pausable=False)
    end, _, journal = run(stop=stop, on_tick=lambda tick: stop.toggle_pause() if tick.index == 10 else None)
    assert end.reason == "completed" and journal.kinds() == ["vent", "stop"]


def test_a_wish_to_pause_before_the_first_tick_counts_after_it() -> None:
    stop = Stop()
    stop.toggle_pause()
    end, device, _ = run(stop=stop, pause_limit_s=0.5)
    assert end.reason == "pause" and end.ticks == 1 and len(device.asked) == 51


def test_a_wish_to_stop_counts_in_a_pause() -> None:
    stop = Stop()

    def wish(tick: Any) -> None:
        stop.paused = stop.paused or tick.index == 10
        if tick.held and tick.time_s > 0.5:
            stop.ask(QUIT)

    end, _, _ = run(stop=stop, on_tick=wish)
    assert end.reason == "quit" and end.paused_s > 0.3


def test_a_controller_is_told_of_a_missing_angle() -> None:
    """So that it can hold the pressure; the angle of long ago is no measurement."""

    def lose(n: int, fields: dict[str, Any]) -> None:
        if 250 <= n < 253:
            fields["flex_V"] = math.nan

    pressure, reference = ramp(), np.full(300, np.nan)
    pressure[200:], reference[200:] = np.nan, 90.0
    end, device, _ = run(
        plan=plan_of(pressure, reference_deg=reference), device=FakeDevice(lose), controller=PI(1e-4, 1e-2, 0.35)
    )
    asked = [p for _, p, _ in device.asked]
    assert end.reason == "completed" and asked[251] == asked[252] == asked[253] == asked[250] != asked[254]


def test_while_files_are_written_a_wish_says_enough_and_one_much_later_gets_through() -> None:
    stop = Stop()
    end, _, _ = run(stop=stop)
    stop.write()
    stop.on_signal(signal.SIGINT, None)
    stop.on_signal(signal.SIGINT, None)
    assert end.reason == "completed" and stop.enough and stop.cause is None
    stop._asked_at -= 2
    with pytest.raises(KeyboardInterrupt):
        stop.on_signal(signal.SIGINT, None)


def test_no_signal_gets_through_between_the_vent_and_the_files() -> None:
    stop = Stop()

    def shout(n: int, fields: dict[str, Any]) -> None:
        stop.on_signal(signal.SIGINT, None)
        stop._asked_at -= 5

    end, device, _ = run(stop=stop, device=FakeDevice(after_vent=shout))
    assert end.vented and end.reason == "completed" and len(device.watched) == 1
