"""bladder_stiffness: the bladder inside is a membrane of its own, in parallel with the film.

    energy of the cell + ½·(E·h)-membrane over the whole circumference

E·h `stiffness_N_per_mm`. Through the knob `bladder_N_per_mm` of the base.
By nature confounded: with fabric_compliance and seam_margin on one design; over designs it weighs most where the
window is wide and the shell soft.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from benchlab.discrepancy.effects.effect import At, Effect, Parameter, without_knob
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


class BladderStiffness(Effect):
    name: ClassVar[str] = "bladder_stiffness"
    acts_on: ClassVar[str] = "energy"
    physics: ClassVar[str] = (
        "The airtight bladder is stretched with the shell and takes a share of the load: modulus times thickness, "
        "some 0.5 N/mm for 0.1 mm of a soft polymer of 5 MPa (chosen). An oversized bladder is slack at first and "
        "takes less, which the model does not have."
    )
    looks_like: ClassVar[str] = "all designs bend less, soft ones most, at all rates alike"
    shown_by: ClassVar[str] = "the same shell with a thinner bladder, or several designs to full pressure"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "stiffness_N_per_mm", "N/mm", 0.0, 5.0, 0.5, 0.0, (0.1, 0.4, 1.5), "modulus times thickness of the bladder"
        ),
    )

    def cannot_show(self, scene: Scene) -> str:
        return without_knob(scene, "bladder_N_per_mm")

    def knobs(self, at: At) -> Mapping[str, FloatArray | float]:
        return {"bladder_N_per_mm": at.values["stiffness_N_per_mm"]}
