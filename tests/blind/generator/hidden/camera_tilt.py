"""The plane of bending is turned from the picture's: foreshortened, and in perspective."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.hidden.picture import pinhole, seen_deg
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class CameraTilt(Hidden):
    """size: |tilt| in degrees. about: the base's axis (1: what is across is foreshortened) or the direction across (0: what is along)."""

    about: int
    sign: int
    distance_mm: float
    name: ClassVar[str] = "camera_tilt"
    bounds: ClassVar[tuple[float, float]] = (0.5, 65.0)
    typical: ClassVar[float] = 15.0

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, int(rng.integers(2)), int(rng.choice([-1, 1])), rng.uniform(1500, 3000))

    def parameters(self) -> dict[str, Any]:
        return {"tilt_deg": self.size, "foreshortened": "across" if self.about == 1 else "along"}

    def seen(self, angle: FloatArray, at: Station) -> FloatArray:
        look = pinhole(self.distance_mm, turned_rad=self.sign * np.radians(self.size), about=self.about)
        found = angle.copy()
        for (_, _, length), columns in at.designs().items():
            found[:, columns] = seen_deg(angle[:, columns], length, look)
        return found
