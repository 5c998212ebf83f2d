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
    """A kind of run. words: for people. rates_MPa_s: of its loadings and unloadings, growing; alike ones are one, their median."""

    words: str
    rates_MPa_s: tuple[float, ...] = ()

    def told_rate(self, rate_MPa_s: float) -> float:
        """A segment's rate as it is told, in two digits: that of the kind that is nearest, so that one protocol has one. NaN stays NaN.

        >>> kind = Kind("to 0.35 MPa", (0.0101, 0.1749))
        >>> kind.told_rate(0.153), kind.told_rate(0.0099)
        (0.17, 0.01)
        """
        if not np.isfinite(rate_MPa_s):
            return np.nan
        nearest = min(self.rates_MPa_s, key=lambda rate: abs(np.log(rate / rate_MPa_s)), default=rate_MPa_s)
        return float(f"{nearest:.2g}")


def kinds_of(runs: Sequence[Run]) -> tuple[tuple[Kind, ...], list[int], list[list[Segment]]]:
    """Kinds, the kind's index of each run, the segments of each run. The result does not depend on the order of the runs."""
    cuts = [_limited(segments_of(run.time_s, run.pressure_MPa)) for run in runs]
    top = max(float(np.max(run.pressure_MPa)) for run in runs)
    order = sorted(range(len(runs)), key=lambda i: (*_signature(cuts[i]), runs[i].design, runs[i].sample, runs[i].run))
    models: list[int] = []
    kind_of = [0] * len(runs)
    for i in order:
        for number, model in enumerate(models):
            if runs[model].orientation_deg == runs[i].orientation_deg and _alike(cuts[i], cuts[model], top):
                kind_of[i] = number
                break
        else:
            kind_of[i] = len(models)
            models.append(i)
    return tuple(_kind(runs[model], cuts[model]) for model in models), kind_of, cuts


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


def _kind(run: Run, cut: Sequence[Segment]) -> Kind:
    kept = _essential(cut)
    loadings = _rates(run, kept, ("loading",))
    hold = max((segment.duration_s for segment in kept if segment.direction == "hold"), default=0.0)
    cycles = max((segment.cycle for segment in kept), default=1)
    words = f"to {float(np.max(run.pressure_MPa)):.2g} MPa"
    words += f" at {np.median(loadings):.2g} MPa/s" if loadings else ""
    words += f", loaded {cycles} times" if cycles > 1 else ""
    words += f", held {hold:.2g} s" if hold else ""
    words += f", mounted at {run.orientation_deg:g}°" if run.orientation_deg is not None else ""
    return Kind(words, _apart(_rates(run, kept, ("loading", "unloading"))))


def _rates(run: Run, cut: Sequence[Segment], directions: tuple[str, ...]) -> list[float]:
    """Mean rates from end to end of the recorded pressure, which blunt turns do not lower as they do the medians about the ends."""
    ramps = [segment for segment in cut if segment.direction in directions and segment.duration_s > 0]
    ends = [abs(float(run.pressure_MPa[ramp.last] - run.pressure_MPa[ramp.first])) for ramp in ramps]
    return [change / ramp.duration_s for change, ramp in zip(ends, ramps) if change > 0]


def _apart(rates_MPa_s: Sequence[float]) -> tuple[float, ...]:
    """One of each group of rates that are within LIKE of its smallest: the median."""
    groups: list[list[float]] = []
    for rate in sorted(rates_MPa_s):
        if groups and np.log(rate / groups[-1][0]) <= LIKE:
            groups[-1].append(rate)
        else:
            groups.append([rate])
    return tuple(float(np.median(group)) for group in groups)
