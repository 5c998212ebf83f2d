"""What a law fitted to uniaxial tests says about biaxial tension, where nothing was measured.

A film under pressure is stretched both ways. Rubber-like solids depend mainly on I1 (Treloar 1944), so a law of I1 alone,
W'(I1) from the uniaxial test, is the yardstick: at equal I1 its nominal stresses are in the ratio
(λ_b − λ_b⁻⁵)/(λ_u − λ_u⁻²), whatever W' is.
"""

from __future__ import annotations

import numpy as np

from benchlab.simulation.laws.homogeneous import nominal_stress_MPa
from benchlab.simulation.laws.law import FloatArray, Law

PLAUSIBLE = 2.0
"""Largest factor between a law and the yardstick that is taken for plausible; Treloar's rubber stays below 1.5."""


def biaxial_factor(law: Law, largest_stretch: float) -> float:
    """The factor furthest from 1 between a law's equibiaxial stress and that of a law of I1 alone with its uniaxial stress.

    Looked for at uniaxial stretches from 1.05 to `largest_stretch`; exactly 1 for Neo-Hooke and Yeoh, NaN where a law has
    stresses that are not positive.

    >>> from benchlab.simulation.laws import Polynomial
    >>> round(biaxial_factor(Polynomial(C10=0.5, C20=0.1), 3.0), 9)
    1.0
    """
    uniaxial = np.linspace(1.05, max(largest_stretch, 1.06), 60)
    equibiaxial = _same_first_invariant(uniaxial)
    pulled, blown = nominal_stress_MPa(law, uniaxial), nominal_stress_MPa(law, equibiaxial, "equibiaxial")
    if not ((pulled > 0).all() and (blown > 0).all()):
        return float("nan")
    expected = (equibiaxial - equibiaxial**-5) / (uniaxial - uniaxial**-2)
    factor = blown / pulled / expected
    return float(factor[np.argmax(np.abs(np.log(factor)))])


def _same_first_invariant(uniaxial: FloatArray) -> FloatArray:
    """Equibiaxial stretches λ with 2λ² + λ⁻⁴ equal to I1 = λ_u² + 2/λ_u, by Newton's method from above."""
    I1 = uniaxial**2 + 2 / uniaxial
    stretch = np.sqrt(I1 / 2)
    for _ in range(60):
        stretch = stretch - (2 * stretch**2 + stretch**-4 - I1) / (4 * stretch - 4 * stretch**-5)
    return stretch
