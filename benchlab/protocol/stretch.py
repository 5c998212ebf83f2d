"""A segment that has begun: known start, known end, and a value for every moment between."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from benchlab.units import FloatArray

DECIMALS = 9
"""Pressures (MPa), angles (degrees) and times (s) are rounded to a billionth: 3 · 0.1 MPa is 0.3 MPa, and no limit is crossed by a bit."""


@dataclass(frozen=True)
class State:
    """What is known when a segment begins. pressure_MPa: None after closed loop. reference_deg: None where nobody knows the angle.

    A protocol begins vented: 0 MPa, and 0° as the angle that a reference starts from.
    """

    pressure_MPa: float | None = 0.0
    reference_deg: float | None = 0.0


@dataclass(frozen=True)
class Stretch:
    """One round of a segment, begun at a state: it becomes one step of the plan.

    start, end, low, high, slew: pressure in MPa and MPa/s, in closed loop angle in degrees and degrees/s; all exact, not sampled. slew:
    the steepest slope within, either way; a jump at the start is none. of: values (n,) at times (n,) since the start, from 0
    to duration_s.
    """

    kind: str
    label: str
    duration_s: float
    start: float
    end: float
    low: float
    high: float
    slew: float
    of: Callable[[FloatArray], FloatArray]
    closed_loop: bool = False

    @property
    def after(self) -> State:
        """What is known when it has ended."""
        if self.closed_loop:
            return State(None, self.end)
        return State(self.end, 0.0 if self.end == 0 else None)


class CannotBeginError(ValueError):
    """A segment that cannot begin where the one before it ended. what, remedy: in words."""

    def __init__(self, what: str, remedy: str) -> None:
        self.what, self.remedy = what, remedy
        super().__init__(f"{what}; {remedy}")


def slope(change: float, duration_s: float) -> float:
    """Steepness of a change, without a sign, rounded; infinite where it takes no time."""
    return round(abs(change) / duration_s, DECIMALS) if duration_s else math.inf
