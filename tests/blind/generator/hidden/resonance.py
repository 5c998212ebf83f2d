"""Outside of the vocabulary: the actuator swings after every corner of the pressure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from scipy.signal import bilinear, lfilter

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class Resonance(Hidden):
    """size: how much of the angle swings. frequency_Hz, damping: of the oscillator."""

    frequency_Hz: float
    damping: float
    name: ClassVar[str] = "resonance"
    bounds: ClassVar[tuple[float, float]] = (1e-3, 6.0)
    typical: ClassVar[float] = 0.6
    known: ClassVar[bool] = False

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, rng.uniform(0.5, 1.2), rng.uniform(0.03, 0.1))

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        w = 2 * np.pi * self.frequency_Hz
        b, a = bilinear([w * w], [1, 2 * self.damping * w, w * w], fs=1 / (at.time_s[1] - at.time_s[0]))
        return angle + self.size * (angle[0] + lfilter(b, a, angle - angle[0], axis=0) - angle)
