"""What every law gives: the strain energy of a sheet in the invariants of its in-plane deformation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Energy:
    """Strain energy per reference volume (MPa) and its derivatives in a = tr C and b = det C; arrays of one shape."""

    W: FloatArray
    W_a: FloatArray
    W_b: FloatArray
    W_aa: FloatArray
    W_ab: FloatArray
    W_bb: FloatArray


class Law(Protocol):
    """An isotropic sheet in plane stress.

    incompressible: it keeps its volume, so that its thickness stretch is b^(-1/2); otherwise the thickness is taken to stay.
    """

    @property
    def incompressible(self) -> bool: ...

    def energy(self, a: FloatArray, b: FloatArray) -> Energy:
        """Strain energy and derivatives at a = tr C, b = det C > 0."""
        ...

    @property
    def shear_modulus_MPa(self) -> float:
        """Shear modulus of the undeformed material."""
        ...


def uniaxial_stress_MPa(law: Law, stretch: FloatArray) -> FloatArray:
    """Nominal stress of an incompressible law in uniaxial tension, shape of `stretch`: dW/dλ along a = λ² + 1/λ, b = λ.

    >>> from benchlab.simulation.laws import Polynomial
    >>> round(float(uniaxial_stress_MPa(Polynomial(C10=1.0), np.array(2.0))), 3)  # 2·C10·(λ − λ⁻²)
    3.5
    """
    stretch = np.asarray(stretch, dtype=float)
    at = law.energy(stretch**2 + 1 / stretch, stretch)
    return at.W_a * (2 * stretch - stretch**-2) + at.W_b
