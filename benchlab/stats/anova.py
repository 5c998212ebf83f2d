"""One-way analysis of variance: the classical one, and Welch's for variances that differ."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from scipy import special

from benchlab.stats.groups import Group
from benchlab.stats.names import listed
from benchlab.stats.noncentral import interval_of_lambda

Interval = tuple[float, float]

NO_SCATTER = "no group has any scatter"


@dataclass(frozen=True)
class OneWay:
    """Fisher's one-way ANOVA. Where no group has scatter, F, p and effect sizes are None and `reason` says so.

    eta_squared: share of the sum of squares that is between groups. omega_squared: the same without its bias.
    interval: of the population's share λ/(λ + N), from the noncentral F distribution (Steiger 2004, Psychol. Methods 9:164).
    """

    F: float | None
    df: tuple[int, int]
    p: float | None
    ss_between: float
    ss_within: float
    eta_squared: float | None
    omega_squared: float | None
    interval: Interval | None
    reason: str | None = None

    @property
    def ms_within(self) -> float:
        return self.ss_within / self.df[1]


@dataclass(frozen=True)
class Welch:
    """Welch's ANOVA (Biometrika 38:330, 1951) of the groups that are not `left_out` for having one sample.

    Where a group has no scatter its weight would be infinite: F, df and p are None and `reason` says so.
    """

    F: float | None
    df: tuple[float, float] | None
    p: float | None
    left_out: tuple[str, ...]
    reason: str | None = None


def one_way(groups: Sequence[Group], confidence: float = 0.95) -> OneWay:
    """Fisher's ANOVA from sizes, means and sums of squares. At least two groups, and more samples than groups.

    >>> from benchlab.stats.groups import group_of
    >>> from decimal import Decimal
    >>> import numpy as np
    >>> a, b = (group_of(name, np.array(values), Decimal(0)) for name, values in (("a", [1.0, 2, 3]), ("b", [4.0, 5, 6])))
    >>> found = one_way([a, b])
    >>> found.F, found.df, round(found.p, 5)
    (13.5, (1, 4), 0.02131)
    """
    total = sum(group.n for group in groups)
    grand = math.fsum(group.n * group.deviation for group in groups) / total
    between = math.fsum(group.n * (group.deviation - grand) ** 2 for group in groups)
    within = math.fsum(group.ss for group in groups)
    a, b = len(groups) - 1, total - len(groups)
    if within == 0:
        same = len({group.deviation for group in groups}) == 1
        reason = f"{NO_SCATTER}, and {'all values are equal' if same else 'the groups differ: exactly, not by a test'}"
        return OneWay(None, (a, b), None, between, 0.0, None, None, None, reason)
    F = (between / a) / (within / b)
    low, high = interval_of_lambda(F, a, b, confidence)
    omega = (between - a * within / b) / (between + within + within / b)
    return OneWay(
        F, (a, b), float(special.fdtrc(a, b, F)), between, within, between / (between + within), max(0.0, omega),
        (low / (low + total), high / (high + total)),
    )  # fmt: skip


def welch(groups: Sequence[Group]) -> Welch:
    """Welch's ANOVA of the groups with two samples or more."""
    left_out = tuple(group.name for group in groups if group.n < 2)
    used = [(group.n, group.deviation, group.ss / (group.n - 1), group.name) for group in groups if group.n > 1]
    flat = [name for _, _, variance, name in used if variance == 0]
    if flat:
        return Welch(None, None, None, left_out, f"not defined: no scatter in {listed(flat)}")
    weights = [n / variance for n, _, variance, _ in used]
    total, k = math.fsum(weights), len(used)
    grand = math.fsum(w * mean for w, (_, mean, _, _) in zip(weights, used)) / total
    spread = math.fsum((1 - w / total) ** 2 / (n - 1) for w, (n, _, _, _) in zip(weights, used))
    between = math.fsum(w * (mean - grand) ** 2 for w, (_, mean, _, _) in zip(weights, used)) / (k - 1)
    F = between / (1 + 2 * (k - 2) / (k * k - 1) * spread)
    df = (float(k - 1), (k * k - 1) / (3 * spread))
    return Welch(F, df, float(special.fdtrc(*df, F)), left_out)
