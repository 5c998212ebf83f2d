"""Outside of the vocabulary: one design was made of another roll of film."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class OddBatch(Hidden):
    """size: part by which that design bends more or less. which: from 0 to 1, the design's place among the designs."""

    which: float
    sign: int
    name: ClassVar[str] = "odd_batch"
    bounds: ClassVar[tuple[float, float]] = (1e-3, 0.9)
    typical: ClassVar[float] = 0.1
    known: ClassVar[bool] = False

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, rng.uniform(0, 1), int(rng.choice([-1, 1])))

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        designs = sorted(at.designs().items())
        columns = designs[int(self.which * len(designs))][1]
        found = angle.copy()
        found[:, columns] *= 1 + self.sign * self.size
        return found
