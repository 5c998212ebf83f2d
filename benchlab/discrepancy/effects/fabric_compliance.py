"""fabric_compliance: the fabric is softer or stiffer than the 498 MPa of the layup.

    E_fabric → f·E_fabric, in ribs and strip

f `factor`. Through the knob `fabric_modulus` of the base: the cell is solved again.
By nature confounded: with seam_margin and bladder_stiffness on one design; over designs it is the strip's width that
tells it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from benchlab.discrepancy.effects.effect import At, Effect, Parameter, without_knob
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


class FabricCompliance(Effect):
    name: ClassVar[str] = "fabric_compliance"
    acts_on: ClassVar[str] = "material"
    physics: ClassVar[str] = (
        "A woven fabric has no single modulus: crimp, direction and lamination change it by a factor of a few "
        "against the data sheet. A soft strip lengthens and lets the tube stretch in place of bending; soft ribs "
        "give around the circumference."
    )
    looks_like: ClassVar[str] = "the gap depends on the width of the strip; one sign over all pressures"
    shown_by: ClassVar[str] = "two strip widths at one window width"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "factor", "", 0.25, 3.0, 0.7, 1.0, (0.45, 0.8, 1.3, 2.0), "modulus of the fabric over that of the layup"
        ),
    )

    def cannot_show(self, scene: Scene) -> str:
        return without_knob(scene, "fabric_modulus")

    def knobs(self, at: At) -> Mapping[str, FloatArray | float]:
        return {"fabric_modulus": at.values["factor"]}
