"""The bladder rubs on the shell: a loop that does not ask for the rate, after Dahl (1968) or Bouc and Wen (1976)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Self

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
        return by_history(inside, self._one)

    def _one(self, pressures: list[float]) -> list[float]:
        held, before, found = 0.0, pressures[0], []
        for p in pressures:
            step, most = p - before, max(self.size * p, 1e-6)
            if step and self.form == "dahl":
                # dz = s·(1 − sign(dp)·z/most)·dp, exactly over the step.
                goal = math.copysign(most, step)
                held = goal + (held - goal) * math.exp(-self.stiffness * abs(step) / most)
            elif step:
                part = math.copysign(min(abs(held / most), 2.0) ** self.power, held * step)
                held = min(max(held + self.stiffness * (1 - part) * step, -most), most)
            before = p
            found.append(p - held)
        return found


def by_history(inside: FloatArray, one: Callable[[list[float]], list[float]]) -> FloatArray:
    """(T, S): each different history of pressure gone through once, number by number."""
    histories, which = np.unique(inside, axis=1, return_inverse=True)
    return np.array([one(column.tolist()) for column in histories.T]).T[:, np.ravel(which)]
