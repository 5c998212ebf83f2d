"""The actuator is not where the scale was taken: nearer to the camera, or farther."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.hidden.picture import pinhole, seen_deg
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class CameraScale(Hidden):
    """size: |f − 1|, lengths in the picture are f times as long as they are."""

    longer: bool
    distance_mm: float
    name: ClassVar[str] = "camera_scale"
    bounds: ClassVar[tuple[float, float]] = (1e-4, 0.3)
    typical: ClassVar[float] = 0.05

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, bool(rng.integers(2)), rng.uniform(500, 1500))

    @property
    def same_form(self) -> bool:
        return True

    @property
    def scale(self) -> float:
        return 1 + self.size if self.longer else 1 - self.size

    def parameters(self) -> dict[str, Any]:
        return {"scale": self.scale}

    def seen(self, angle: FloatArray, at: Station) -> FloatArray:
        look = pinhole(self.distance_mm, nearer_mm=self.distance_mm * (1 - 1 / self.scale))
        found = angle.copy()
        for (_, _, length), columns in at.designs().items():
            found[:, columns] = seen_deg(angle[:, columns], length, look)
        return found
