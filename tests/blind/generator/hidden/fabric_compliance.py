"""The fabric is not as stiff, or stiffer, than 498 MPa: the cell is solved with what it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.solved import Family, family

NOMINAL_MPa = 498.0


@dataclass(frozen=True)
class FabricCompliance(Hidden):
    """size: |ln(E/498 MPa)|; softer or stiffer."""

    softer: bool
    name: ClassVar[str] = "fabric_compliance"
    bounds: ClassVar[tuple[float, float]] = (1e-3, 1.1)
    typical: ClassVar[float] = 0.3

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, bool(rng.integers(2)))

    @property
    def same_form(self) -> bool:
        return True

    @property
    def modulus_MPa(self) -> float:
        return float(NOMINAL_MPa * np.exp(-self.size if self.softer else self.size))

    def parameters(self) -> dict[str, Any]:
        return {"fabric_modulus_MPa": self.modulus_MPa}

    def family(self, tw_mm: float, slw_mm: float) -> tuple[Family, float]:
        return family("fabric_modulus_MPa", tw_mm, slw_mm), self.modulus_MPa
