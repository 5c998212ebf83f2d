"""What is said of a protocol before it is unrolled."""

import pytest

from benchlab.protocol.curvature import AngleHold, AngleSine
from benchlab.protocol.groups import Repeat, Segment, Signal
from benchlab.protocol.segments import Hold, Ramp, Sine, Triangle, Vent
from benchlab.protocol.survey import MAX_STEPS, MAX_TICKS, Bounds, survey
from tests.pace import best_cpu_s, slowness

BOUNDS = Bounds(100.0, 0.35, None, 3600.0)


def told(segments: list[Segment], bounds: Bounds = BOUNDS) -> list[tuple[int, str]]:
    return [(problem.line, problem.what) for problem in survey(segments, bounds).problems]


def test_a_billion_rounds_are_refused_at_once() -> None:
    deep: tuple[Segment, ...] = (Hold(1.0, 0.1), Vent(1.0))
    for _ in range(10):
        deep = (Repeat(1000, deep),)
    assert best_cpu_s(lambda: survey(deep, BOUNDS)) < 0.1 * slowness()
    found = survey(deep, BOUNDS)
    assert found.duration_s == pytest.approx(2e30) and found.steps == 2 * 10**30
    words = [problem.what for problem in found.problems]
    assert "would last 2e+30 s" in words[0] and "more than 3600 s" in words[0]
    assert f"{MAX_TICKS:,} are the most" in words[1] and f"{MAX_STEPS:,} are the most" in words[2]
    assert "--max-duration-s" in found.problems[0].remedy


def test_a_repeat_whose_first_round_is_longer() -> None:
    segments = [Repeat(4, (Ramp(0.3, rate_MPa_per_s=0.1), Ramp(0.2, rate_MPa_per_s=0.1)))]
    assert survey(segments, BOUNDS).duration_s == pytest.approx(3 + 1 + 3 * (1 + 1))


def test_the_second_round_is_judged_too() -> None:
    assert told([Repeat(1, (Triangle(0.0, 0.1, 1, frequency_Hz=1.0), Hold(1.0, 0.1, 5)))]) == []
    (problem,) = told([Repeat(2, (Triangle(0.0, 0.1, 1, frequency_Hz=1.0, line=4), Hold(1.0, 0.1, 5)))])
    assert problem == (4, "the triangle starts at 0 MPa and the present pressure is 0.1 MPa")


def test_a_peak_between_two_ticks_is_seen() -> None:
    sine = Sine(0.2, 0.1501, 7.77, 3, line=3)  # at 100 Hz no tick comes within 0.0001 MPa of every peak
    found = told([Hold(1.0, 0.2), sine])
    assert found == [(3, "sine 0.2 ± 0.1501 MPa, 7.77 Hz reaches 0.3501 MPa, above limit_MPa 0.35")]
    assert told([Hold(1.0, 0.2), Sine(0.2, 0.15, 7.77, 3)]) == []


def test_every_problem_is_told_with_its_line_and_what_follows_is_judged_for_itself() -> None:
    segments = [
        Ramp(0.4, duration_s=1.0, line=1),
        Hold(0.001, 0.1, 2),
        Sine(0.3, 0.05, 1.0, 1, line=3),
        Ramp(0.1, duration_s=1.0, line=4),
        Sine(0.1, 0.2, 1.0, 1, line=5),
        Sine(0.1, 0.01, 20.0, 1, line=6),
        AngleHold(30.0, 1.0, 7),
        AngleSine(20.0, 30.0, 1.0, 1, 8),
    ]
    found = dict(told(segments))
    assert list(found) == [1, 2, 3, 5, 6, 8]
    assert "reaches 0.4 MPa, above limit_MPa 0.35" in found[1]
    assert "shorter than a tick" in found[2] and "present pressure is 0.1 MPa" in found[3]
    assert "goes down to -0.1 MPa" in found[5] and "5 ticks" in found[6] and "goes down to -10°" in found[8]


def test_slopes_and_jumps_above_the_slew_limit() -> None:
    bounds = Bounds(100.0, 0.35, 0.1)
    assert told([Ramp(0.3, rate_MPa_per_s=0.1), Hold(1.0), Vent(1.0)], bounds) == []
    (steep,) = told([Ramp(0.3, rate_MPa_per_s=0.11, line=2)], bounds)
    assert steep[0] == 2 and "0.11 MPa/s, above slew_limit_MPa_per_s 0.1" in steep[1]
    (jump,) = told([Hold(1.0, 0.2, 3)], bounds)
    assert jump[0] == 3 and "jumps there from 0 MPa" in jump[1]
    (sine,) = told([Sine(0.1, 0.1, 0.2, 1, line=4)], bounds)  # 2π · 0.2 · 0.1 = 0.126 MPa/s
    assert "0.1257 MPa/s" in sine[1]


def test_nothing_that_takes_time() -> None:
    assert told([]) == [(0, "has no segment that takes time")]


def test_ticks_are_capped_whatever_the_duration_allowed() -> None:
    (problem,) = told([Hold(50_000.0, 0.1)], Bounds(100.0, 0.35, None, 1e6))
    assert "5e+06 ticks at 100 Hz" in problem[1]


def test_triggers_at_one_moment_are_one_pulse_and_refused() -> None:
    def trigger(line: int) -> Signal:
        return Signal("trigger", "camera", line)

    wait, mark = Vent(0.5), Signal("mark", "a", 9)
    assert not told([trigger(1), mark, wait, trigger(2), Repeat(9, (wait, trigger(4))), wait])
    assert told([trigger(1), mark, trigger(2), wait]) == [
        (2, "a trigger at the same moment as that of line 1: the two would be one pulse")
    ]
    assert [line for line, _ in told([wait, Repeat(3, (wait, trigger(2))), trigger(3)])] == [3]
    assert [line for line, _ in told([wait, Repeat(3, (trigger(2), wait, trigger(3)))])] == [2]
    alone = told([wait, Repeat(1000, (mark, trigger(2)))])
    assert alone == [(2, "a trigger at the same moment as another of this line: the two would be one pulse")]
