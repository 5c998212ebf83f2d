"""Mandel's h and k: which laboratory's mean, and which one's scatter, stands out (ASTM E691, ISO 5725-2)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from scipy import special

from benchlab.stats.groups import Group, mean_of

SIGNIFICANCE = 0.005
"""Of both critical values, as in E691."""


@dataclass(frozen=True)
class Cell:
    """One laboratory at one level. h: its mean from the level's, over the standard deviation of means; k: its standard deviation over
    the pooled one. None where not defined. outside: beyond a critical value."""

    level: str
    laboratory: str
    n: int
    mean: float
    sd: float | None
    h: float | None
    h_critical: float | None
    k: float | None
    k_critical: float | None

    @property
    def outside(self) -> bool:
        return bool(
            (self.h is not None and self.h_critical is not None and abs(self.h) > self.h_critical)
            or (self.k is not None and self.k_critical is not None and self.k > self.k_critical)
        )


def consistency(level: str, laboratories: Sequence[Group], compare_means: bool) -> tuple[Cell, ...]:
    """Cells of one level: laboratories with their replicates. h needs three laboratories, k two with two replicates or more."""
    p = len(laboratories)
    means = [laboratory.deviation for laboratory in laboratories]
    centre = mean_of(means) if means else 0.0
    spread = math.sqrt(math.fsum((mean - centre) ** 2 for mean in means) / (p - 1)) if p > 1 else 0.0
    use_h = compare_means and p > 2 and spread > 0
    df = sum(laboratory.n - 1 for laboratory in laboratories)
    pooled = math.sqrt(math.fsum(laboratory.ss for laboratory in laboratories) / df) if df else 0.0
    cells = []
    for laboratory in laboratories:
        own = laboratory.n - 1
        use_k = pooled > 0 and own > 0 and df > own
        cells.append(
            Cell(
                level, laboratory.name, laboratory.n, laboratory.mean, laboratory.sd,
                (laboratory.deviation - centre) / spread if use_h else None, h_critical(p) if use_h else None,
                math.sqrt(laboratory.ss / own) / pooled if use_k else None, k_critical(own, df - own) if use_k else None,
            )
        )  # fmt: skip
    return tuple(cells)


def h_critical(p: int, significance: float = SIGNIFICANCE) -> float:
    """|h| that one of p >= 3 laboratories exceeds with this probability: (p − 1)·t/√(p·(t² + p − 2)), t with p − 2.

    >>> round(h_critical(8), 2)
    2.15
    """
    t = float(special.stdtrit(p - 2, 1 - significance / 2))
    return (p - 1) * t / math.sqrt(p * (t * t + p - 2))


def k_critical(own: int, others: int, significance: float = SIGNIFICANCE) -> float:
    """k that a laboratory with `own` degrees of freedom beside `others` exceeds with this probability.

    With p laboratories of n replicates it is √(p/(1 + (p − 1)/F)), F with n − 1 and (p − 1)(n − 1).

    >>> round(k_critical(2, 14), 2)
    2.06
    """
    F = float(special.fdtri(own, others, 1 - significance))
    return math.sqrt((own + others) / (own + others / F))
