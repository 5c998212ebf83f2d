"""What holds for every plan, tried on random protocols."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from benchlab.protocol.curvature import AngleHold, AngleRamp, AngleSine
from benchlab.protocol.groups import Repeat, Segment, Signal, train
from benchlab.protocol.overview import overview
from benchlab.protocol.plan import Plan
from benchlab.protocol.segments import Hold, Ramp, Sine, Triangle, Vent
from benchlab.protocol.survey import Bounds, survey
from benchlab.protocol.unroll import unroll

RATES = (1.0, 7.0, 20.0, 100.0, 333.0)

seconds = st.one_of(st.integers(1, 40).map(lambda n: n / 10), st.floats(1.0, 4.0).map(lambda t: round(t, 4)))
pressures = st.integers(0, 350).map(lambda n: n / 1000)


@st.composite
def closed_under_repeat(draw: st.DrawFn) -> tuple[Segment, ...]:
    """Segments that can begin anywhere and in any order: each group sets what the next needs."""
    low, high = sorted(draw(st.lists(pressures, min_size=2, max_size=2, unique=True)))
    hold, angle = Hold(draw(seconds), low), float(draw(st.integers(1, 90)))
    inside = Hold(draw(seconds), round(low + draw(st.floats(0, 1)) * (high - low), 6))
    some, one, other = draw(st.integers(1, 3)), draw(seconds), draw(seconds)
    choices: list[tuple[Segment, ...]] = [
        (hold, Ramp(high, duration_s=one), Hold(other)),
        (hold, Ramp(high, rate_MPa_per_s=(high - low) / one)),
        (hold, Vent(one)),
        (inside, Sine((low + high) / 2, (high - low) / 2, 1 / one, some)),
        (hold, Triangle(low, high, some, frequency_Hz=1 / one)),
        train([high, low], one, draw(st.sampled_from([0.0, other])), some),
        (
            AngleHold(angle, one),
            AngleRamp(angle / 2, duration_s=other),
            AngleSine(angle, angle / 2, 1 / one, some),
            Vent(1.0),
        ),
        (Signal("mark", "a"), hold, Signal("trigger", "camera")),
    ]
    return draw(st.sampled_from(choices))


groups = st.lists(closed_under_repeat(), min_size=1, max_size=4).map(
    lambda parts: tuple(s for part in parts for s in part)
)
protocols = st.lists(
    st.one_of(groups, st.tuples(st.integers(1, 3), groups).map(lambda pair: (Repeat(*pair),))), min_size=1, max_size=3
).map(lambda parts: tuple(s for part in parts for s in part))


def planned(segments: tuple[Segment, ...], rate_Hz: float) -> Plan:
    return unroll(segments, "random", rate_Hz, 0.35)


@settings(max_examples=150, deadline=None)
@given(protocols, st.sampled_from(RATES))
def test_every_plan(segments: tuple[Segment, ...], rate_Hz: float) -> None:
    plan = planned(segments, rate_Hz)
    ticks = len(plan.time_s)
    assert ticks == len(plan.pressure_MPa) == len(plan.reference_deg) == len(plan.step)
    np.testing.assert_array_equal(plan.time_s, np.arange(ticks) / rate_Hz)
    assert plan.duration_s - 1e-6 <= plan.time_s[-1] < plan.duration_s + 1 / rate_Hz - 1e-9

    open_loop = np.isfinite(plan.pressure_MPa)
    assert (open_loop ^ np.isfinite(plan.reference_deg)).all()
    peak = overview(plan).peak_MPa or 0.0
    assert peak <= 0.35
    assert (plan.pressure_MPa[open_loop] >= 0).all() and (plan.pressure_MPa[open_loop] <= peak).all()

    assert plan.steps[0].start_s == 0.0
    for one, following in zip(plan.steps, plan.steps[1:]):
        assert one.start_s < one.end_s == following.start_s
    for index, step in enumerate(plan.steps):
        own = plan.time_s[plan.step == index]
        assert ((own >= step.start_s - 1e-6) & (own <= step.end_s + 1 / rate_Hz)).all()
        if step.high_MPa is not None and step.low_MPa is not None and step.slew_MPa_per_s is not None:
            values = plan.pressure_MPa[plan.step == index]
            assert (values >= step.low_MPa).all() and (values <= step.high_MPa).all()
            assert (np.abs(np.diff(values)) <= step.slew_MPa_per_s / rate_Hz + 1e-8).all()  # continuous within a step
    for before, step in zip(plan.steps, plan.steps[1:]):
        if step.kind in ("ramp", "sine", "triangle"):  # these go on from where the one before ended
            assert step.start_MPa == before.end_MPa
    assert all(0 <= event.time_s <= plan.duration_s for event in plan.events)


@settings(max_examples=100, deadline=None)
@given(groups, st.integers(1, 4), st.sampled_from(RATES))
def test_a_repeat_is_its_segments_written_out(segments: tuple[Segment, ...], times: int, rate_Hz: float) -> None:
    short, long = planned((Repeat(times, segments),), rate_Hz), planned(segments * times, rate_Hz)
    for name in ("time_s", "pressure_MPa", "reference_deg", "step"):
        np.testing.assert_array_equal(getattr(short, name), getattr(long, name))
    assert short.events == long.events
    assert [(s.kind, s.start_s, s.end_s, s.label) for s in short.steps] == [
        (s.kind, s.start_s, s.end_s, s.label) for s in long.steps
    ]


@settings(max_examples=150, deadline=None)
@given(protocols, st.integers(1, 5))
def test_what_is_foretold_is_what_is_unrolled(segments: tuple[Segment, ...], times: int) -> None:
    segments = (Ramp(0.3, duration_s=1.0), Repeat(times, segments))
    plan, found = planned(segments, 100.0), survey(segments, Bounds(100.0, 0.35))
    assert not found.problems
    assert found.steps == len(plan.steps)
    assert math.isclose(found.duration_s, plan.duration_s, abs_tol=1e-6)
    highest = overview(plan).peak_MPa or 0.0
    over = survey(segments, Bounds(100.0, highest - 1e-6)).problems
    assert over and all("above limit_MPa" in problem.what for problem in over)
