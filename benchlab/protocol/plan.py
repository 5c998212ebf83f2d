"""The plan: a protocol unrolled, tick by tick. What runs is what was shown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.units import FloatArray


@dataclass(frozen=True)
class Step:
    """One item of a plan. kind: ramp, hold, sine, triangle, vent, curvature. label: in words with units.

    counts: which time round of the enclosing repeats and cycles, outermost first, from 1. line: of the protocol file, 0 unknown.
    """

    kind: str
    start_s: float
    end_s: float
    label: str
    counts: tuple[int, ...] = ()
    line: int = 0


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
    """T ticks at rate_Hz, from 0 s.

    time_s: (T,). pressure_MPa: (T,) asked for, NaN where a controller decides. reference_deg: (T,) bending angle that the controller
    follows, NaN elsewhere. step: (T,) index into steps. limit_MPa: the protocol's own, at most the bench's.
    control: None where no step is closed-loop, or the protocol leaves the gains to the command.
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

    @property
    def duration_s(self) -> float:
        return self.steps[-1].end_s if self.steps else 0.0

    @property
    def closed_loop(self) -> bool:
        return bool(np.isfinite(self.reference_deg).any())
