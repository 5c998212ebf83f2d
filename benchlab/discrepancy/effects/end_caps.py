"""end_caps: both ends are rigid over a length c.

    θ = κ·(al − 2c) → θ·(1 − 2c/al)

c `cap_mm`; al: the actuator's length.
By nature confounded: with camera_scale where all designs are of one length; a second length tells them apart.
"""

from __future__ import annotations

from typing import ClassVar

from benchlab.discrepancy.effects.effect import UNKNOWN_LENGTH, At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


class EndCaps(Effect):
    name: ClassVar[str] = "end_caps"
    acts_on: ClassVar[str] = "design"
    physics: ClassVar[str] = (
        "Fittings, folds and glue hold the tube's ends, which then do not bend. With constant curvature between "
        "them (Eq 3 of the paper with a shorter length) the angle falls in proportion, alike at all pressures."
    )
    looks_like: ClassVar[str] = (
        "the same share is missing at all pressures, rates and designs of one length; less of it on a longer actuator"
    )
    shown_by: ClassVar[str] = "a second length of one design"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("cap_mm", "mm", 0.0, 30.0, 5.0, 0.0, (1.0, 3.0, 8.0), "rigid length at each end"),
    )
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg", "flex_V")

    def cannot_show(self, scene: Scene) -> str:
        return "" if scene.lengths_known else UNKNOWN_LENGTH

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return angle_deg * (1 - 2 * at.values["cap_mm"] / at.scene.length_mm)
