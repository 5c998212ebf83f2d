"""window_ballooning: the windows bulge out between the ribs.

    share s of the bulging that the full model has

s `share`. Through the knob `ballooning` of the one-dimensional beam model, which has none of it; the shell cell has
all of it.
By nature confounded: with seam_margin where the windows are of one width.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from benchlab.discrepancy.effects.effect import At, Effect, Parameter, without_knob
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


class WindowBallooning(Effect):
    name: ClassVar[str] = "window_ballooning"
    acts_on: ClassVar[str] = "energy"
    physics: ClassVar[str] = (
        "The film of a window curves outward between its ribs. Part of its length goes into the bulge, where a "
        "one-dimensional model that stretches the film along the axis alone has it lengthen the tube; wide windows "
        "bulge most (simulation/beam_window)."
    )
    looks_like: ClassVar[str] = "the model bends too far, the more the wider the window"
    shown_by: ClassVar[str] = "two window widths"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "share", "", 0.0, 1.0, 1.0, 0.0, (0.25, 0.6, 0.95), "share of the windows' bulging that the model lacks"
        ),
    )

    def cannot_show(self, scene: Scene) -> str:
        if scene.base.kind == "cell":
            return "the shell cell has it"
        if scene.base.kind != "beam":
            return "whether another engine's curves have it is not known"
        return without_knob(scene, "ballooning")

    def knobs(self, at: At) -> Mapping[str, FloatArray | float]:
        return {"ballooning": at.values["share"]}
