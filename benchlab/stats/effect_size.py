"""Hedges' g: a difference of two means in units of the pair's pooled standard deviation."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy import special

from benchlab.stats.groups import Group
from benchlab.stats.noncentral import intervals_of_delta
from benchlab.units import FloatArray


def hedges_g(pairs: Sequence[tuple[Group, Group]], confidence: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(g, low, high), each a value a pair, of b − a; NaN where the pair has no scatter.

    g = J·d with J = Γ(m/2)/(√(m/2)·Γ((m−1)/2)), m = n_a + n_b − 2 (Hedges 1981, J. Educ. Stat. 6:107); its interval from the
    noncentral t distribution, with the same J.
    """
    difference = np.array([b.deviation - a.deviation for a, b in pairs])
    m = np.array([float(a.n + b.n - 2) for a, b in pairs])
    pooled = np.array([math.sqrt((a.ss + b.ss) / (a.n + b.n - 2)) if a.n + b.n > 2 else 0.0 for a, b in pairs])
    root = np.array([math.sqrt(1 / a.n + 1 / b.n) for a, b in pairs])
    found = np.full((3, len(pairs)), np.nan)
    kept = (pooled > 0) & (m > 1)
    if kept.any():
        m, root = m[kept], root[kept]
        d = difference[kept] / pooled[kept]
        J = np.exp(special.gammaln(m / 2) - special.gammaln((m - 1) / 2)) / np.sqrt(m / 2)
        low, high = intervals_of_delta(d / root, m, confidence)
        found[:, kept] = J * d, J * low * root, J * high * root
    return found[0], found[1], found[2]
