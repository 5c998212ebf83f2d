"""Outside of the vocabulary: past a pressure the strip comes loose for good, and the actuator bends less from then on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class LayerSlip(Hidden):
    """size: part of the angle lost once it has slipped. at_MPa: where it begins, over_MPa: over which it goes on."""

    at_MPa: float
    over_MPa: float
    name: ClassVar[str] = "layer_slip"
    bounds: ClassVar[tuple[float, float]] = (1e-4, 0.8)
    typical: ClassVar[float] = 0.08
    known: ClassVar[bool] = False

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, rng.uniform(0.12, 0.24), rng.uniform(0.01, 0.04))

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        largest = np.maximum(np.maximum.accumulate(effective, axis=0), at.memory.get(self.name, 0.0))
        at.memory[self.name] = largest[-1]
        slipped = np.clip((largest - self.at_MPa) / self.over_MPa, 0, 1)
        return angle * (1 - self.size * slipped)
