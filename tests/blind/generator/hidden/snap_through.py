"""Outside of the vocabulary: a wall snaps at one pressure and snaps back at a lower one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class SnapThrough(Hidden):
    """size: part of the angle that is added while it is snapped; up_MPa, down_MPa: where it does so, within width_MPa."""

    up_MPa: float
    down_MPa: float
    width_MPa: float
    sign: int
    name: ClassVar[str] = "snap_through"
    bounds: ClassVar[tuple[float, float]] = (1e-4, 0.7)
    typical: ClassVar[float] = 0.08
    known: ClassVar[bool] = False

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        up = rng.uniform(0.16, 0.24)
        down = up - rng.uniform(0.04, 0.1)
        return cls(cls.typical, up, down, rng.uniform(0.002, 0.006), int(rng.choice([-1, 1])))

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        snapped = np.zeros(effective.shape[1])
        extra = np.empty_like(effective)
        up = 1 / (1 + np.exp(-(effective - self.up_MPa) / self.width_MPa))
        down = 1 / (1 + np.exp(-(effective - self.down_MPa) / self.width_MPa))
        for i in range(len(effective)):
            snapped = np.clip(snapped, up[i], down[i])
            extra[i] = snapped
        return angle * (1 + self.sign * self.size * extra)
