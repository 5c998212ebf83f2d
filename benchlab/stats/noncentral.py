"""Intervals of noncentrality: for which noncentral F or t distributions is what was found neither too large nor too small.

Inverted here, as scipy's own inverses are off by 0.6 % for F = 529, stop at λ = 1e4 and do not return for t = 1e6.
"""

from __future__ import annotations

import math

from scipy import optimize, special

_LARGE_LAMBDA, _LARGE_DELTA = 1e6, 1e3
"""Beyond these the numerator's own scatter is left out: it moves an end by less than one part in 1e5."""


def interval_of_lambda(F: float, a: float, b: float, confidence: float) -> tuple[float, float]:
    """(low, high) of the noncentrality λ of an F with a and b degrees of freedom.

    Each end is where the found F lies at the tail (1 − confidence)/2; 0 where no λ does.

    >>> [round(x, 4) for x in interval_of_lambda(5.0, 2, 12, 0.95)], [round(x, 4) for x in interval_of_lambda(5.0, 2, 12, 0.9)]
    ([0.0, 28.3996], [0.6069, 24.4163])
    """
    tail = (1 - confidence) / 2
    if a * F > _LARGE_LAMBDA:
        low, high = (float(a * F * special.chdtri(b, q) / b) for q in (1 - tail, tail))
        return low, high
    top = 100 + 4 * a * F * float(special.chdtri(b, tail / 10)) / b
    return _lambda(F, a, b, 1 - tail, top), _lambda(F, a, b, tail, top)


def _lambda(F: float, a: float, b: float, share: float, top: float) -> float:
    """The λ below `top` at which this share of the distribution lies below F; 0 where even the central one has less there."""
    if special.ncfdtr(a, b, 0.0, F) <= share:
        return 0.0
    return float(optimize.brentq(lambda x: special.ncfdtr(a, b, x, F) - share, 0.0, top, xtol=1e-10, rtol=1e-12))


def interval_of_delta(t: float, df: float, confidence: float) -> tuple[float, float]:
    """(low, high): the noncentralities δ of Student's t with `df` degrees of freedom that do not exclude t.

    >>> [round(x, 4) for x in interval_of_delta(3.0, 8.0, 0.95)], [round(x, 4) for x in interval_of_delta(0.0, 8.0, 0.95)]
    ([0.5064, 5.3762], [-1.96, 1.96])
    """
    if t < 0:
        low, high = interval_of_delta(-t, df, confidence)
        return -high, -low
    tail = (1 - confidence) / 2
    return _delta(t, df, tail), _delta(t, df, 1 - tail)


def _delta(t: float, df: float, share: float) -> float:
    """The δ at which 1 − share of the distribution lies below t >= 0: a quantile of t·√(χ²/df) + Z, Z standard normal.

    Their own quantiles bracket that of the sum.
    """

    def scale(q: float) -> float:
        return math.sqrt(float(special.chdtri(df, 1 - q)) / df)

    if t > _LARGE_DELTA:
        return t * scale(share)
    low, high = (t * scale(q) + float(special.ndtri(q)) for q in (share / 2, (1 + share) / 2))
    return float(optimize.brentq(lambda x: special.nctdtr(df, x, t) - (1 - share), low, high, xtol=1e-10, rtol=1e-12))
