"""Intervals of noncentrality: for which noncentral F or t distributions is what was found neither too large nor too small."""

from __future__ import annotations

import numpy as np
from scipy import optimize, special

from benchlab.units import FloatArray

_LARGE = 1e8


def interval_of_lambda(F: float, a: float, b: float, confidence: float) -> tuple[float, float]:
    """(low, high) of the noncentrality λ of an F with a and b degrees of freedom.

    Each end is where the found F lies at the tail (1 − confidence)/2; 0 where no λ does. Beyond λ of 1e8 the numerator's own
    scatter is left out: λ is then a·F·χ²_b/b.

    >>> [round(x, 4) for x in interval_of_lambda(5.0, 2, 12, 0.95)]
    [0.0985, 26.5597]
    """
    tail = (1 - confidence) / 2
    if a * F > _LARGE:
        low, high = (a * F * special.chdtri(b, q) / b for q in (1 - tail, tail))
        return float(low), float(high)
    return _lambda(F, a, b, 1 - tail), _lambda(F, a, b, tail)


def _lambda(F: float, a: float, b: float, share: float) -> float:
    """λ at which a share of the distribution lies below F; 0 where even the central one has less there."""

    def below(lam: float) -> float:
        return float(special.ncfdtr(a, b, lam, F)) - share

    if below(0.0) <= 0:
        return 0.0
    top = max(1.0, a * F)
    while below(top) > 0:
        top *= 2
    return float(optimize.brentq(below, 0.0, top, xtol=1e-12, rtol=1e-12))


def intervals_of_delta(t: FloatArray, df: FloatArray, confidence: float) -> tuple[FloatArray, FloatArray]:
    """(low, high), shape as t: the noncentralities δ of Student's t with `df` degrees of freedom that do not exclude t.

    >>> low, high = intervals_of_delta(np.array([3.0]), np.array([8.0]), 0.95)
    >>> round(low.item(), 4), round(high.item(), 4)
    (0.6673, 5.2333)
    """
    tail = (1 - confidence) / 2
    size = np.abs(t)
    low, high = special.nctdtrinc(df, 1 - tail, size), special.nctdtrinc(df, tail, size)
    return np.where(t < 0, -high, low), np.where(t < 0, -low, high)
