"""From segments to the plan: every step with its times, every tick with its value."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from benchlab.protocol.groups import Repeat, Segment, Signal
from benchlab.protocol.plan import TICK_PART, Control, Plan, PlanEvent, Step
from benchlab.protocol.stretch import DECIMALS, State, Stretch

Begun = tuple[Stretch, tuple[int, ...], int]
"""A stretch with its counts and line."""


def unroll(
    segments: Sequence[Segment],
    title: str,
    rate_Hz: float,
    limit_MPa: float,
    control: Control | None = None,
    about: str = "",
) -> Plan:
    """The plan of segments in which `survey` found nothing wrong. Raises CannotBeginError where that was not asked.

    A tick belongs to the step in whose time it lies, a tick on a border to the step that begins; the last tick to the last step. Its
    value is the step's at that moment.

    >>> from benchlab.protocol.segments import Hold, Ramp, Vent
    >>> plan = unroll([Ramp(0.3, duration_s=3.0), Hold(1.0), Vent(1.0)], "three", 1.0, 0.35)
    >>> plan.pressure_MPa.round(3).tolist(), plan.step.tolist()
    ([0.0, 0.1, 0.2, 0.3, 0.0, 0.0], [0, 0, 0, 1, 2, 2])
    """
    stretches: list[Stretch] = []
    steps: list[Step] = []
    events: list[PlanEvent] = []
    now_s = 0.0
    for item in _in_order(segments, [State()], ()):
        if isinstance(item, Signal):
            events.append(PlanEvent(now_s, item.kind, item.text))
            continue
        stretch, counts, line = item
        end_s = round(now_s + stretch.duration_s, DECIMALS)
        stretches.append(stretch)
        steps.append(_step(stretch, now_s, end_s, counts, line))
        now_s = end_s
    ticks = math.ceil(now_s * rate_Hz - TICK_PART) + 1
    time_s = np.arange(ticks) / rate_Hz
    pressure_MPa, reference_deg = np.full(ticks, np.nan), np.full(ticks, np.nan)
    owner = np.zeros(ticks, np.int64)
    firsts = [math.ceil(step.start_s * rate_Hz - TICK_PART) for step in steps]
    for index, (stretch, step) in enumerate(zip(stretches, steps)):
        here = slice(firsts[index], firsts[index + 1] if index + 1 < len(firsts) else ticks)
        values = stretch.of(np.clip(time_s[here] - step.start_s, 0.0, stretch.duration_s))
        (reference_deg if stretch.closed_loop else pressure_MPa)[here] = np.clip(values, stretch.low, stretch.high)
        owner[here] = index
    return Plan(
        title,
        rate_Hz,
        limit_MPa,
        tuple(steps),
        tuple(events),
        time_s,
        pressure_MPa,
        reference_deg,
        owner,
        control,
        about,
    )


def _in_order(segments: Sequence[Segment], state: list[State], counts: tuple[int, ...]) -> Iterator[Begun | Signal]:
    """All that happens, as it happens. state: one item, what is known now."""
    for segment in segments:
        match segment:
            case Signal():
                yield segment
            case Repeat():
                for time in range(1, segment.times + 1):
                    yield from _in_order(segment.segments, state, (*counts, time))
            case _:
                for time in range(1, segment.rounds + 1):
                    stretch = segment.begun(state[0])
                    state[0] = stretch.after
                    yield stretch, (*counts, time) if segment.rounds > 1 else counts, segment.line


def _step(stretch: Stretch, start_s: float, end_s: float, counts: tuple[int, ...], line: int) -> Step:
    if stretch.closed_loop:
        return Step(stretch.kind, start_s, end_s, stretch.label, counts, line)
    exact = (stretch.start, stretch.end, stretch.low, stretch.high, stretch.slew)
    return Step(stretch.kind, start_s, end_s, stretch.label, counts, line, *exact)
