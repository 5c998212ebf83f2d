"""The bladder takes its share: a neo-Hookean film along with the shell's, or a spring against bending; the cell is solved with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.solved import Family, family


@dataclass(frozen=True)
class BladderStiffness(Hidden):
    """form: film (size: C10 of the bladder times its thickness over 0.3 mm, MPa) or spring (size: so many times 2500 N·mm²)."""

    form: str
    name: ClassVar[str] = "bladder_stiffness"
    bounds: ClassVar[tuple[float, float]] = (1e-3, 1.4)
    typical: ClassVar[float] = 0.2

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, str(rng.choice(["film", "spring"])))

    def parameters(self) -> dict[str, Any]:
        return {"C10_MPa": self.size} if self.form == "film" else {"bending_stiffness_Nmm2": 2500 * self.size}

    def family(self, tw_mm: float, slw_mm: float) -> tuple[Family, float]:
        if self.form == "film":
            return family("bladder_film_MPa", tw_mm, slw_mm), self.size
        return family("bladder_spring_Nmm2", tw_mm, slw_mm), 2500 * self.size
