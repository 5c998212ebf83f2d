"""The load frame gives: the actuator bends a little and presses less, by a straight line from held to free."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from scipy.interpolate import PchipInterpolator

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.solved import base
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class FrameCompliance(Hidden):
    """size: mm/N. The frame gives F·size at the lever arm, so the actuator turns by F·size/arm of its free angle.

    share: of the length that is free to turn.
    """

    share: float
    name: ClassVar[str] = "frame_compliance"
    bounds: ClassVar[tuple[float, float]] = (1e-5, 0.5)
    typical: ClassVar[float] = 0.003
    quantity: ClassVar[str] = "force_N"

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, rng.uniform(0.7, 1.0))

    def parameters(self) -> dict[str, Any]:
        return {"compliance_mm_N": self.size, "share": self.share}

    def pressed(self, force: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        found = force.copy()
        for (tw, slw, length), columns in at.designs().items():
            cell = base(tw, slw)
            free = PchipInterpolator(np.r_[0.0, cell.pressure_MPa], np.r_[0.0, cell.angle_rad_per_mm[0] * length])
            turn = np.maximum(free(np.clip(effective[:, columns], 0, cell.pressure_MPa[-1])), 1e-9) * self.share
            F = force[:, columns]
            found[:, columns] = F / (1 + F * self.size / LEVER_MM / turn)
        return found


LEVER_MM = 4.5
"""At which the straight-held moment is read as a force, as benchlab's default fixture has it."""
