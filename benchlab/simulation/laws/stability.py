"""Drucker's stability of an incompressible law: every small increment of strain must cost work, dσ:dε > 0.

In logarithmic strains e_i = ln λ_i of a sheet in plane stress, σ_i = ∂W/∂e_i, so the tangent D = ∂σ_i/∂e_j is the Hessian of
W(e1, e2), and the law is stable where D is positive definite (tr D > 0 and det D > 0). This is the test of the Abaqus Theory Guide
4.6.1 ("Drucker stability"), made there, as here, in uniaxial, equibiaxial and planar tension and compression.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.simulation.laws.homogeneous import MODES
from benchlab.simulation.laws.law import FloatArray, Law

BoolArray = NDArray[np.bool_]

SEARCHED = (0.1, 10.0)
"""Stretches between which stability is looked for, unless said otherwise."""

_STEPS = 800


@dataclass(frozen=True)
class StableRange:
    """Where a law is stable around the undeformed state in one test: driven stretches from `low` to `high`.

    low_found, high_found: whether the law turns unstable there; otherwise it is the end of what was searched.
    """

    mode: str
    low: float
    high: float
    low_found: bool
    high_found: bool

    def covers(self, low: float, high: float) -> bool:
        """Whether the law is stable at all stretches of an interval."""
        return self.low <= low and high <= self.high


def tangent_MPa(law: Law, first: FloatArray, second: FloatArray) -> FloatArray:
    """Material tangent D = ∂²W/∂e_i∂e_j at in-plane stretches of one shape; shape (..., 2, 2).

    >>> from benchlab.simulation.laws import Polynomial
    >>> one = np.array(1.0)
    >>> tangent_MPa(Polynomial(C10=0.5), one, one).tolist()  # μ·[[4, 2], [2, 4]]
    [[4.0, 2.0], [2.0, 4.0]]
    """
    s, m, q = _sums(law, first, second)
    mean, shear = (s + q) / 4, (s - q) / 4
    return np.stack([np.stack([mean + m / 2, shear], -1), np.stack([shear, mean - m / 2], -1)], -2)


def is_stable(law: Law, stretch: FloatArray, mode: str) -> BoolArray:
    """Whether the tangent is positive definite at each driven stretch of a test; bool, shape of `stretch`."""
    with np.errstate(over="ignore", invalid="ignore"):
        s, m, q = _sums(law, *MODES[mode](np.asarray(stretch, dtype=float)))
        return np.logical_and(np.logical_and(s > 0, q > 0), s * q > m * m)


def _sums(law: Law, first: FloatArray, second: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """D along (1, 1) and (1, −1): D11 + D22 + 2·D12, D11 − D22, D11 + D22 − 2·D12.

    From a = x + y, b = x·y with x, y = exp(2·e): a_i = 2x, 2y; b_i = 2b; a_ii = 4x, 4y; b_ij = 4b. In these sums the stress
    across the sheet, which may be larger by many orders, does not cancel.
    """
    x, y = np.asarray(first, dtype=float) ** 2, np.asarray(second, dtype=float) ** 2
    a, b = x + y, x * y
    at = law.energy(a, b)
    s = 4 * (at.W_aa * a**2 + 4 * at.W_ab * a * b + at.W_a * a + 4 * b * (at.W_bb * b + at.W_b))
    m = 4 * (x - y) * (at.W_aa * a + 2 * at.W_ab * b + at.W_a)
    q = 4 * (at.W_aa * (x - y) ** 2 + at.W_a * a)
    return s, m, q


def stable_ranges(law: Law, searched: tuple[float, float] = SEARCHED) -> tuple[StableRange, ...]:
    """The range of driven stretches around 1 in which the law is stable, for each of MODES.

    Looked for on 800 logarithmic steps either side of 1, then bisected: a gap narrower than a step may be missed.

    >>> from benchlab.simulation.laws import Polynomial
    >>> [r.high_found for r in stable_ranges(Polynomial(C10=0.5))]
    [False, False, False]
    """
    ranges = []
    for mode in MODES:
        low, low_found = _limit(law, mode, searched[0])
        high, high_found = _limit(law, mode, searched[1])
        ranges.append(StableRange(mode, low, high, low_found, high_found))
    return tuple(ranges)


def _limit(law: Law, mode: str, end: float) -> tuple[float, bool]:
    """The last stable stretch from 1 towards `end`, and whether it is unstable beyond."""
    steps = np.geomspace(1.0, end, _STEPS + 1)
    unstable = np.flatnonzero(np.logical_not(is_stable(law, steps, mode)))
    if not unstable.size:
        return float(end), False
    if unstable[0] == 0:
        return 1.0, True
    good, bad = float(steps[unstable[0] - 1]), float(steps[unstable[0]])
    for _ in range(40):
        middle = (good * bad) ** 0.5
        good, bad = (middle, bad) if is_stable(law, np.array(middle), mode) else (good, middle)
    return good, True
