"""frame_compliance: the load frame gives, and the blocked actuator is not quite blocked.

    F → F·(1 − s)

s `share`.
By nature confounded: with a wrong lever arm of the fixture, which is the same factor.
"""

from __future__ import annotations

from typing import ClassVar

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


class FrameCompliance(Effect):
    name: ClassVar[str] = "frame_compliance"
    acts_on: ClassVar[str] = "sensor"
    physics: ClassVar[str] = (
        "Frame, load cell and fixture are a spring in series with the actuator's own stiffness k_a: F = "
        "F_blocked·k_f/(k_f + k_a). Where k_a hardly changes over the pressures the force falls in proportion, by "
        "s = k_a/(k_f + k_a)."
    )
    looks_like: ClassVar[str] = "blocked forces fall short by one share; the angle does not"
    shown_by: ClassVar[str] = "the blocked force in a second, stiffer fixture"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("share", "", 0.0, 0.6, 0.05, 0.0, (0.02, 0.08, 0.25), "share of the force that is lost"),
    )
    seen_in: ClassVar[tuple[str, ...]] = ("force_N",)

    def cannot_show(self, scene: Scene) -> str:
        return "" if scene.has("force_N") else "the base has no blocked force"

    def force(self, force_N: FloatArray, at: At) -> FloatArray:
        return force_N * (1 - at.values["share"])
