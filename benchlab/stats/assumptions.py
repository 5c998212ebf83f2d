"""What the classical tests assume, looked at: equal variances and normal residuals. Reported, not used to choose a test."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special, stats

from benchlab.stats.groups import Group

MOST_FOR_SHAPIRO = 5000
"""Values up to which Royston's approximation of Shapiro–Wilk holds."""


@dataclass(frozen=True)
class Levene:
    """Brown and Forsythe's form (about medians; J. Am. Stat. Assoc. 69:364, 1974): F, df, p, or why there is none."""

    F: float | None
    df: tuple[int, int] | None
    p: float | None
    reason: str | None = None


@dataclass(frozen=True)
class Shapiro:
    """Shapiro and Wilk's W and p of the residuals about the group means, or why there is none."""

    W: float | None
    p: float | None
    n: int
    reason: str | None = None


@dataclass(frozen=True)
class Assumptions:
    levene: Levene
    shapiro: Shapiro


def look_at_assumptions(groups: Sequence[Group]) -> Assumptions:
    """Both tests of the samples' values; neither where only means and standard deviations are known."""
    if any(len(group.deviations) == 0 for group in groups):
        reason = "needs the values themselves"
        return Assumptions(Levene(None, None, None, reason), Shapiro(None, None, 0, reason))
    return Assumptions(_levene(groups), _shapiro(groups))


def _levene(groups: Sequence[Group]) -> Levene:
    spreads = [np.abs(group.deviations - np.median(group.deviations)) for group in groups]
    means = [math.fsum(spread) / len(spread) for spread in spreads]
    count = sum(map(len, spreads))
    a, b = len(groups) - 1, count - len(groups)
    grand = math.fsum(math.fsum(spread) for spread in spreads) / count
    between = math.fsum(len(spread) * (mean - grand) ** 2 for spread, mean in zip(spreads, means))
    within = math.fsum(float(((spread - mean) ** 2).sum()) for spread, mean in zip(spreads, means))
    largest = max(float(spread.max()) for spread in spreads)
    if within <= count * (1e-14 * largest) ** 2:
        return Levene(None, None, None, "the distances from the medians do not scatter within any group")
    F = between / a / (within / b)
    return Levene(F, (a, b), float(special.fdtrc(a, b, F)))


def _shapiro(groups: Sequence[Group]) -> Shapiro:
    used = [group for group in groups if group.n > 1]
    residuals = np.concatenate([group.deviations - group.deviation for group in used])
    if sum(group.ss for group in groups) == 0:
        return Shapiro(None, None, len(residuals), "no scatter")
    if not 3 <= len(residuals) <= MOST_FOR_SHAPIRO:
        reason = f"for 3 to {MOST_FOR_SHAPIRO} values, here {len(residuals)}"
        return Shapiro(None, None, len(residuals), reason)
    W, p = stats.shapiro(residuals)
    return Shapiro(float(W), float(p), len(residuals))
