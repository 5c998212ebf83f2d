"""The regulator's own sensor reads too much or too little, by the same everywhere; no pressure is below none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class PressureOffset(Hidden):
    """size: |b| in MPa, reading = p + b."""

    high: bool
    name: ClassVar[str] = "pressure_offset"
    bounds: ClassVar[tuple[float, float]] = (1e-5, 0.08)
    typical: ClassVar[float] = 0.006

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, bool(rng.integers(2)))

    @property
    def same_form(self) -> bool:
        return True

    @property
    def offset_MPa(self) -> float:
        return self.size if self.high else -self.size

    def parameters(self) -> dict[str, Any]:
        return {"offset_MPa": self.offset_MPa}

    def supplied(self, recorded: FloatArray, at: Station) -> FloatArray:
        return np.maximum(recorded - self.offset_MPa, 0)

    def recorded(self, supplied: FloatArray, at: Station) -> FloatArray:
        return supplied + self.offset_MPa
