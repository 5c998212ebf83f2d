"""marker_offset: the markers lie at a distance d from the line whose curvature is meant.

    κ_seen = κ/(1 + κ·d), with κ = θ/al

d `offset_mm`: chosen 6 mm, half of the tube; positive away from the centre of the bend. Only the camera is affected. Off in the twin that
comes with benchlab.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Stage, number


@dataclass(frozen=True)
class MarkerOffset(Effect):
    """Between the true bending angle and the angle that the markers' curvature gives."""

    name = "marker_offset"
    offset_mm: float = number(6, "mm", -20, 20, "distance d of the markers from the neutral line, outwards")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        per_degree = math.radians(1) * self.offset_mm / kit.length_mm
        return {"camera": lambda value, now: value / (1 + value * per_degree)}
