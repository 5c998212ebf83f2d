"""After the vent: what is asked, what is seen, what becomes of it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from benchlab.devices.interface import LostError, Status
from benchlab.errors import InputError
from benchlab.runner.clock import VirtualClock
from benchlab.runner.guards.limits import Limits
from benchlab.runner.run import execute
from benchlab.runner.stop import QUIT, Stop
from tests.unit.runner.fakes import BENCH, FakeDevice, FakeJournal, plan_of, ramp, run

Fields = dict[str, Any]


def locked(n: int, fields: Fields) -> None:
    """Air stays in the actuator: bent by 85°, and nothing at the regulator."""
    fields["flex_V"] = 1.85 + 1e-4 * math.sin(n)


def emptying(seconds: float) -> Any:
    """Monitor and angle go down in a straight line."""

    def change(n: int, fields: Fields) -> None:
        left = max(0.0, 1 - n / 100 / seconds)
        fields.update(pressure_MPa=0.3 * left, flex_V=1.0 + 0.9 * left)

    return change


def test_an_empty_bench_is_seen_so_in_a_tenth_of_a_second_and_the_samples_are_kept() -> None:
    end, device, journal = run()
    assert (end.reason, end.exit_code, end.emptied.empty) == ("completed", 0, True)
    assert end.emptied.watched_s == pytest.approx(0.1) and end.emptied.samples == 11 == len(journal.watched)
    assert {(p, trigger) for _, p, trigger in device.watched} == {(0.0, False)}
    assert np.allclose(np.diff([t for t, _, _ in device.watched]), 0.01)
    assert {s[0] for s in journal.watched} == {299} and {s[1] for s in journal.watched} == {
        1
    }  # after the plan's one step
    assert end.ticks == 300 == len(end.late_s) and end.time_s == pytest.approx(3.0)
    kinds = journal.kinds()
    assert kinds[-2:] == ["vent", "stop"]
    told = dict(journal.events)
    assert told["vent"]["confirmed"] and told["stop"]["empty"] is True and told["stop"]["samples_watched"] == 11


def test_a_bench_that_empties_slowly_is_waited_for_and_no_longer() -> None:
    end, _, _ = run(device=FakeDevice(after_vent=emptying(1.0)))
    assert end.emptied.empty is True and 1.05 < end.emptied.watched_s < 1.1  # 10 of 300 kPa after 0.97 s
    end, _, journal = run(device=FakeDevice(after_vent=emptying(6.0)))
    assert (end.reason, end.emptied.empty, end.exit_code) == ("not empty", False, 5)
    assert end.emptied.watched_s == pytest.approx(3.0, abs=0.02) and len(journal.watched) == 301
    end, _, _ = run(device=FakeDevice(after_vent=emptying(6.0)), limits=Limits(empty_s=7.0))
    assert end.emptied.empty is True


def test_air_that_is_locked_in_is_a_failure_of_a_run_that_was_completed_or_ended_by_somebody() -> None:
    end, _, _ = run(device=FakeDevice(after_vent=locked))
    assert (end.reason, end.completed, end.vented, end.emptied.empty, end.exit_code) == (
        "not empty",
        False,
        True,
        False,
        5,
    )
    assert "3.0 s after the vent the monitor shows 0.0 kPa, 85.0° of 90.0° are left" in end.cause.words
    stop = Stop()
    end, _, _ = run(
        device=FakeDevice(after_vent=locked),
        stop=stop,
        on_tick=lambda t: t.index == 250 and not stop.over and stop.ask(QUIT),
    )
    assert (end.reason, end.exit_code) == ("not empty", 5) and end.cause.words.startswith(
        "stopped with the key q, and "
    )


def test_a_guards_stop_stays_the_cause() -> None:
    def reboot(n: int, fields: Fields) -> None:
        fields["status"] = Status.REBOOTED if n == 250 else fields["status"]

    end, _, _ = run(device=FakeDevice(reboot, after_vent=locked))
    assert (end.reason, end.emptied.empty, end.exit_code) == ("rebooted", False, 5)


def test_what_no_sensor_shows_is_not_claimed() -> None:
    def watched(bench: Any) -> Any:
        def blind(n: int, fields: Fields) -> None:
            fields["pressure_MPa"] = math.nan if bench.monitor is None else fields["pressure_MPa"]

        device = FakeDevice(blind, after_vent=lambda n, f: (locked(n, f), blind(n, f)))
        return execute(plan_of(ramp()), device, bench, FakeJournal(), VirtualClock(), guards=[])

    nothing = watched(replace(BENCH, monitor=None, flex=None))
    assert (nothing.emptied.empty, nothing.emptied.words, nothing.exit_code) == (None, "no sensor shows it", 0)
    assert nothing.emptied.watched_s < 0.2
    assert watched(replace(BENCH, flex=None)).emptied.words == "the monitor shows 0.0 kPa, the angle tells nothing"
    assert watched(replace(BENCH, monitor=None)).emptied.empty is False


def test_a_sensor_that_stopped_the_run_is_not_believed_after_it() -> None:
    def stuck(n: int, fields: Fields) -> None:
        fields["flex_V"] = 1.8 if n > 90 else fields["flex_V"]

    end, _, _ = run(device=FakeDevice(stuck, after_vent=lambda n, f: f.update(flex_V=1.8)))
    assert end.cause.sensor == "flex sensor" and end.emptied.empty is True
    assert end.emptied.words.endswith("the angle tells nothing")


def test_a_dac_that_is_not_at_0_and_a_latch_that_is_open_are_not_empty() -> None:
    for fields, words in (({"code": 5}, "the DAC's code is 5"), ({"status": Status.ARMED}, "the device is armed")):
        end, _, _ = run(device=FakeDevice(after_vent=lambda n, f, fields=fields: f.update(fields)))
        assert (end.emptied.empty, end.exit_code) == (False, 5) and words in end.emptied.words


def test_a_wish_after_the_vent_ends_the_watching_and_nothing_else() -> None:
    stop = Stop()
    device = FakeDevice(after_vent=lambda n, f: (locked(n, f), stop.ask(QUIT) if n == 40 else None))
    end, device, _ = run(device=device, stop=stop)
    assert (end.reason, end.exit_code, end.vented, end.emptied.empty) == ("completed", 0, True, None)
    assert "the watching was ended after 0.4 s" in end.emptied.words and len(device.watched) == 41


def test_a_lost_bench_is_not_watched_and_one_that_is_lost_then_is_told() -> None:
    end, device, _ = run(device=FakeDevice(vent_fails=99))
    assert device.watched == [] and (end.emptied.empty, end.emptied.words) == (None, "nobody confirmed the vent")

    def pulled(n: int, fields: Fields) -> None:
        raise LostError("no answer for 0.5 s")

    end, _, _ = run(device=FakeDevice(after_vent=pulled))
    assert (end.reason, end.vented, end.emptied.empty) == ("completed", True, None)
    assert "it could not be watched: no answer for 0.5 s" in end.emptied.words


def test_a_full_disk_does_not_end_the_watching() -> None:
    journal = FakeJournal()
    kept = journal.sample

    def full(*values: Any) -> None:
        if len(journal.watched) == 5:
            raise InputError("no space left", file="a.journal")
        kept(*values)

    journal.sample = full
    end, _, _ = run(device=FakeDevice(after_vent=emptying(1.0)), journal=journal)
    assert end.reason == "completed" and end.emptied.empty is True and end.emptied.samples > 50
    assert len(journal.watched) == 5 and "no space left" in end.trouble


def test_it_may_be_switched_off() -> None:
    end, device, _ = run(limits=Limits(empty_s=math.inf))
    assert device.watched == [] and end.emptied.empty is None and end.exit_code == 0
