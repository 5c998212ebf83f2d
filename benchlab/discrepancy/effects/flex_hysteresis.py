"""flex_hysteresis: the flex sensor has a loop and a drift of its own.

    felt = P(θ) + d·t          P: play of half width w

w `half_width_deg`, d `drift_deg_per_min`, t from the run's start.
By nature confounded: with friction where no camera looks on.
"""

from __future__ import annotations

from typing import ClassVar

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


class FlexHysteresis(Effect):
    name: ClassVar[str] = "flex_hysteresis"
    acts_on: ClassVar[str] = "sensor"
    physics: ClassVar[str] = (
        "The printed resistive layer of a flex sensor slips and relaxes: the same angle reads less on the way up "
        "than on the way down, and the reading wanders at a constant angle. Only the sensor has it; the camera "
        "does not see it."
    )
    looks_like: ClassVar[str] = "a loop of the sensor against the camera's angle, at all rates alike, and a slow drift"
    shown_by: ClassVar[str] = "sensor and camera together in slow and fast triangles and a hold"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("half_width_deg", "deg", 0.0, 15.0, 1.5, 0.0, (0.5, 1.5, 4.0), "half the width of the sensor's loop"),
        Parameter("drift_deg_per_min", "deg/min", -10.0, 10.0, 0.1, 0.0, (-0.5, 0.0, 0.5), "drift of the reading"),
    )
    seen_in: ClassVar[tuple[str, ...]] = ("flex_V",)

    def cannot_show(self, scene: Scene) -> str:
        return "" if scene.dt_s.any() else "there is no course in time"

    def flex(self, angle_deg: FloatArray, at: At) -> FloatArray:
        felt = at.scene.play(angle_deg, at.values["half_width_deg"])
        return felt + at.values["drift_deg_per_min"] / 60 * at.scene.time_s
