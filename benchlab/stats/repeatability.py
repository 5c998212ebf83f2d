"""Repeatability and reproducibility after ISO 5725-2 and ASTM E691.

What plays which role: a design is a level (a "material"). Where samples have cycles, a sample stands for a laboratory and its cycles
are the replicates: s_r is the scatter of cycles, s_R that of one reading of any sample. Where they have none, samples are the
replicates of one laboratory: s_r is the scatter of samples, and there is no s_R.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from benchlab.stats.components import Components, Cycles, within_samples
from benchlab.stats.consistency import Cell, consistency
from benchlab.stats.groups import Group, group_of

FACTOR = 2.8
"""Limit over standard deviation, 1.96·√2 rounded as ISO 5725-6 rounds it: two results differ by more in 5 % of cases."""


@dataclass(frozen=True)
class Precision:
    """s_r and, where there are laboratories, s_R; r and R are 2.8 times those. name: the design, or "" for all together."""

    name: str
    s_r: float | None
    s_R: float | None

    @property
    def r(self) -> float | None:
        return None if self.s_r is None else FACTOR * self.s_r

    @property
    def R(self) -> float | None:
        return None if self.s_R is None else FACTOR * self.s_R


@dataclass(frozen=True)
class Repeatability:
    """replicate: "cycle" or "sample". s_low, s_high: interval of the pooled s_r. sample_sd: pooled standard deviation of samples (of
    the means of their cycles) about their design's mean, the one that the paper gives. cells: h and k, see `consistency`."""

    replicate: str
    pooled: Precision
    s_low: float | None
    s_high: float | None
    sample_sd: float
    designs: tuple[Precision, ...]
    cells: tuple[Cell, ...]


def find_repeatability(groups: Sequence[Group], cycles: Cycles | None, components: Components) -> Repeatability:
    """From groups of samples, their cycles where they have some, and the components found of them."""
    df = sum(group.n for group in groups) - len(groups)
    sample_sd = math.sqrt(math.fsum(group.ss for group in groups) / df)
    if cycles is None or components.cycle is None:
        pooled = Precision("", components.sample.sd, None)
        designs = tuple(Precision(group.name, group.sd, None) for group in groups)
        ends = components.sample.low, components.sample.high
        cells = consistency("", [group for group in groups if group.n > 1], compare_means=False)
        return Repeatability("sample", pooled, *ends, sample_sd, designs, cells)
    pooled = Precision("", components.cycle.sd, math.hypot(components.cycle.sd, components.sample.sd))
    designs = tuple(_of_design(group, cycles) for group in groups)
    found = [
        cell
        for group in groups
        for cell in consistency(
            group.name,
            [group_of(name, row, group.origin) for name, row in cycles[group.name].items()],
            compare_means=True,
        )
    ]
    ends = components.cycle.low, components.cycle.high
    return Repeatability("cycle", pooled, *ends, sample_sd, designs, tuple(found))


def _of_design(group: Group, cycles: Cycles) -> Precision:
    within = within_samples(list(cycles[group.name].values()))
    if within.df == 0:
        return Precision(group.name, None, None)
    if group.variance is None:
        return Precision(group.name, math.sqrt(within.ms), None)
    between = max(0.0, group.variance - within.ms / within.cycles)
    return Precision(group.name, math.sqrt(within.ms), math.sqrt(between + within.ms))
