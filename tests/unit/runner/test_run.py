"""The loop: what is asked at which tick, and what comes first at every end."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from benchlab.devices.interface import Fault, LostError, Status
from benchlab.errors import BenchError, InputError
from benchlab.io.journal import SAMPLE
from benchlab.protocol.plan import PlanEvent
from benchlab.runner.guards.limits import Limits
from tests.unit.runner.fakes import BENCH, BusyClock, FakeDevice, FakeJournal, plan_of, ramp, run


def test_each_tick_of_the_plan_is_asked_once_at_its_time_and_written() -> None:
    pressure = ramp()
    end, device, journal = run(pressure)
    assert (end.reason, end.vented, end.exit_code, end.ticks) == ("completed", True, 0, len(pressure))
    assert [p for _, p, _ in device.asked] == pressure.tolist()
    assert np.allclose([t for t, _, _ in device.asked], np.arange(len(pressure)) / 100)
    assert [s[0] for s in journal.samples] == list(range(len(pressure)))
    assert device.calls[0] == "arm" and device.calls[-3:] == ["vent", "vented", "stop"]
    assert journal.events[-1] == ("stop", end.record())
    last = journal.samples[-1]
    assert len(last) == len(SAMPLE.names or ())
    assert last[5] == 0.3 and last[6] == pytest.approx(BENCH.volts(BENCH.code(0.3))) and last[7] == BENCH.code(0.3)
    assert last[10] == pytest.approx(90.0, abs=0.1) and math.isnan(last[11])


def test_marks_and_triggers_come_at_the_first_tick_at_or_after_their_time() -> None:
    events = (PlanEvent(0.5, "trigger"), PlanEvent(0.501, "mark", "loose"), PlanEvent(9.0, "mark", "after the end"))
    _, device, journal = run(plan=plan_of(ramp(), events=events))
    assert [i for i, (_, _, trigger) in enumerate(device.asked) if trigger] == [50]
    told = [(kind, c["tick"], c["text"]) for kind, c in journal.events if kind not in ("vent", "stop")]
    assert told == [("trigger", 50, ""), ("mark", 51, "loose"), ("mark", 299, "after the end")]


def test_late_ticks_are_all_done_and_say_how_late_they_are() -> None:
    stall = BusyClock(lambda t: 0.1 if 1.0 <= t < 1.01 else 0.0)
    end, device, journal = run(clock=stall)
    assert end.reason == "completed" and end.ticks == len(device.asked) == 300
    late = np.array([s[3] for s in journal.samples])
    assert (
        late.max() == pytest.approx(0.1, abs=1e-6) and (late > 1e-6).sum() == 10
    )  # 100 ms are ten ticks, caught up at once
    assert end.late_ms is not None and end.late_ms["max"] == pytest.approx(100.0) and end.late_ms["p50"] < 1e-6


def test_too_late_is_not_sent_any_more() -> None:
    asleep = BusyClock(lambda t: 4.0 if 1.0 <= t < 1.01 else 0.0)
    end, device, _ = run(clock=asleep)
    assert end.reason == "overrun" and "4 s after its deadline, more than 0.25 s" in end.cause.words
    assert end.exit_code == 5 and end.vented and len(device.asked) == end.ticks == 100


def test_a_slow_bench_overruns_and_is_not_skipped() -> None:
    clock = BusyClock(lambda t: 0.0)

    def slow(n: int, fields: dict[str, Any]) -> None:
        clock.now += 0.012

    end, _, journal = run(
        device=FakeDevice(slow), clock=clock, plan=plan_of(np.zeros(600)), limits=Limits(late_s=0.2499)
    )
    assert end.reason == "overrun"
    assert [s[0] for s in journal.samples] == list(range(125))  # 2 ms behind a tick: 250 ms after 125 of them


ERRORS = [
    (LostError("no answer for 0.5 s"), "lost", 5),
    (BenchError("the device refuses"), "refused", 5),
    (RuntimeError("wrong"), "bug", 1),
    (KeyboardInterrupt(), "interrupted", 130),
]


@pytest.mark.parametrize(("error", "reason", "code"), ERRORS, ids=[e[1] for e in ERRORS])
def test_whatever_is_raised_the_vent_comes_before_the_record(error: BaseException, reason: str, code: int) -> None:
    def fail(n: int, fields: dict[str, Any]) -> None:
        if n == 120:
            raise error

    end, device, journal = run(device=FakeDevice(fail))
    assert (end.reason, end.exit_code, end.ticks, end.vented) == (reason, code, 120, True)
    assert device.calls[-4:] == ["exchange", "vent", "vented", "stop"]
    assert journal.events[-1][1]["words"] == end.cause.words and end.cause.error is error


def test_a_device_that_does_not_arm_is_vented_and_never_asked() -> None:
    device = FakeDevice()

    def refuse() -> None:
        raise BenchError("not now")

    device.arm = refuse
    end, device, _ = run(device=device)
    assert (
        end.reason == "refused"
        and device.asked == []
        and device.calls == ["vent", "vented", "stop"]
        and end.late_ms is None
    )


def test_a_full_disk_vents_and_says_so() -> None:
    device = FakeDevice()
    journal = FakeJournal(device.calls)

    def full(*values: Any) -> None:
        if len(journal.samples) == 100:
            raise InputError("could not be written: no space left on device", file="a.journal")
        journal.samples.append(values)

    journal.sample = full
    end, device, _ = run(device=device, journal=journal)
    assert (end.reason, end.exit_code, end.vented) == ("journal", 3, True)
    assert "no space left" in end.cause.words and device.calls[-2:] == ["exchange", "vent"]
    assert end.ticks == 101 and len(journal.samples) == 100


def test_a_disk_that_is_full_at_the_stop_record_leaves_the_cause_and_says_the_trouble() -> None:
    journal = FakeJournal()

    def full(*_: Any, **__: Any) -> None:
        raise InputError("no space left", file="a.journal")

    journal.event = full
    end, _, _ = run(journal=journal)
    assert end.reason == "completed" and "no space left" in end.trouble


def test_above_the_limit_nothing_is_sent() -> None:
    pressure = ramp()
    pressure[200:] = 0.3501
    end, device, _ = run(pressure)
    assert end.reason == "limit" and end.exit_code == 5
    assert len(device.asked) == 200 and max(p for _, p, _ in device.asked) <= 0.35
    end, device, _ = run(plan=plan_of(ramp(), limit_MPa=0.2))
    assert end.reason == "limit" and max(p for _, p, _ in device.asked) <= 0.2


@pytest.mark.parametrize("wrong", [math.nan, -0.01, math.inf])
def test_a_controller_that_asks_nonsense_is_a_stop(wrong: float) -> None:
    class Mad:
        lead_s = 0.0

        def start(self, pressure_MPa: float) -> None: ...

        def pressure_MPa(self, reference_deg: float, ahead_deg: float, angle_deg: float, dt_s: float) -> float:
            return wrong

    pressure, reference = ramp(), np.full(300, np.nan)
    pressure[250:], reference[250:] = np.nan, 90.0
    end, device, _ = run(plan=plan_of(pressure, reference_deg=reference), controller=Mad())
    assert end.reason == "limit" and len(device.asked) == 250


def test_the_controller_starts_at_the_last_pressure_and_sees_reference_and_what_lies_ahead() -> None:
    class Spy:
        lead_s = 0.05

        def __init__(self) -> None:
            self.starts: list[float] = []
            self.seen: list[tuple[float, float, float, float]] = []

        def start(self, pressure_MPa: float) -> None:
            self.starts.append(pressure_MPa)

        def pressure_MPa(self, *seen: float) -> float:
            self.seen.append(seen)
            return 0.2

    pressure, reference = ramp(), np.full(300, np.nan)
    pressure[200:280], reference[200:280] = np.nan, np.linspace(60, 99.5, 80)
    pressure[280:] = 0.0
    spy = Spy()
    end, device, journal = run(plan=plan_of(pressure, reference_deg=reference), controller=spy)
    assert end.reason == "completed" and spy.starts == [0.3] and len(spy.seen) == 80
    first, last = spy.seen[0], spy.seen[-1]
    assert first == (60.0, pytest.approx(62.5), pytest.approx(90.0, abs=0.1), 0.01)
    assert last[:2] == (99.5, 99.5) and last[2] == pytest.approx(60.0, abs=0.1)
    assert [p for _, p, _ in device.asked[200:280]] == [0.2] * 80 and journal.samples[210][11] == reference[210]


def test_an_open_pressure_without_a_controller_is_a_bug_that_vents() -> None:
    end, _, _ = run(plan=plan_of(np.full(10, np.nan), reference_deg=np.full(10, 5.0)))
    assert end.reason == "bug" and end.vented


def test_a_vent_is_tried_again_and_one_that_nobody_confirms_is_told() -> None:
    end, device, _ = run(device=FakeDevice(vent_fails=2))
    assert end.vented and device.calls.count("vent") == 3 and end.exit_code == 0
    end, device, journal = run(device=FakeDevice(vent_fails=99))
    assert not end.vented and end.exit_code == 5 and "nobody answers" in end.vent_words
    assert journal.events[-1][1]["vented"] is False


def test_faults_are_written_each_and_counted() -> None:
    device = FakeDevice()

    def fault(n: int, fields: dict[str, Any]) -> None:
        if n == 50:
            device.pending.append(Fault("bad CRC, dropped", 2))

    device.change = fault
    end, _, journal = run(device=device)
    assert end.reason == "completed" and end.faults == 2
    assert [c for k, c in journal.events if k == "fault"] == [
        {"cause": "bad CRC, dropped", "count": 2, "time_s": pytest.approx(0.5)}
    ]


def test_the_sample_that_stopped_the_run_is_written_after_the_vent() -> None:
    def reboot(n: int, fields: dict[str, Any]) -> None:
        if n == 70:
            fields["status"] = Status.REBOOTED

    end, device, journal = run(device=FakeDevice(reboot))
    assert end.reason == "rebooted" and end.ticks == 71 == len(journal.samples)
    assert device.calls[-5:] == ["exchange", "vent", "sample", "vented", "stop"]
