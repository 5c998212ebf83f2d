"""Runs that did the same: alike in their turns, rates, pressures and holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.discrepancy.measured import Run
from benchlab.discrepancy.segments import MOST_PIECES, Segment, segments_of

LIKE = 0.3
"""Rates and durations of one kind are within this share of each other."""

LEVEL = 0.07
"""Pressures of one kind are within this share of the largest of the study."""


@dataclass(frozen=True)
class Kind:
    """A kind of run. words: for people. rate_MPa_s: of its loadings, the median, NaN without one. peak_MPa; cycles; hold_s: the longest."""

    words: str
    rate_MPa_s: float
    peak_MPa: float
    cycles: int
    hold_s: float


def kinds_of(runs: Sequence[Run]) -> tuple[tuple[Kind, ...], list[int], list[list[Segment]]]:
    """Kinds, the kind's index of each run, the segments of each run. The result does not depend on the order of the runs."""
    cuts = [_limited(segments_of(run.time_s, run.pressure_MPa)) for run in runs]
    top = max(float(np.max(run.pressure_MPa)) for run in runs)
    order = sorted(range(len(runs)), key=lambda i: (*_signature(cuts[i]), runs[i].design, runs[i].sample, runs[i].run))
    models: list[tuple[list[Segment], float | None]] = []
    kind_of = [0] * len(runs)
    for i in order:
        for number, (model, mounting) in enumerate(models):
            if mounting == runs[i].orientation_deg and _alike(cuts[i], model, top):
                kind_of[i] = number
                break
        else:
            kind_of[i] = len(models)
            models.append((cuts[i], runs[i].orientation_deg))
    return tuple(_kind(model, mounting, top) for model, mounting in models), kind_of, cuts


def _limited(cut: list[Segment]) -> list[Segment]:
    return cut if len(cut) <= MOST_PIECES else []


def _essential(cut: Sequence[Segment]) -> list[Segment]:
    """Without rests: how long somebody waited before and after does not make another kind."""
    return [segment for segment in cut if segment.direction != "rest"]


def _signature(cut: Sequence[Segment]) -> tuple[int, float, float]:
    kept = _essential(cut)
    return (len(kept), *((kept[0].end_MPa, kept[0].duration_s) if kept else (0.0, 0.0)))


def _alike(one: Sequence[Segment], other: Sequence[Segment], top_MPa: float) -> bool:
    a, b = _essential(one), _essential(other)
    if len(a) != len(b):
        return False
    return all(
        x.direction == y.direction
        and abs(x.end_MPa - y.end_MPa) <= LEVEL * top_MPa
        and abs(np.log(max(x.duration_s, 1e-9) / max(y.duration_s, 1e-9))) <= LIKE
        for x, y in zip(a, b)
    )


def _kind(cut: Sequence[Segment], mounting: float | None, top_MPa: float) -> Kind:
    kept = _essential(cut)
    loadings = [segment for segment in kept if segment.direction == "loading"]
    holds = [segment.duration_s for segment in kept if segment.direction == "hold"]
    rate = float(np.median([segment.rate_MPa_s for segment in loadings])) if loadings else np.nan
    peak = max((max(segment.start_MPa, segment.end_MPa) for segment in kept), default=top_MPa)
    cycles = max((segment.cycle for segment in kept), default=1)
    hold = max(holds, default=0.0)
    words = f"to {peak:.2g} MPa" + (f" at {rate:.2g} MPa/s" if loadings else "")
    words += f", {cycles} cycles" if cycles > 1 else ""
    words += f", held {hold:.2g} s" if hold else ""
    words += f", mounted at {mounting:g}°" if mounting is not None else ""
    return Kind(words, rate, peak, cycles, hold)
