"""The three homogeneous tension tests of an incompressible sheet: uniaxial, equibiaxial, planar (pure shear).

Each is a path (λ1, λ2)(λ) of in-plane stretches, λ the one that the machine drives.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchlab.simulation.laws.law import FloatArray, Law

MODES: dict[str, Callable[[FloatArray], tuple[FloatArray, FloatArray]]] = {
    "uniaxial": lambda stretch: (stretch, stretch**-0.5),
    "equibiaxial": lambda stretch: (stretch, stretch),
    "planar": lambda stretch: (stretch, np.ones_like(stretch)),
}
"""In-plane stretches of each test at the driven stretch λ."""


def nominal_stress_MPa(law: Law, stretch: FloatArray, mode: str = "uniaxial") -> FloatArray:
    """Force over undeformed cross-section along the driven direction, shape of `stretch`; `mode` one of MODES.

    ∂W/∂λ1 = 2·λ1·(W_a + λ2²·W_b), because a = λ1² + λ2² and b = λ1²·λ2²; the stress across the sheet is zero by the
    laws' plane stress, the one across a uniaxial strip by its transverse stretch.

    >>> from benchlab.simulation.laws import Polynomial
    >>> round(float(nominal_stress_MPa(Polynomial(C10=1.0), np.array(2.0), "equibiaxial")), 5)  # 2·C10·(λ − λ⁻⁵)
    3.9375
    """
    first, second = MODES[mode](np.asarray(stretch, dtype=float))
    at = law.energy(first**2 + second**2, first**2 * second**2)
    return 2 * first * (at.W_a + second**2 * at.W_b)
