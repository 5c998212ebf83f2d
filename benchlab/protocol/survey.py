"""A protocol measured and judged before anything is unrolled: duration, number of steps, and all that is wrong with it, by line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from benchlab.protocol.curvature import AngleHold, AngleRamp, AngleSine
from benchlab.protocol.groups import Repeat, Segment, Signal, Timed
from benchlab.protocol.segments import Ramp, Sine, Triangle, Vent
from benchlab.protocol.stretch import CannotBeginError, State, Stretch

MAX_TICKS, MAX_STEPS = 4_000_000, 100_000
"""What is unrolled at most: 4 million ticks are 11 hours at 100 Hz and 130 MB."""

TICKS_A_CYCLE = 10
"""Of a sine or triangle at least: with fewer, what is asked for has little of its shape and may miss its peaks."""


@dataclass(frozen=True)
class Bounds:
    """What a protocol has to keep. slew_limit_MPa_per_s: None for no limit; with one, only a vent may jump."""

    rate_Hz: float
    limit_MPa: float
    slew_limit_MPa_per_s: float | None = None
    max_duration_s: float = 3600.0


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong, with the line of its segment (0: of the whole protocol) and a remedy."""

    line: int
    what: str
    remedy: str


@dataclass(frozen=True)
class Survey:
    """How long it takes, how many steps it is, what is known afterwards, and what is wrong."""

    duration_s: float
    steps: int
    after: State
    problems: tuple[Problem, ...]


def survey(segments: Sequence[Segment], bounds: Bounds) -> Survey:
    """The whole protocol, from vented. A repeat is walked at most twice, however often it comes: its first round begins elsewhere
    than the others, which are alike, as each segment either sets what is known or leaves it as it is.

    >>> from benchlab.protocol.segments import Hold
    >>> survey([Repeat(1000, (Hold(2.0, 0.1), Vent(1.0)))], Bounds(100.0, 0.35)).duration_s
    3000.0
    """
    found = _walked(segments, State(), bounds)
    problems = dict.fromkeys((*found.problems, *_triggers_as_one(segments, [])))
    return Survey(found.duration_s, found.steps, found.after, (*problems, *_of_whole(found, bounds)))


def _of_whole(found: Survey, bounds: Bounds) -> Iterator[Problem]:
    if found.steps == 0 and not found.problems:
        yield Problem(0, "has no segment that takes time", "add a ramp, hold or vent")
    ticks = found.duration_s * bounds.rate_Hz + 1
    if found.duration_s > bounds.max_duration_s:
        what = (
            f"would last {found.duration_s:.7g} s ({in_words(found.duration_s)}), more than {bounds.max_duration_s:g} s"
        )
        yield Problem(0, what, "shorten it, or allow it with --max-duration-s")
    if ticks > MAX_TICKS:
        what = f"would be {ticks:.4g} ticks at {bounds.rate_Hz:g} Hz, and {MAX_TICKS:,} are the most"
        yield Problem(0, what, "lower rate_Hz, or split it into several protocols")
    if found.steps > MAX_STEPS:
        what = f"would be {found.steps:.7g} steps, and {MAX_STEPS:,} are the most"
        yield Problem(0, what, "repeat less often, or split it into several protocols")


def _triggers_as_one(segments: Sequence[Segment], now: list[int]) -> Iterator[Problem]:
    """Triggers with no segment that takes time between them. now: line of the trigger of this moment, if there was one."""
    for segment in segments:
        match segment:
            case Signal(kind="trigger"):
                if now:
                    same = f"that of line {now[0]}" if now[0] != segment.line else "another of this line"
                    what = f"a trigger at the same moment as {same}: the two would be one pulse"
                    yield Problem(segment.line, what, "remove one, or write a segment that takes time between them")
                now[:] = [segment.line]
            case Signal():
                continue
            case Repeat():
                yield from _triggers_as_one(segment.segments, now)
                if now and segment.times > 1:
                    yield from _triggers_as_one(segment.segments, now)
            case _:
                now.clear()


def _walked(segments: Sequence[Segment], state: State, bounds: Bounds) -> Survey:
    duration_s, steps = 0.0, 0
    problems: list[Problem] = []
    for segment in segments:
        match segment:
            case Signal():
                continue
            case Repeat():
                one = _repeated(segment, state, bounds)
            case _:
                one = _timed(segment, state, bounds)
        duration_s, steps, state = duration_s + one.duration_s, steps + one.steps, one.after
        problems += one.problems
    return Survey(duration_s, steps, state, tuple(problems))


