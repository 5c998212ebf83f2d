"""What stands around and between segments: repeats, the train of steps, marks and triggers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from benchlab.protocol.curvature import AngleHold, AngleRamp, AngleSine
from benchlab.protocol.segments import Hold, Ramp, Sine, Triangle, Vent
from benchlab.protocol.stretch import DECIMALS


@dataclass(frozen=True)
class Repeat:
    """Segments, one after the other, so many times."""

    times: int
    segments: tuple[Segment, ...]
    line: int = 0


@dataclass(frozen=True)
class Signal:
    """A mark in the record, or a trigger of the camera: takes no time. kind: mark, trigger."""

    kind: str
    text: str
    line: int = 0


Timed: TypeAlias = Ramp | Hold | Vent | Sine | Triangle | AngleHold | AngleRamp | AngleSine
Segment: TypeAlias = Timed | Repeat | Signal


def levels_of(from_MPa: float, to_MPa: float, step_MPa: float) -> tuple[float, ...]:
    """Levels from one pressure to another, both included, up or down. ValueError where the steps do not end there.

    >>> levels_of(0.1, 0.3, 0.1), levels_of(0.2, 0.0, 0.1)
    ((0.1, 0.2, 0.3), (0.2, 0.1, 0.0))
    """
    count = abs(to_MPa - from_MPa) / step_MPa
    if abs(count - round(count)) > 1e-6:
        raise ValueError(f"steps of {step_MPa:g} MPa from {from_MPa:g} MPa do not end at {to_MPa:g} MPa")
    step = step_MPa if to_MPa >= from_MPa else -step_MPa
    return tuple(round(from_MPa + index * step, DECIMALS) for index in range(round(count) + 1))


def train(levels_MPa: Sequence[float], hold_s: float, rest_s: float, cycles: int, line: int = 0) -> tuple[Segment, ...]:
    """Each level at once, held, and vented for rest_s, `cycles` times before the next level; without a rest, a staircase.

    >>> [item.times for item in train([0.1, 0.2], 1.0, 1.0, 5)]
    [5, 5]
    """
    found: list[Segment] = []
    for level in levels_MPa:
        hold = Hold(hold_s, level, line) if level else Vent(hold_s, line)
        pulse = (hold, Vent(rest_s, line)) if rest_s else (hold,)
        found += [Repeat(cycles, pulse, line)] if cycles > 1 else pulse
    return tuple(found)
