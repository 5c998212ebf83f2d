"""The regulator's own sensor reads too much or too little, in proportion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class PressureGain(Hidden):
    """size: |a − 1|, reading = a·p."""

    high: bool
    name: ClassVar[str] = "pressure_gain"
    bounds: ClassVar[tuple[float, float]] = (1e-4, 0.25)
    typical: ClassVar[float] = 0.05

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, bool(rng.integers(2)))

    @property
    def same_form(self) -> bool:
        return True

    @property
    def gain(self) -> float:
        return 1 + self.size if self.high else 1 - self.size

    def parameters(self) -> dict[str, Any]:
        return {"gain": self.gain}

    def supplied(self, recorded: FloatArray, at: Station) -> FloatArray:
        return recorded / self.gain

    def recorded(self, supplied: FloatArray, at: Station) -> FloatArray:
        return supplied * self.gain
