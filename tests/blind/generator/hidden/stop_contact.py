"""Outside of the vocabulary: the tip meets something that stands in its way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class StopContact(Hidden):
    """size: 1 − stop/130°. yields: part of the angle beyond the stop that is bent nevertheless."""

    yields: float
    name: ClassVar[str] = "stop_contact"
    bounds: ClassVar[tuple[float, float]] = (1e-3, 0.9)
    typical: ClassVar[float] = 0.2
    known: ClassVar[bool] = False

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, rng.uniform(0.1, 0.4))

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        stop = 130 * (1 - self.size)
        return np.where(angle > stop, stop + self.yields * (angle - stop), angle)
