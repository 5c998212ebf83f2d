"""Outside of the vocabulary: a lens that bends lines, about the middle of the picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.hidden.picture import seen_deg
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class LensDistortion(Hidden):
    """size: |k1|, part of the distance moved at 150 mm from the middle. The middle is so far aside and along from the base, mm."""

    barrel: bool
    aside_mm: float
    along_mm: float
    name: ClassVar[str] = "lens_distortion"
    bounds: ClassVar[tuple[float, float]] = (1e-4, 0.45)
    typical: ClassVar[float] = 0.06
    known: ClassVar[bool] = False

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, bool(rng.integers(2)), rng.uniform(0, 90), rng.uniform(20, 160))

    def seen(self, angle: FloatArray, at: Station) -> FloatArray:
        middle = np.array([self.aside_mm, self.along_mm])
        k1 = -self.size if self.barrel else self.size

        def look(points: FloatArray) -> FloatArray:
            from_middle = (points[..., :2] - middle) / 150
            square = np.sum(from_middle**2, axis=-1, keepdims=True)
            return 150 * from_middle * (1 + k1 * square)

        found = angle.copy()
        for (_, _, length), columns in at.designs().items():
            found[:, columns] = seen_deg(angle[:, columns], length, look)
        return found
