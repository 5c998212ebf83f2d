"""St Venant and Kirchhoff's sheet: linear between Green-Lagrange strain and second Piola-Kirchhoff stress."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchlab.simulation.laws.law import Energy, FloatArray


@dataclass(frozen=True)
class StVenantKirchhoff:
    """Young's modulus (MPa) and Poisson's ratio; fabric of the paper: 498 MPa and 0.35.

    W = E/(2(1−ν²))·[(tr E)² − 2(1−ν)·det E], with tr E = (a − 2)/2 and det E = (b − a + 1)/4.
    """

    youngs_modulus_MPa: float = 498.0
    poisson_ratio: float = 0.35

    @property
    def incompressible(self) -> bool:
        return False

    @property
    def shear_modulus_MPa(self) -> float:
        return self.youngs_modulus_MPa / (2 * (1 + self.poisson_ratio))

    def energy(self, a: FloatArray, b: FloatArray) -> Energy:
        factor = self.youngs_modulus_MPa / (2 * (1 - self.poisson_ratio**2))
        half = (1 - self.poisson_ratio) / 2
        zero = np.zeros_like(a)
        return Energy(
            W=factor * ((a - 2) ** 2 / 4 - half * (b - a + 1)),
            W_a=factor * ((a - 2) / 2 + half),
            W_b=zero - factor * half,
            W_aa=zero + factor / 2,
            W_ab=zero,
            W_bb=zero,
        )
