"""Where the scatter comes from: cycles of one sample, samples of one design, designs.

Expected mean squares where all samples have as many cycles, restricted maximum likelihood (REML) otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special

from benchlab.stats.groups import Group, mean_of, squares_about
from benchlab.stats.reml import reml_variances
from benchlab.units import FloatArray

Cycles = Mapping[str, Mapping[str, FloatArray]]


@dataclass(frozen=True)
class Component:
    """A variance, not below 0; `raw` is the estimate before it was set to 0. low and high: interval of the standard deviation, None
    where there is none. df: degrees of freedom that it rests on."""

    variance: float
    raw: float
    low: float | None
    high: float | None
    df: int

    @property
    def sd(self) -> float:
        return math.sqrt(self.variance)


@dataclass(frozen=True)
class Components:
    """cycle: within a sample; None where samples have one row. sample: between samples of a design; without cycles it holds theirs
    too. design: between designs as if drawn at random, which chosen ones are not: a description. method: EMS or REML."""

    method: str
    cycle: Component | None
    sample: Component
    design: Component
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class WithinSamples:
    """Squares of cycles about their sample's mean, pooled: `ss` with `df`; harmonic mean of the cycles a sample."""

    ss: float
    df: int
    cycles: float
    balanced: bool

    @property
    def ms(self) -> float:
        return self.ss / self.df


def within_samples(rows: Sequence[FloatArray]) -> WithinSamples:
    """Pooled over samples, each with its cycles, shape (n,)."""
    sizes = [len(row) for row in rows]
    ss = math.fsum(squares_about(row, mean_of(row.tolist())) for row in rows)
    harmonic = len(sizes) / math.fsum(1 / size for size in sizes)
    return WithinSamples(ss, sum(sizes) - len(sizes), harmonic, len(set(sizes)) == 1)


def find_components(groups: Sequence[Group], cycles: Cycles | None, confidence: float = 0.95) -> Components:
    """Components from groups of sample means and, where samples have cycles, the cycles.

    Intervals: chi-square for the lowest component; Williams' for the others (Biometrika 49:278, 1962), with unweighted means and
    the harmonic mean of the sizes where those differ (Thomas and Hultquist 1978, Ann. Stat. 6:582).
    """
    total = sum(group.n for group in groups)
    df_samples = total - len(groups)
    ms_samples = math.fsum(group.ss for group in groups) / df_samples
    design = _design(groups, ms_samples, df_samples, confidence)
    within = (
        None if cycles is None else within_samples([row for samples in cycles.values() for row in samples.values()])
    )
    if cycles is None or within is None or within.df == 0:
        sample = _lowest(ms_samples, df_samples, confidence)
        return Components("EMS", None, sample, design, _warnings(group=design))
    cycle = _lowest(within.ms, within.df, confidence)
    sample = _between(ms_samples, df_samples, within.ms / within.cycles, within.df, 1.0, confidence)
    if within.balanced or within.ss == 0:
        return Components("EMS", cycle, sample, design, _warnings(sample=sample, group=design))
    of_cycle, of_sample = reml_variances(cycles)
    cycle = Component(of_cycle, of_cycle, cycle.low, cycle.high, cycle.df)
    sample = Component(of_sample, of_sample, sample.low, sample.high, sample.df)
    return Components("REML", cycle, sample, design, _warnings(sample=sample, group=design))


def _design(groups: Sequence[Group], ms_samples: float, df_samples: int, confidence: float) -> Component:
    means = np.array([group.deviation for group in groups])
    size = len(groups) / math.fsum(1 / group.n for group in groups)
    ms = squares_about(means, mean_of(means.tolist())) / (len(groups) - 1)
    return _between(ms, len(groups) - 1, ms_samples / size, df_samples, 1.0, confidence)


def _lowest(ms: float, df: int, confidence: float) -> Component:
    tail = (1 - confidence) / 2
    low, high = (math.sqrt(ms * df / float(special.chdtri(df, q))) for q in (tail, 1 - tail))
    return Component(ms, ms, low, high, df)


def _between(upper: float, df: int, lower: float, df_lower: int, size: float, confidence: float) -> Component:
    """(upper − lower)/size of two mean squares with df and df_lower degrees of freedom."""
    raw = (upper - lower) / size
    if upper == 0:
        return Component(max(0.0, raw), raw, 0.0, None, df)
    tail = (1 - confidence) / 2
    ends = []
    for q in (tail, 1 - tail):  # chi-square and F exceeded with probability q
        F = float(special.fdtri(df, df_lower, 1 - q))
        ends.append(max(0.0, df * (upper - lower * F) / size / float(special.chdtri(df, q))))
    return Component(max(0.0, raw), raw, math.sqrt(ends[0]), math.sqrt(ends[1]), df)


def _warnings(**components: Component) -> tuple[str, ...]:
    return tuple(
        f"the variance between {name}s came out negative ({component.raw:.3g}) and is set to 0: what is below scatters more"
        for name, component in components.items()
        if component.raw < 0
    )
