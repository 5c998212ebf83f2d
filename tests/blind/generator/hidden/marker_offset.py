"""The markers lie beside the neutral line; the circle goes through them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.hidden.picture import MARKERS, on_the_line, seen_deg, straight_on
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class MarkerOffset(Hidden):
    """size: |d| in mm, outside of the bend or inside. tapered: from 1.25 d at the base to 0.75 d at the tip."""

    outside: bool
    tapered: bool
    name: ClassVar[str] = "marker_offset"
    bounds: ClassVar[tuple[float, float]] = (0.05, 30.0)
    typical: ClassVar[float] = 4.0

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, bool(rng.integers(2)), bool(rng.integers(2)))

    @property
    def same_form(self) -> bool:
        return not self.tapered

    @property
    def offset_mm(self) -> float:
        return self.size if self.outside else -self.size

    def parameters(self) -> dict[str, Any]:
        return {"offset_mm": self.offset_mm, "tapered": self.tapered}

    def seen(self, angle: FloatArray, at: Station) -> FloatArray:
        aside = self.offset_mm * (np.linspace(1.25, 0.75, MARKERS) if self.tapered else np.ones(MARKERS))
        found = angle.copy()
        for (_, _, length), columns in at.designs().items():
            found[:, columns] = seen_deg(
                angle[:, columns], length, straight_on, lambda a, mm: on_the_line(a, mm, aside_mm=aside)
            )
        return found
