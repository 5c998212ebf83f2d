"""The weld takes a margin of every window, not always the same around as along: the cell is solved with what is left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.solved import UNEVEN, Family, family


@dataclass(frozen=True)
class SeamMargin(Hidden):
    """size: the smaller margin, mm. where: even, or around or along larger by a factor of UNEVEN."""

    where: str
    name: ClassVar[str] = "seam_margin"
    bounds: ClassVar[tuple[float, float]] = (1e-3, 0.5)
    typical: ClassVar[float] = 0.1

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, str(rng.choice(["even", "around", "along"])))

    @property
    def same_form(self) -> bool:
        return self.where == "even"

    def parameters(self) -> dict[str, Any]:
        factor = {name: UNEVEN if self.where == name else 1.0 for name in ("around", "along")}
        return {"margin_mm": self.size} | {f"margin_{name}_mm": self.size * f for name, f in factor.items()}

    def family(self, tw_mm: float, slw_mm: float) -> tuple[Family, float]:
        return family(f"seam_{self.where}_mm", tw_mm, slw_mm), self.size
