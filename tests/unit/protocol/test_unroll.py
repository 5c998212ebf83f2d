"""Segments unrolled to ticks, against values worked out by hand and by the formulas of the segments."""

import numpy as np
import pytest

from benchlab.protocol.curvature import AngleHold, AngleRamp, AngleSine
from benchlab.protocol.groups import Repeat, Signal, levels_of, train
from benchlab.protocol.plan import Plan
from benchlab.protocol.segments import Hold, Ramp, Sine, Triangle, Vent
from benchlab.protocol.stretch import CannotBeginError, State
from benchlab.protocol.unroll import unroll


def plan_of(*segments: object, rate_Hz: float = 100.0) -> Plan:
    return unroll(segments, "test", rate_Hz, 0.35)


def test_the_papers_ramp_is_reached_tick_by_tick() -> None:
    plan = plan_of(Ramp(0.35, duration_s=2.5), Hold(0.5), Vent(1.0))
    assert plan.duration_s == 4.0 and len(plan.time_s) == 401
    np.testing.assert_allclose(plan.pressure_MPa[:251], 0.14 * np.arange(251) / 100, atol=1e-12)
    assert (plan.pressure_MPa[250:300] == 0.35).all() and (plan.pressure_MPa[300:] == 0).all()
    assert np.isnan(plan.reference_deg).all() and not plan.closed_loop and plan.ends_vented


def test_a_rate_and_a_duration_are_the_same_ramp() -> None:
    one, other = plan_of(Ramp(0.35, rate_MPa_per_s=0.14)), plan_of(Ramp(0.35, duration_s=2.5))
    np.testing.assert_array_equal(one.pressure_MPa, other.pressure_MPa)
    assert not one.ends_vented


def test_a_sine_goes_on_from_the_present_pressure_rising() -> None:
    plan = plan_of(Ramp(0.25, duration_s=1.0), Sine(0.2, 0.1, 0.5, 3), Hold(1.0))
    time = plan.time_s[100:701] - 1.0
    np.testing.assert_allclose(plan.pressure_MPa[100:701], 0.2 + 0.1 * np.sin(np.pi * time + np.pi / 6), atol=1e-12)
    assert np.abs(np.diff(plan.pressure_MPa)).max() <= 0.1 * np.pi / 100 + 1e-12  # 2πfA a second
    assert plan.pressure_MPa[-1] == 0.25
    assert [step.counts for step in plan.steps] == [(), (1,), (2,), (3,), ()]


def test_a_sine_from_vented_begins_at_its_lowest_point() -> None:
    plan = plan_of(Sine(0.15, 0.15, 1.0, 1))
    np.testing.assert_allclose(plan.pressure_MPa, 0.15 - 0.15 * np.cos(2 * np.pi * plan.time_s), atol=1e-9)


def test_a_triangle_loads_and_unloads_at_its_rate() -> None:
    plan = plan_of(Triangle(0.0, 0.35, 2, rate_MPa_per_s=0.14))
    assert plan.duration_s == 10.0
    np.testing.assert_allclose(np.abs(np.diff(plan.pressure_MPa)), 0.0014, atol=1e-12)
    assert plan.pressure_MPa[[0, 250, 500, 750, 1000]] == pytest.approx([0, 0.35, 0, 0.35, 0])
    by_frequency = plan_of(Triangle(0.0, 0.35, 2, frequency_Hz=0.2))
    np.testing.assert_array_equal(plan.pressure_MPa, by_frequency.pressure_MPa)


def test_a_train_of_steps_is_pulses_with_their_cycle() -> None:
    plan = plan_of(*train(levels_of(0.1, 0.2, 0.1), 1.0, 2.0, 2, line=7))
    assert [(s.kind, s.start_s, s.end_s, s.counts) for s in plan.steps] == [
        ("hold", 0.0, 1.0, (1,)),
        ("vent", 1.0, 3.0, (1,)),
        ("hold", 3.0, 4.0, (2,)),
        ("vent", 4.0, 6.0, (2,)),
        ("hold", 6.0, 7.0, (1,)),
        ("vent", 7.0, 9.0, (1,)),
        ("hold", 9.0, 10.0, (2,)),
        ("vent", 10.0, 12.0, (2,)),
    ]
    assert {step.line for step in plan.steps} == {7}
    assert plan.pressure_MPa[[0, 99, 100, 299, 300, 600]].tolist() == [0.1, 0.1, 0, 0, 0.1, 0.2]


def test_levels_are_round_numbers_and_end_where_they_are_said_to() -> None:
    assert levels_of(0.035, 0.35, 0.035) == (0.035, 0.07, 0.105, 0.14, 0.175, 0.21, 0.245, 0.28, 0.315, 0.35)
    with pytest.raises(ValueError, match="do not end"):
        levels_of(0.0, 0.35, 0.1)


