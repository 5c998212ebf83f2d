"""seam_margin: the weld takes a margin along each edge of a window.

    tw → tw − 2m          wl → wl − 2m          (the pitch of the cell stays)

m `margin_mm`. Through the knob `seam_margin_mm` of the base: the cell is solved again with the narrower window.
By nature confounded: with fabric_compliance and bladder_stiffness on one design; narrow windows beside wide ones tell
it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from benchlab.discrepancy.effects.effect import At, Effect, Parameter, without_knob
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


class SeamMargin(Effect):
    name: ClassVar[str] = "seam_margin"
    acts_on: ClassVar[str] = "design"
    physics: ClassVar[str] = (
        "Where film and fabric are laminated the adhesive runs and the film is held beyond the cut edge, so that "
        "the window that can stretch is narrower on all sides than the one that was drawn. The angle falls the "
        "more the narrower the window is."
    )
    looks_like: ClassVar[str] = "designs with narrow windows fall short at all pressures, wide ones hardly"
    shown_by: ClassVar[str] = "two window widths, the narrow one twice"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "margin_mm", "mm", 0.0, 1.2, 0.3, 0.0, (0.08, 0.25, 0.6), "margin of the weld along each edge of a window"
        ),
    )

    def cannot_show(self, scene: Scene) -> str:
        return without_knob(scene, "seam_margin_mm")

    def knobs(self, at: At) -> Mapping[str, FloatArray | float]:
        return {"seam_margin_mm": at.values["margin_mm"]}
