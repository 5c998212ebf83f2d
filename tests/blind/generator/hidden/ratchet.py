"""Outside of the vocabulary: with every cycle a little bend stays, at all pressures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class Ratchet(Hidden):
    """size: degrees that the first cycle leaves in a design that bends to 100°; later cycles leave so much by power of their number."""

    power: float
    name: ClassVar[str] = "ratchet"
    bounds: ClassVar[tuple[float, float]] = (1e-3, 40.0)
    typical: ClassVar[float] = 2.0
    known: ClassVar[bool] = False

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, rng.uniform(0.5, 1.0))

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        cycles = at.memory.get(self.name, np.zeros(effective.shape[1]))
        rising = np.maximum(np.diff(effective, axis=0, prepend=effective[:1]), 0)
        gone = cycles + np.cumsum(rising, axis=0) / 0.35
        at.memory[self.name] = gone[-1]
        largest = np.maximum(angle.max(axis=0), 0) / 100
        return angle + self.size * largest * gone**self.power
