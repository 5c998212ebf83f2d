"""Outside of the vocabulary: the camera's mount settles in the course of the session, whatever the pressure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class WarmUpDrift(Hidden):
    """size: degrees that are reached in the end. settle_s: time constant."""

    settle_s: float
    sign: int
    name: ClassVar[str] = "warm_up_drift"
    bounds: ClassVar[tuple[float, float]] = (1e-3, 60.0)
    typical: ClassVar[float] = 3.0
    by_sample: ClassVar[bool] = True
    known: ClassVar[bool] = False

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, rng.uniform(3000, 9000), int(rng.choice([-1, 1])))

    def seen(self, angle: FloatArray, at: Station) -> FloatArray:
        return angle + self.sign * self.size * (1 - np.exp(-at.session_s / self.settle_s))
