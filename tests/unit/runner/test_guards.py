"""Each guard: what it stops, when, with which words, and what it lets pass."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchlab.devices.interface import Fault, LostError, Status
from benchlab.errors import UsageError
from benchlab.runner.clock import VirtualClock
from benchlab.runner.end import RunEnd
from benchlab.runner.guards.choice import guards_of
from benchlab.runner.guards.limits import MOST, NEVER_OFF, UNSEEN, Limits
from benchlab.runner.run import execute
from tests.unit.runner.fakes import BENCH, DEG_PER_MPA, FakeDevice, FakeJournal, plan_of, ramp

Fields = dict[str, Any]


def run(
    change: Callable[[int, Fields], None],
    pressure: np.ndarray | None = None,
    bench: Any = BENCH,
    limits: Limits | None = None,
    guards: Any = None,
) -> RunEnd:
    plan = plan_of(ramp(6.0) if pressure is None else pressure)
    return execute(plan, FakeDevice(change), bench, FakeJournal(), VirtualClock(), guards=guards, limits=limits)


def lagging(lag_s: float, factor: float = 1.0) -> Callable[[int, Fields], None]:
    """A regulator that lags, and reaches only a part of what is asked for."""
    state = {"p": 0.0}

    def change(n: int, fields: Fields) -> None:
        state["p"] += (factor * fields["pressure_MPa"] - state["p"]) * -math.expm1(-0.01 / lag_s)
        wiggle = 1e-6 * math.sin(n)
        fields["pressure_MPa"] = state["p"] + wiggle
        fields["flex_V"] = 1.0 + DEG_PER_MPA * (state["p"] + wiggle) / 100

    return change


def setting(field: str, formula: Callable[[int, float], float]) -> Callable[[int, Fields], None]:
    """Falsify one field of every reading."""
    return lambda n, fields: fields.update({field: formula(n, fields[field])})


STEPS = np.repeat([0.0, 0.35, 0.0, 0.1, 0.3, 0.05, 0.35, 0.0], 200)


def test_a_healthy_bench_is_not_stopped_at_steps_over_the_whole_range() -> None:
    for lag_s in (0.02, 0.2, 0.5):
        assert run(lagging(lag_s), STEPS).reason == "completed", lag_s


@pytest.mark.parametrize(("short_MPa", "after_s"), [(0.012, 2.0), (0.06, 0.5)])
def test_pressure_below_set_is_a_leak(short_MPa: float, after_s: float) -> None:
    def leak(n: int, fields: Fields) -> None:
        if n >= 600:
            fields["pressure_MPa"] -= short_MPa

    end = run(leak, ramp(9.0))
    assert end.reason == "not following" and end.exit_code == 5
    assert end.time_s == pytest.approx(6.0 + after_s, abs=0.03)
    assert f"pressure {1e3 * short_MPa:.0f} kPa below set for {after_s:g} s: leak, burst or tube off" in end.cause.words


def test_a_small_leak_and_a_short_one_are_let_pass() -> None:
    assert run(setting("pressure_MPa", lambda n, p: p - 0.008)).reason == "completed"
    assert run(setting("pressure_MPa", lambda n, p: p - 0.03 * (200 <= n < 380))).reason == "completed"


def test_noise_about_the_tolerance_does_not_hide_a_leak() -> None:
    rng = np.random.default_rng(3)
    noisy = setting("pressure_MPa", lambda n, p: p - (0.013 + rng.normal(0, 0.003)) * (n > 200))
    assert run(noisy, ramp(9.0)).reason == "not following"


def test_pressure_that_stays_after_venting_is_told_from_a_leak() -> None:
    pressure = np.concatenate([ramp(2.0), np.zeros(500)])
    blocked = setting("pressure_MPa", lambda n, p: max(p, 0.25 * (n > 150)))
    end = run(blocked, pressure)
    assert end.reason == "not following" and "above set" in end.cause.words and "exhaust blocked" in end.cause.words


def test_a_regulator_slower_than_said_is_stopped_and_one_said_to_be_slow_is_not() -> None:
    assert run(lagging(3.0), STEPS).reason == "not following"
    assert run(lagging(3.0), STEPS, limits=Limits(lag_s=3.0)).reason == "completed"


def test_pressure_over_the_limit_stops_at_once() -> None:
    end = run(lambda n, f: f.update(pressure_MPa=0.38 + 1e-5 * n) if n >= 200 else None, ramp(top_MPa=0.35))
    assert end.reason == "above limit" and end.time_s == pytest.approx(2.1, abs=0.02)
    assert "measured 0.382 MPa, above the limit of 0.35 MPa" in end.cause.words


NO_MONITOR = replace(BENCH, monitor=None)


def unbending(after: int, monitor: bool = False) -> Callable[[int, Fields], None]:
    def change(n: int, fields: Fields) -> None:
        if not monitor:
            fields["pressure_MPa"] = math.nan
        if n >= after:
            fields["flex_V"] = 1.0 + 1e-3 * math.sin(n)

    return change


@pytest.mark.parametrize("monitor", [True, False])
def test_a_burst_is_seen_by_the_angle(monitor: bool) -> None:
    end = run(unbending(300, monitor), bench=BENCH if monitor else NO_MONITOR)
    assert (
        end.reason == "not following"
        and "burst, tube off" in end.cause.words
        and "300 kPa asked for" in end.cause.words
    )
    assert end.time_s == pytest.approx(4.0, abs=0.05)


def test_a_tube_that_is_off_from_the_start_is_seen_in_the_ramp() -> None:
    end = run(unbending(0), bench=NO_MONITOR)
    assert end.reason == "not following" and end.time_s < 3.0


def test_air_that_stays_inside_after_venting_is_told() -> None:
    def shut(n: int, fields: Fields) -> None:
        if n >= 250:
            fields["flex_V"] = 1.9 + 1e-3 * math.sin(n)

    end = run(shut, np.concatenate([ramp(4.0), np.zeros(500)]))
    assert end.reason == "not following" and "nothing asked for since 2.3 s" in end.cause.words
    assert 5.5 < end.time_s < 7.0


def test_an_angle_that_creeps_back_slowly_is_let_pass() -> None:
    def slow(n: int, fields: Fields) -> None:
        if 400 <= n < 1200:
            fields["flex_V"] = 1.0 + 0.9 * (0.3 * math.exp(-(n - 400) / 1000)) + 1e-3 * math.sin(n)

    assert run(slow, np.concatenate([ramp(4.0), np.zeros(800), ramp(4.0)])).reason == "completed"


def test_an_offset_of_the_flex_sensor_is_no_bend() -> None:
    shifted = setting("flex_V", lambda n, volts: 1.6 + 1e-3 * math.sin(n))
    assert run(shifted, bench=NO_MONITOR, limits=Limits(rest_deg=math.inf)).reason == "not following"


def test_the_stiffest_actuator_of_the_paper_is_let_pass_and_a_curve_asks_for_more() -> None:
    def stiff(n: int, fields: Fields) -> None:
        fields["flex_V"] = 1.0 + (fields["flex_V"] - 1.0) * 7.8 / 0.35 / DEG_PER_MPA

    assert run(stiff, bench=NO_MONITOR).reason == "completed"
    curve = guards_of(NO_MONITOR, 100.0, expected_deg=lambda p: DEG_PER_MPA * p)
    end = run(stiff, bench=NO_MONITOR, guards=curve)
    assert end.reason == "not following" and " are the least" in end.cause.words and end.time_s < 2.5


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("pressure_MPa", math.nan, "the pressure sensor gives no number for 0.1 s"),
        ("pressure_MPa", -0.05, "the pressure sensor reads -0.05 MPa, outside -0.02 to 0.48 MPa,"),
        ("flex_V", math.nan, "the flex sensor gives no number"),
        (
            "flex_V",
            0.0,
            "the flex sensor reads 0 V, outside 0.02 to 4.98 V, for 0.1 s: look at the sensor and its wires",
        ),
        ("flex_V", 5.0, "the flex sensor reads 5 V"),
    ],
)
def test_a_sensor_that_cannot_be_is_stopped_within_its_time(field: str, value: float, words: str) -> None:
    end = run(lambda n, f: f.update({field: value}) if n >= 200 else None)
    assert end.reason == "sensor" and words in end.cause.words
    assert end.time_s == pytest.approx(2.1, abs=0.025)


def test_one_bad_value_is_no_broken_sensor() -> None:
    assert run(lambda n, f: f.update(flex_V=math.nan) if n % 50 == 0 else None).reason == "completed"


@pytest.mark.parametrize("field", ["pressure_MPa", "flex_V"])
def test_a_stuck_sensor_is_told_when_the_pressure_moves(field: str) -> None:
    held: dict[str, float] = {}

    def stuck(n: int, fields: Fields) -> None:
        if n >= 60:
            fields[field] = held.setdefault(field, fields[field])

    end = run(stuck, limits=Limits(follow_s=math.inf, bend_s=math.inf))
    assert end.reason == "sensor" and "stuck, or not connected" in end.cause.words and end.time_s < 2.0


def test_a_sensor_without_noise_at_rest_is_not_stuck() -> None:
    assert run(setting("flex_V", lambda n, volts: round(volts, 2))).reason == "completed"
    assert run(setting("pressure_MPa", lambda n, p: round(p, 3))).reason == "completed"


def test_a_sensor_that_answers_late_after_a_long_hold_is_not_stuck() -> None:
    answers: list[tuple[float, float]] = [(0.0, 1.0)] * 5

    def change(n: int, fields: Fields) -> None:
        answers.append((round(fields["pressure_MPa"], 3), round(fields["flex_V"], 2)))
        fields["pressure_MPa"], fields["flex_V"] = answers.pop(0)

    assert run(change, np.repeat([0.0, 0.3, 0.0, 0.3], 500)).reason == "completed"


FLAGS = [
    (Status.ARMED | Status.SILENCE, "silence"),
    (Status.REBOOTED | Status.WATCHDOG, "rebooted"),
    (Status.ARMED | Status.DAC_LOST, "dac lost"),
    (Status.ARMED | Status.REFUSED, "refused"),
    (Status(0), "disarmed"),
]


@pytest.mark.parametrize(("status", "reason"), FLAGS, ids=[f[1] for f in FLAGS])
def test_what_the_device_says_of_itself_stops_at_once(status: Status, reason: str) -> None:
    end = run(lambda n, f: f.update(status=status) if n == 200 else None)
    assert (end.reason, end.ticks, end.exit_code) == (reason, 201, 5)


def test_slewing_an_old_watchdog_and_a_missing_answer_are_no_stops() -> None:
    def odd(n: int, fields: Fields) -> None:
        if n % 100 == 50:
            fields.update(status=Status.NO_ANSWER, pressure_MPa=math.nan, flex_V=math.nan, code=-1)
        else:
            fields["status"] = Status.ARMED | Status.SLEWING | Status.WATCHDOG

    assert run(odd).reason == "completed"


def test_faults_stop_at_a_rate_and_not_before() -> None:
    def every(count: int) -> RunEnd:
        device = FakeDevice()
        device.change = lambda n, f: device.pending.append(Fault("bad CRC")) if n % count == 0 else None
        return execute(plan_of(ramp(6.0)), device, BENCH, FakeJournal(), VirtualClock())

    assert every(12).reason == "completed"
    end = every(8)
    assert end.reason == "faults" and "21 faults on the line in 2 s, more than 20, the last: bad CRC" in end.cause.words


def test_a_line_that_stays_silent_is_called_lost_by_the_device_and_not_faulty() -> None:
    device = FakeDevice()

    def mute(n: int, fields: Fields) -> None:
        if n >= 200:
            fields.update(status=Status.NO_ANSWER, pressure_MPa=math.nan, flex_V=math.nan)
            device.pending.append(Fault("no answer"))
        if n == 250:
            raise LostError("no answer for 0.5 s")

    device.change = mute
    end = execute(plan_of(ramp(6.0)), device, BENCH, FakeJournal(), VirtualClock())
    assert end.reason == "lost" and end.ticks == 250 and "no answer for 0.5 s" in end.cause.words


def test_a_guard_whose_sensor_is_not_there_is_not_there() -> None:
    def names(bench: Any) -> list[str]:
        return [type(guard).__name__ for guard in guards_of(bench, 100.0)]

    assert names(replace(BENCH, monitor=None, flex=None)) == ["DeviceGuard", "FaultGuard"]
    assert len(names(BENCH)) == 9
    nothing = replace(BENCH, monitor=None, flex=None)
    assert run(lambda n, f: f.update(pressure_MPa=math.nan, flex_V=math.nan), bench=nothing).reason == "completed"


def test_the_guide_names_every_limit() -> None:
    guide = (Path(__file__).resolve().parents[3] / "docs" / "drive.md").read_text(encoding="utf-8")
    for each in fields(Limits):
        assert f"{each.name}=" in guide, each.name


def test_limits_are_set_by_name_and_switched_off() -> None:
    assert Limits.of(("follow_MPa=0.02", "bend_s=off")) == Limits(follow_MPa=0.02, bend_s=math.inf)
    assert run(unbending(300, True), limits=Limits.of(("bend_s=off",))).reason == "completed"
    for wrong in ("follow=1", "follow_MPa=x", "follow_MPa=-1", "late_s=nan", "late_s"):
        with pytest.raises(UsageError, match="--guard"):
            Limits.of((wrong,))


@pytest.mark.parametrize(
    "word", ["above_MPa=5", "lag_s=off", "bend_share=2", "bend_s=nan", "late_s=0", "follow_s=", "empty_s=1e9"]
)
def test_a_limit_that_guards_nothing_is_refused(word: str) -> None:
    with pytest.raises(UsageError, match=rf"--guard {word}: (more than|not a number above)"):
        Limits.of((word,))


def test_a_guard_that_is_off_is_not_among_those_that_watch_and_is_told() -> None:
    limits = Limits.of(("above_MPa=off", "bend_s=off", "stuck_s=off"))
    names = [guard.name for guard in guards_of(BENCH, 100.0, limits)]
    assert "bending" not in names and "pressure above the limit" not in names and "flex sensor" in names
    assert limits.off == ("above_MPa", "bend_s", "stuck_s")
    assert "a pressure above the limit (above_MPa)" in limits.off_words[0] and Limits().off_words == []
    off = Limits.of(("sensor_s=off", "stuck_MPa=off"))
    names = [guard.name for guard in guards_of(BENCH, 100.0, off)]
    assert "flex sensor" not in names and "pressure above the limit" in names


def test_every_limit_has_a_bound_and_words() -> None:
    names = {each.name for each in fields(Limits)}
    assert set(MOST) == names and set(UNSEEN) == names - set(NEVER_OFF)
    assert all(getattr(Limits(), name) < most for name, most in MOST.items())


def test_a_share_that_is_off_lets_anything_pass() -> None:
    limits = Limits.of(("bend_share=off", "stuck_s=off"))
    assert run(unbending(0), bench=NO_MONITOR, limits=limits).reason == "completed"


def test_the_guards_name_the_option_that_changes_them() -> None:
    assert (
        "--guard lag_s=" in run(lagging(3.0), STEPS).cause.words
        and "regulator slower than 0.5 s" in run(lagging(3.0), STEPS).cause.words
    )
    assert "--guard bend_s=off" in run(unbending(0), bench=NO_MONITOR).cause.words


def test_a_slow_ramp_of_a_steep_actuator_is_judged_by_what_it_bends_from_where_it_rested() -> None:
    """It has bent by 18° before the pressure is one that counts as asked for."""

    def steep(n: int, fields: Fields) -> None:
        fields["flex_V"] = 1.0 + (fields["flex_V"] - 1.0) * 3

    slow = np.linspace(0.0, 0.05, 1001)
    along = guards_of(NO_MONITOR, 100.0, expected_deg=lambda p: 3 * DEG_PER_MPA * p)
    assert run(steep, slow, bench=NO_MONITOR, guards=along).reason == "completed"
    along = guards_of(NO_MONITOR, 100.0, expected_deg=lambda p: 3 * DEG_PER_MPA * p)
    held = setting("flex_V", lambda n, volts: 1.0 + 1e-3 * math.sin(n))
    assert run(held, slow, bench=NO_MONITOR, guards=along).reason == "not following"