def test_closed_loop_leaves_the_pressure_open_and_gives_the_reference() -> None:
    plan = plan_of(AngleRamp(60.0, duration_s=2.0), AngleHold(60.0, 1.0), AngleSine(60.0, 30.0, 0.2, 1), Vent(1.0))
    closed = slice(0, 800)
    assert np.isnan(plan.pressure_MPa[closed]).all() and np.isnan(plan.reference_deg[800:]).all()
    assert (plan.pressure_MPa[800:] == 0).all() and plan.closed_loop
    time = plan.time_s[300:800] - 3.0
    np.testing.assert_allclose(plan.reference_deg[300:800], 60 + 30 * np.sin(0.4 * np.pi * time), atol=1e-9)
    assert plan.reference_deg[:201:100].tolist() == [0, 30, 60]
    assert {step.kind for step in plan.steps[:3]} == {"curvature"} and plan.steps[0].high_MPa is None


def test_borders_between_ticks_belong_to_the_step_in_whose_time_they_lie() -> None:
    plan = plan_of(Hold(0.25, 0.1), Hold(0.25, 0.2), Vent(0.25), rate_Hz=10.0)  # borders at 2.5 and 5 ticks
    assert plan.step.tolist() == [0, 0, 0, 1, 1, 2, 2, 2, 2]
    assert plan.time_s[-1] == 0.8 and plan.duration_s == 0.75  # the first tick at or after the end
    ramp = plan_of(Ramp(0.3, duration_s=0.25), Vent(0.5), rate_Hz=10.0)
    assert ramp.pressure_MPa[:3] == pytest.approx([0, 0.12, 0.24]) and ramp.pressure_MPa[3] == 0


def test_marks_and_triggers_stand_at_their_time() -> None:
    body = (Signal("mark", "up"), Ramp(0.1, duration_s=1.0), Signal("trigger", "camera"), Vent(0.5))
    plan = plan_of(Repeat(2, body), Signal("mark", "end"))
    assert [(e.time_s, e.kind, e.text) for e in plan.events] == [
        (0.0, "mark", "up"),
        (1.0, "trigger", "camera"),
        (1.5, "mark", "up"),
        (2.5, "trigger", "camera"),
        (3.0, "mark", "end"),
    ]


def test_counts_of_nested_repeats_come_outermost_first() -> None:
    plan = plan_of(Repeat(2, (Repeat(2, (Hold(0.1, 0.1),)), Triangle(0.1, 0.2, 2, frequency_Hz=5.0))))
    assert [s.counts for s in plan.steps] == [(1, 1), (1, 2), (1, 1), (1, 2), (2, 1), (2, 2), (2, 1), (2, 2)]


@pytest.mark.parametrize(
    ("segments", "words"),
    [
        (
            [Hold(1.0, 0.05), Triangle(0.1, 0.3, 1, frequency_Hz=1.0)],
            "starts at 0.1 MPa and the present pressure is 0.05",
        ),
        ([Sine(0.2, 0.1, 1.0, 1)], "between 0.1 and 0.3 MPa and the present pressure is 0 MPa"),
        ([Hold(1.0, 0.1), Ramp(0.1, rate_MPa_per_s=1.0)], "takes no time"),
        ([AngleHold(9.0, 1.0), Ramp(0.1, duration_s=1.0)], "nobody knows"),
        ([AngleHold(9.0, 1.0), Hold(1.0)], "nobody knows"),
        ([AngleHold(9.0, 1.0), Sine(0.1, 0.1, 1.0, 1)], "nobody knows"),
        ([AngleHold(9.0, 1.0), Triangle(0.0, 0.1, 1, frequency_Hz=1.0)], "nobody knows"),
        ([Hold(1.0, 0.1), AngleRamp(9.0, duration_s=1.0)], "is not known under pressure"),
        ([Hold(1.0, 0.1), AngleSine(9.0, 9.0, 1.0, 1)], "is not known under pressure"),
        ([AngleSine(60.0, 30.0, 1.0, 1)], "between 30° and 90° and the present reference is 0°"),
        ([AngleHold(9.0, 1.0), AngleRamp(9.0, rate_deg_per_s=1.0)], "takes no time"),
    ],
)
def test_a_segment_that_cannot_begin_says_why(segments: list[object], words: str) -> None:
    with pytest.raises(CannotBeginError, match=words):
        plan_of(*segments)


def test_sums_are_round_numbers_however_many_there_are() -> None:
    plan = plan_of(Repeat(1000, (Hold(0.1, 0.2), Hold(0.1, 0.1))))
    assert plan.duration_s == 200.0 and plan.steps[-1].start_s == 199.9
    sine = plan_of(Hold(1.0, 0.2), Sine(0.2, 0.1, 1.0, 1))  # 0.2 + 0.1 is 0.30000000000000004
    assert sine.pressure_MPa.max() == sine.steps[1].high_MPa == 0.3


def test_what_is_known_after_a_vent_or_a_level() -> None:
    assert Vent(1.0).begun(State(None, None)).after == State(0.0, 0.0)
    assert Hold(1.0, 0.2).begun(State(None, 40.0)).after == State(0.2, None)
    assert AngleHold(30.0, 1.0).begun(State()).after == State(None, 30.0)


def test_a_mark_between_steps_comes_at_the_first_tick_of_the_next() -> None:
    plan = unroll([Repeat(30, (Signal("mark", "here"), Hold(2 / 3, 0.1)))], "thirds", 300.0, 0.35)
    firsts = [int(np.flatnonzero(plan.step == index)[0]) for index in range(30)]
    assert sorted(plan.events_by_tick()) == firsts
