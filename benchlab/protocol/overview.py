"""A plan in few numbers: what it asks for at most, how fast, how often it jumps, and its steps with alike ones together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchlab.protocol.plan import Plan, Step
from benchlab.protocol.stretch import DECIMALS


@dataclass(frozen=True)
class AlikeSteps:
    """Steps of one line of the file that do the same. first_s: when the first begins. times: how many there are.

    slew_MPa_per_s: the steepest slope within, None in closed loop. jumps_MPa: the smallest and largest by which they begin, from the
    pressure before to their first; 0 where it goes on, None where all of that is a controller's.
    """

    first_s: float
    kind: str
    label: str
    duration_s: float
    times: int
    line: int
    slew_MPa_per_s: float | None
    jumps_MPa: tuple[float, float] | None


@dataclass(frozen=True)
class Overview:
    """Numbers of a whole plan. peak_MPa, slew_MPa_per_s: exact, of the steps in open loop; None where there are none. slew is within
    steps: what jumps at once is counted as rises and falls, with the largest of each. reference_deg: lowest and highest, None in open loop.
    """

    peak_MPa: float | None
    slew_MPa_per_s: float | None
    rises: int
    largest_rise_MPa: float
    falls: int
    largest_fall_MPa: float
    reference_deg: tuple[float, float] | None
    steps: tuple[AlikeSteps, ...]


def overview(plan: Plan) -> Overview:
    """What a reader of a plan wants to know first.

    >>> from benchlab.protocol.segments import Hold, Ramp, Vent
    >>> from benchlab.protocol.unroll import unroll
    >>> found = overview(unroll([Ramp(0.3, duration_s=3.0), Hold(1.0), Vent(1.0)], "three", 100.0, 0.35))
    >>> found.peak_MPa, round(found.slew_MPa_per_s, 9), found.rises, found.falls, found.largest_fall_MPa
    (0.3, 0.1, 0, 1, 0.3)
    """
    jumps = _jumps(plan.steps)
    known = [jump for jump in jumps if jump]
    highest = [step.high_MPa for step in plan.steps if step.high_MPa is not None]
    slews = [step.slew_MPa_per_s for step in plan.steps if step.slew_MPa_per_s is not None]
    reference = plan.reference_deg[np.isfinite(plan.reference_deg)]
    return Overview(
        peak_MPa=max(highest, default=None),
        slew_MPa_per_s=max(slews, default=None),
        rises=sum(jump > 0 for jump in known),
        largest_rise_MPa=max(0.0, *known, 0.0),
        falls=sum(jump < 0 for jump in known),
        largest_fall_MPa=max(0.0, *(-jump for jump in known), 0.0),
        reference_deg=(float(reference.min()), float(reference.max())) if len(reference) else None,
        steps=_alike(plan.steps, jumps),
    )


def _jumps(steps: tuple[Step, ...]) -> list[float | None]:
    """By how much the pressure jumps as each step begins; before the first it is 0."""
    before: float | None = 0.0
    found: list[float | None] = []
    for step in steps:
        found.append(None if before is None or step.start_MPa is None else round(step.start_MPa - before, DECIMALS))
        before = step.end_MPa
    return found


def _alike(steps: tuple[Step, ...], jumps: list[float | None]) -> tuple[AlikeSteps, ...]:
    """In the order in which the first of each comes."""
    found: dict[tuple[int, str], list[int]] = {}
    for index, step in enumerate(steps):
        found.setdefault((step.line, step.label), []).append(index)
    return tuple(
        AlikeSteps(
            first_s=(first := steps[indices[0]]).start_s,
            kind=first.kind,
            label=first.label,
            duration_s=round(first.end_s - first.start_s, 9),
            times=len(indices),
            line=first.line,
            slew_MPa_per_s=first.slew_MPa_per_s,
            jumps_MPa=_extremes([jumps[index] for index in indices]),
        )
        for indices in found.values()
    )


def _extremes(jumps: list[float | None]) -> tuple[float, float] | None:
    known = sorted((jump for jump in jumps if jump is not None), key=abs)
    return (known[0], known[-1]) if known else None
