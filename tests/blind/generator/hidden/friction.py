"""The bladder rubs on the shell: a loop that does not ask for the rate, after Dahl (1968) or Bouc and Wen (1976)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station



@dataclass(frozen=True)
class Friction(Hidden):
    """size: friction over pressure, where it slides. stiffness: over the pressure's, before it slides. power: of Bouc and Wen."""

    form: str
    stiffness: float
    power: float
    name: ClassVar[str] = "friction"
    bounds: ClassVar[tuple[float, float]] = (1e-4, 0.5)
    typical: ClassVar[float] = 0.04

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, str(rng.choice(["dahl", "bouc-wen"])), rng.uniform(0.3, 1.0), rng.uniform(1.3, 2.0))

    def effective(self, inside: FloatArray, at: Station) -> FloatArray:
        held = np.zeros(inside.shape[1])
        found = np.empty_like(inside)
        found[0] = inside[0]
        for i in range(1, len(inside)):
            step = inside[i] - inside[i - 1]
            most = np.maximum(self.size * inside[i], 1e-6)
            if self.form == "dahl":
                # dz = s·(1 − sign(dp)·z/most)·dp, exactly over the step.
                goal = np.sign(step) * most
                held = np.where(step == 0, held, goal + (held - goal) * np.exp(-self.stiffness * np.abs(step) / most))
            else:
                part = np.abs(held / most) ** self.power * np.sign(held * step)
                slope = self.stiffness * np.clip(1 - part, -4, 2)
                held = np.clip(held + slope * step, -most, most)
            found[i] = inside[i] - held
        return found
