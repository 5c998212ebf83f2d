"""All pairs of groups: Tukey's HSD with one variance for all, Games and Howell's with each pair's own; and effect sizes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from benchlab.stats.effect_size import hedges_g
from benchlab.stats.groups import Group
from benchlab.stats.names import shown
from benchlab.stats.studentized_range import FLOOR, StudentizedRange
from benchlab.units import FloatArray

MOST_GROUPS = 40
"""Groups up to which all pairs are compared (780 pairs)."""


@dataclass(frozen=True)
class Pair:
    """Mean of b minus mean of a, its simultaneous interval, and p adjusted for all pairs.

    p_below: the floor where p lies below it (1e-13: noise from there on), else None. Where a test is not defined, low, high and p
    are None and `reason` says why. g: Hedges' effect size of the pair, with its own interval; None without scatter.
    """

    a: str
    b: str
    difference: float
    low: float | None
    high: float | None
    p: float | None
    p_below: float | None
    standard_error: float | None
    df: float | None
    g: float | None
    g_low: float | None
    g_high: float | None
    reason: str | None


def tukey(groups: Sequence[Group], confidence: float = 0.95) -> tuple[Pair, ...]:
    """Tukey's HSD, Tukey–Kramer where sizes differ (Kramer 1956, Biometrics 12:307): groups in order, each with all after it."""
    df = sum(group.n for group in groups) - len(groups)
    variance = math.fsum(group.ss for group in groups) / df
    pairs = list(combinations(groups, 2))
    errors = [math.sqrt(variance * (1 / a.n + 1 / b.n)) for a, b in pairs]
    reason = "no group has any scatter" if variance == 0 else None
    return _compared(pairs, errors, [float(df)] * len(pairs), [reason] * len(pairs), len(groups), confidence)


def games_howell(groups: Sequence[Group], confidence: float = 0.95) -> tuple[Pair, ...]:
    """Games and Howell's test (J. Educ. Stat. 1:113, 1976): each pair with its own variances and Welch–Satterthwaite's df."""
    pairs = list(combinations(groups, 2))
    errors, dfs = [], []
    reasons: list[str | None] = []
    for a, b in pairs:
        reason: str | None
        if lone := [shown(group.name) for group in (a, b) if group.n < 2]:
            error, df, reason = 0.0, 1.0, f"one sample in {' and '.join(lone)}"
        else:
            of_a, of_b = a.ss / (a.n - 1) / a.n, b.ss / (b.n - 1) / b.n
            error = math.sqrt(of_a + of_b)
            reason = None if error > 0 else "no scatter in either group"
            df = (of_a + of_b) ** 2 / (of_a**2 / (a.n - 1) + of_b**2 / (b.n - 1)) if error > 0 else 1.0
        errors.append(error)
        dfs.append(df)
        reasons.append(reason)
    return _compared(pairs, errors, dfs, reasons, len(groups), confidence)


def _compared(
    pairs: Sequence[tuple[Group, Group]],
    errors: Sequence[float],
    dfs: Sequence[float],
    reasons: Sequence[str | None],
    count: int,
    confidence: float,
) -> tuple[Pair, ...]:
    """Pairs with standard errors of their differences, df, and why one is not defined; `count` groups in all."""
    distribution = StudentizedRange(count)
    difference = np.array([b.deviation - a.deviation for a, b in pairs])
    error, df = np.array(errors), np.array(dfs)
    defined = np.array([reason is None for reason in reasons])
    q = math.sqrt(2) * np.abs(difference) / np.where(defined, error, 1.0)
    p = distribution.beyond(q, df)
    half = _critical(distribution, 1 - confidence, df) * error / math.sqrt(2)
    found = []
    for i, (a, b) in enumerate(pairs):
        test: dict[str, float | None] = dict.fromkeys(("low", "high", "p", "p_below", "standard_error", "df"))
        if defined[i]:
            test.update(low=float(difference[i] - half[i]), high=float(difference[i] + half[i]))
            test.update(p=float(p[i]), p_below=FLOOR if p[i] < FLOOR else None)
            test.update(standard_error=float(error[i]), df=float(df[i]))
        effect = hedges_g(a, b, confidence)
        g, g_low, g_high = (None, None, None) if effect is None else (effect.g, effect.low, effect.high)
        found.append(
            Pair(a.name, b.name, float(difference[i]), **test, g=g, g_low=g_low, g_high=g_high, reason=reasons[i])
        )
    return tuple(found)


def _critical(distribution: StudentizedRange, alpha: float, df: FloatArray) -> FloatArray:
    different, places = np.unique(df, return_inverse=True)
    return distribution.critical(alpha, different)[places]
