"""flex_hysteresis: the flex sensor has a loop and a drift of its own, which the actuator does not have.

    felt = P(θ) + d·t          P: backlash (play) of half width w

w `half_width_deg`: chosen 1.5°. d `drift_deg_per_min`: chosen 0.1 °/min; t: since the start of the run. Carbon-ink flex sensors are
known for both; neither was measured. Off in the twin that comes with benchlab.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Now, Stage, number, play


@dataclass(frozen=True)
class FlexHysteresis(Effect):
    """Between the true bending angle and what the sensor feels."""

    name = "flex_hysteresis"
    half_width_deg: float = number(1.5, "deg", 0, 30, "half the width w of the sensor's loop")
    drift_deg_per_min: float = number(0.1, "deg/min", -10, 10, "drift d")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"flex": _Flex(self, float(kit.curve.angle_deg[0]))}


class _Flex:
    def __init__(self, effect: FlexHysteresis, rest_deg: float) -> None:
        self.effect = effect
        self.felt = rest_deg

    def __call__(self, value: float, now: Now) -> float:
        self.felt = play(self.felt, value, self.effect.half_width_deg)
        return self.felt + self.effect.drift_deg_per_min * now.since_s / 60
