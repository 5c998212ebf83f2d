"""The plan: a protocol unrolled, tick by tick. What runs is what was shown."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.units import FloatArray

TICK_PART = 1e-6
"""Part of a tick by which a step may begin late, or an event be due, and still have it."""


@dataclass(frozen=True)
class Step:
    """One item of a plan. kind: ramp, hold, sine, triangle, vent, curvature. label: in words with units.

    counts: which time round of the enclosing repeats and cycles, outermost first, from 1. line: of the protocol file, 0 unknown.
    start, end, low, high, slew: exact, in MPa and MPa/s; None in closed loop. slew: the steepest slope within the step, either way.
    """

    kind: str
    start_s: float
    end_s: float
    label: str
    counts: tuple[int, ...] = ()
    line: int = 0
    start_MPa: float | None = None
    end_MPa: float | None = None
    low_MPa: float | None = None
    high_MPa: float | None = None
    slew_MPa_per_s: float | None = None


@dataclass(frozen=True)
class PlanEvent:
    """A mark, or a trigger of the camera, at the first tick at or after time_s. kind: mark, trigger."""

    time_s: float
    kind: str
    text: str = ""


@dataclass(frozen=True)
class Control:
    """How a closed-loop step is controlled. Gains in MPa per degree and MPa per degree and second.

    feed_forward: whether the inverse of the simulated response curve is added. lead_s: how far ahead of time it looks.
    """

    kp_MPa_per_deg: float
    ki_MPa_per_deg_s: float
    feed_forward: bool = False
    lead_s: float = 0.0


@dataclass(frozen=True)
class Plan:
    """T ticks at rate_Hz, from 0 s; the last is the first at or after the end of the last step.

    time_s: (T,). pressure_MPa: (T,) asked for, NaN where a controller decides. reference_deg: (T,) bending angle that the controller
    follows, NaN elsewhere. step: (T,) index into steps. limit_MPa: the protocol's own; the bench's ceiling holds besides.
    control: None where no step is closed-loop, or the protocol leaves the gains to the command. about: what it is for.
    """

    title: str
    rate_Hz: float
    limit_MPa: float
    steps: tuple[Step, ...]
    events: tuple[PlanEvent, ...]
    time_s: FloatArray
    pressure_MPa: FloatArray
    reference_deg: FloatArray
    step: NDArray[np.int64]
    control: Control | None = None
    about: str = ""

    @property
    def duration_s(self) -> float:
        """Until the end of the last step."""
        return self.steps[-1].end_s if self.steps else 0.0

    @property
    def closed_loop(self) -> bool:
        """Whether a controller decides the pressure anywhere."""
        return bool(np.isfinite(self.reference_deg).any())

    def events_by_tick(self) -> dict[int, list[PlanEvent]]:
        """Marks and triggers by the tick that they come at, the first at or after their time; those after the last tick, at the last."""
        found: dict[int, list[PlanEvent]] = {}
        for event in self.events:
            tick = min(math.ceil(event.time_s * self.rate_Hz - TICK_PART), len(self.time_s) - 1)
            found.setdefault(tick, []).append(event)
        return found

    @property
    def ends_vented(self) -> bool:
        """Whether the protocol itself ends at 0 MPa; the runner vents in any case."""
        return bool(len(self.pressure_MPa) and self.pressure_MPa[-1] == 0)
