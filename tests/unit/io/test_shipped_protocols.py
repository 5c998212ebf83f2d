"""The protocols that come with benchlab: their numbers against the paper's, and that they say where they are from."""

import re
from pathlib import Path

import numpy as np
import pytest

from benchlab.bench import Bench
from benchlab.io.protocol_file import read_protocol, shipped_protocols
from benchlab.protocol.checks import check_limits
from benchlab.protocol.overview import overview

ROOT = Path(__file__).resolve().parents[3]
NAMES = (
    "blocked_force_steps",
    "creep_hold",
    "flex_calibration",
    "linear_ramp",
    "multi_rate_loading",
    "repeatability",
    "sine_tracking",
)


def test_these_are_shipped_and_listed() -> None:
    assert tuple(shipped_protocols()) == NAMES
    listed = re.findall(r"^\| \[(\w+)\]", (ROOT / "protocols" / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(listed) == list(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_each_keeps_the_papers_limit_ends_vented_and_says_its_source(name: str) -> None:
    plan = read_protocol(name)
    check_limits(plan, Bench("calibrated", calibrated=True))
    assert plan.limit_MPa == 0.35 and plan.ends_vented
    assert "paper" in plan.about and len(plan.about) > 100
    assert 10 <= plan.rate_Hz <= 500  # what a real bench takes


def test_linear_ramp_is_the_papers() -> None:
    plan = read_protocol("linear_ramp")
    rising = plan.time_s <= 2.5
    slope = np.polyfit(plan.time_s[rising], plan.pressure_MPa[rising], 1)
    np.testing.assert_allclose(slope, [0.35 / 2.5, 0.0], atol=1e-9)  # 0 to 0.35 MPa in 2.5 s: 0.14 MPa/s
    assert (plan.events[0].kind, plan.events[0].time_s) == ("trigger", 0.0)


def test_blocked_force_steps_are_fifty_pulses() -> None:
    plan = read_protocol("blocked_force_steps")
    holds = [step for step in plan.steps if step.kind == "hold"]
    levels = [0.035, 0.07, 0.105, 0.14, 0.175, 0.21, 0.245, 0.28, 0.315, 0.35]  # section II-E
    assert [step.start_MPa for step in holds] == [level for level in levels for _ in range(5)]
    assert [step.counts for step in holds[:6]] == [(1,), (2,), (3,), (4,), (5,), (1,)]
    assert overview(plan).rises == 50 and overview(plan).falls == 50


def test_repeatability_is_three_fast_and_three_slow_cycles() -> None:
    ramps = [step for step in read_protocol("repeatability").steps if step.kind == "ramp"]
    assert [step.slew_MPa_per_s for step in ramps] == [0.14] * 3 + [0.014] * 3
    assert [step.end_MPa for step in ramps] == [0.35] * 6


def test_flex_calibration_covers_the_range_up_and_down_with_long_holds() -> None:
    steps = read_protocol("flex_calibration").steps
    levels = [step.start_MPa for step in steps]
    assert levels[:11] == levels[:9:-1] and levels[0] == 0 and levels[10] == 0.35
    assert max(np.abs(np.diff(levels))) == pytest.approx(0.035)  # control tune takes steps of up to 0.1 MPa
    assert (
        min(step.end_s - step.start_s for step in steps) >= 4
    )  # half of it is read, two seconds after a step are fitted


def test_sine_tracking_is_a_fifth_of_a_hertz_after_settling() -> None:
    plan = read_protocol("sine_tracking")
    sine = [step for step in plan.steps if "sine" in step.label]
    assert plan.rate_Hz == 100 and len(sine) >= 5 and plan.control is not None
    assert {round(step.end_s - step.start_s, 6) for step in sine} == {5.0}  # 0.2 Hz
    there = (plan.time_s >= sine[0].start_s) & (plan.time_s <= sine[-1].end_s - 0.01)
    reference = plan.reference_deg[there]
    assert (reference.min(), reference.max()) == pytest.approx((30, 90), abs=0.01)
    wave = np.exp(-2j * np.pi * 0.2 * (plan.time_s[there] - sine[0].start_s)) @ reference * 2 / len(reference)
    np.testing.assert_allclose(wave, -30j, atol=0.05)  # all of it at 0.2 Hz, beginning at the mean, rising
    before = plan.reference_deg[(plan.time_s > 5) & (plan.time_s < sine[0].start_s)]
    assert (before == 60).all() and sine[0].start_s - 5 >= 3


def test_the_sine_is_within_reach_of_the_simulated_actuator_with_room_to_push() -> None:
    curve = np.genfromtxt(ROOT / "benchlab" / "curves" / "tw3_slw10.csv", delimiter=",", names=True)
    allowed = curve["angle_deg"][curve["pressure_MPa"] <= 0.35]
    assert allowed.max() > 1.2 * np.nanmax(read_protocol("sine_tracking").reference_deg)


def test_creep_hold_is_long_and_recovers() -> None:
    plan = read_protocol("creep_hold")
    at_top = plan.time_s[plan.pressure_MPa == 0.35]
    assert at_top.max() - at_top.min() == pytest.approx(600, abs=0.1)
    assert plan.steps[-1].kind == "vent" and plan.steps[-1].end_s - plan.steps[-1].start_s == 300
    marks = {event.text: event.time_s for event in plan.events}
    begins = marks["creep begins"]
    assert [marks[text] - begins for text in ("1 s", "10 s", "100 s", "recovery begins")] == [1, 10, 100, 600]


def test_multi_rate_loading_has_four_rates() -> None:
    plan = read_protocol("multi_rate_loading")
    triangles = [step for step in plan.steps if step.kind == "triangle"]
    assert [step.slew_MPa_per_s for step in triangles] == [0.014, 0.014, 0.035, 0.035, 0.14, 0.14, 0.35, 0.35]
    assert {(step.low_MPa, step.high_MPa) for step in triangles} == {(0.0, 0.35)}
    marks = [event.text for event in plan.events if event.kind == "mark"]
    assert marks == [f"{rate:g} MPa/s" for rate in dict.fromkeys(step.slew_MPa_per_s for step in triangles)]
