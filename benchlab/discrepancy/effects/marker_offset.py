"""marker_offset: the markers lie at a distance d from the neutral line.

    κ_seen = κ/(1 + κ·d)          θ_seen = θ/(1 + θ·d/al)          (θ in rad)

d `distance_mm`: positive on the outer side of the bend.
By nature confounded: with a saturating material where no other quantity is measured; markers on the other side, or a
second length, tell.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import UNKNOWN_LENGTH, At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


class MarkerOffset(Effect):
    name: ClassVar[str] = "marker_offset"
    acts_on: ClassVar[str] = "sensor"
    physics: ClassVar[str] = (
        "The strip hardly stretches and is the neutral line. Markers on the window side, one tube diameter away, "
        "run on an arc of larger radius, r + d; its curvature is what the camera gives (piecewise constant "
        "curvature, Webster and Jones 2010)."
    )
    looks_like: ClassVar[str] = "a gap that grows with the square of the angle, alike in all designs and directions"
    shown_by: ClassVar[str] = "markers on both sides of the tube"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "distance_mm",
            "mm",
            -20.0,
            30.0,
            6.0,
            0.0,
            (-6.0, -2.0, 2.0, 6.0, 12.0),
            "distance of the markers, outwards",
        ),
    )
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg",)

    def cannot_show(self, scene: Scene) -> str:
        return "" if scene.lengths_known else UNKNOWN_LENGTH

    def camera(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return angle_deg / (1 + np.radians(angle_deg) * at.values["distance_mm"] / at.scene.length_mm)
