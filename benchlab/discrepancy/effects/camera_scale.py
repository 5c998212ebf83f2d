"""camera_scale: lengths in the picture are taken for f times what they are.

    κ_seen = κ/f, and the angle κ·al with it

f `factor`.
By nature confounded: with end_caps where all designs are of one length; a scale bar at the actuator's distance tells.
"""

from __future__ import annotations

from typing import ClassVar

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.units import FloatArray


class CameraScale(Effect):
    name: ClassVar[str] = "camera_scale"
    acts_on: ClassVar[str] = "sensor"
    physics: ClassVar[str] = (
        "The angle is curvature times the known length (Eq 3 of the paper), and curvature is one over a length "
        "that is read from the picture. A scale bar that is nearer or farther than the actuator, or a wrong mm per "
        "pixel, makes it wrong by a factor."
    )
    looks_like: ClassVar[str] = "the same share is missing, or too much, at all pressures, rates, designs and lengths"
    shown_by: ClassVar[str] = "a scale bar in the actuator's plane; volume, force and flex sensor do not have it"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("factor", "", 0.75, 1.3, 1.03, 1.0, (0.9, 0.97, 1.03, 1.1), "lengths as seen over true ones"),
    )
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg",)

    def camera(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return angle_deg / at.values["factor"]
