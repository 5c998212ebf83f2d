"""Hedges' g: a difference of two means in units of the pair's pooled standard deviation."""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.stats.groups import Group
from benchlab.stats.noncentral import interval_of_delta


@dataclass(frozen=True)
class EffectSize:
    """Hedges' g of b − a with its interval."""

    g: float
    low: float
    high: float


def hedges_g(a: Group, b: Group, confidence: float) -> EffectSize | None:
    """g = J·d with J = Γ(m/2)/(√(m/2)·Γ((m−1)/2)), m = n_a + n_b − 2 (Hedges 1981, J. Educ. Stat. 6:107); its interval from the
    noncentral t distribution, with the same J. None where the pair has no scatter, or fewer than four samples.

    >>> from decimal import Decimal
    >>> import numpy as np
    >>> from benchlab.stats.groups import group_of
    >>> a, b = (group_of(name, np.array(values), Decimal(0)) for name, values in (("a", [1.0, 2, 3]), ("b", [3.0, 4, 5])))
    >>> found = hedges_g(a, b, 0.95)
    >>> round(found.g, 4), round(found.low, 4), round(found.high, 4)
    (1.5958, -0.1196, 3.2069)
    """
    m = a.n + b.n - 2
    ss = a.ss + b.ss
    if m < 2 or ss == 0:
        return None
    d = (b.deviation - a.deviation) / math.sqrt(ss / m)
    root = math.sqrt(1 / a.n + 1 / b.n)
    J = math.exp(math.lgamma(m / 2) - math.lgamma((m - 1) / 2)) / math.sqrt(m / 2)
    low, high = interval_of_delta(d / root, m, confidence)
    return EffectSize(J * d, J * low * root, J * high * root)
