"""The pressure inside comes after the recorded one, alike for all: a second-order system."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from scipy.signal import bilinear, lfilter

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class RegulatorLag(Hidden):
    """size: the delay 2ζ/ω behind a slow ramp, s. damping: ζ."""

    damping: float
    name: ClassVar[str] = "regulator_lag"
    bounds: ClassVar[tuple[float, float]] = (1e-3, 3.0)
    typical: ClassVar[float] = 0.1

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, rng.uniform(0.8, 1.4))

    def parameters(self) -> dict[str, Any]:
        return {"lag_s": self.size, "damping": self.damping}

    def inside(self, supplied: FloatArray, at: Station) -> FloatArray:
        w = 2 * self.damping / self.size
        b, a = bilinear([w * w], [1, 2 * self.damping * w, w * w], fs=1 / (at.time_s[1] - at.time_s[0]))
        return np.asarray(supplied[0] + lfilter(b, a, supplied - supplied[0], axis=0))