def _repeated(repeat: Repeat, state: State, bounds: Bounds) -> Survey:
    first = _walked(repeat.segments, state, bounds)
    if repeat.times == 1:
        return first
    again = first if first.after == state else _walked(repeat.segments, first.after, bounds)
    return Survey(
        first.duration_s + (repeat.times - 1) * again.duration_s,
        repeat.times * first.steps,
        again.after,
        first.problems + (() if again is first else again.problems),
    )


def _timed(segment: Timed, state: State, bounds: Bounds) -> Survey:
    try:
        stretch = segment.begun(state)
    except CannotBeginError as error:
        return Survey(0.0, segment.rounds, _supposed(segment), (Problem(segment.line, error.what, error.remedy),))
    problems = tuple(Problem(segment.line, *told) for told in _wrong(segment, stretch, state, bounds))
    return Survey(segment.rounds * stretch.duration_s, segment.rounds, stretch.after, problems)


def _wrong(segment: Timed, stretch: Stretch, state: State, bounds: Bounds) -> Iterator[tuple[str, str]]:
    """What is wrong with a stretch, and what to do about it."""
    period_s, rate = 1 / bounds.rate_Hz, f"at {bounds.rate_Hz:g} Hz"
    if stretch.duration_s < period_s - 1e-9:
        yield (
            f"{stretch.kind} of {stretch.duration_s:g} s is shorter than a tick, {period_s:g} s {rate}",
            "make it longer, or raise rate_Hz",
        )
    elif isinstance(segment, (Sine, Triangle, AngleSine)) and stretch.duration_s < TICKS_A_CYCLE * period_s - 1e-9:
        yield (
            f"a cycle of {stretch.duration_s:g} s has {stretch.duration_s / period_s:.3g} ticks {rate}, fewer than {TICKS_A_CYCLE}",
            "make it slower, or raise rate_Hz",
        )
    unit = "°" if stretch.closed_loop else " MPa"
    if stretch.low < 0:
        yield f"{stretch.label} goes down to {stretch.low:g}{unit}", "stay at 0 or above"
    if not stretch.closed_loop:
        yield from _wrong_pressure(segment, stretch, state, bounds)


def _wrong_pressure(segment: Timed, stretch: Stretch, state: State, bounds: Bounds) -> Iterator[tuple[str, str]]:
    if stretch.high > bounds.limit_MPa:
        what = f"{stretch.label} reaches {stretch.high:g} MPa, above limit_MPa {bounds.limit_MPa:g}"
        yield what, "ask for less; the limit is there to protect actuator and hands"
    if (limit := bounds.slew_limit_MPa_per_s) is None or isinstance(segment, Vent):
        return
    if stretch.slew > limit * (1 + 1e-9):
        what = f"{stretch.label} has {stretch.slew:.4g} MPa/s, above slew_limit_MPa_per_s {limit:g}"
        yield what, "make it slower"
    if stretch.start != state.pressure_MPa:
        before = "an unknown pressure" if state.pressure_MPa is None else f"{state.pressure_MPa:g} MPa"
        what = f"{stretch.label} jumps there from {before}, above slew_limit_MPa_per_s {limit:g}"
        yield what, "write a ramp before it; only a vent may jump"


def _supposed(segment: Timed) -> State:
    """What is taken to be known after a segment that cannot begin, so that what follows is judged for itself."""
    match segment:
        case Ramp(to_MPa=at) | Sine(mean_MPa=at) | Triangle(low_MPa=at):
            return State(at, None)
        case AngleRamp(to_deg=at) | AngleSine(mean_deg=at) | AngleHold(angle_deg=at):
            return State(None, at)
    return State()


def in_words(seconds: float) -> str:
    """A duration that is easily grasped.

    >>> in_words(45), in_words(150), in_words(7500), in_words(200000)
    ('45 s', '2 min 30 s', '2 h 5 min', '2 d 7 h 33 min')
    """
    parts: list[str] = []
    left = round(seconds) if seconds < 3600 else 60 * round(seconds / 60)
    for size, name in ((86400, "d"), (3600, "h"), (60, "min"), (1, "s")):
        count, left = divmod(left, size)
        if count:
            parts.append(f"{count} {name}")
    return " ".join(parts) or f"{seconds:g} s"
