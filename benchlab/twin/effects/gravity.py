"""gravity: the actuator's own weight bends it, the more the farther its middle is from hanging straight down.

    θ → θ − A·sin(φ + θ/2)

A `sag_deg`: angle that the weight takes off where the middle is level, chosen 1.5°; not measured. φ `mount_deg`: attitude of the base,
0 hanging down, 90 level and bending upwards, −90 level and bending downwards, 180 standing up; the middle of an arc is θ/2 further.
Weight, stiffness and length are in A (weight · lever · compliance in bending), which is taken as constant; the true one falls with
pressure as the tube gets stiffer. Off in the twin that comes with benchlab.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Stage, number


@dataclass(frozen=True)
class Gravity(Effect):
    """Own weight, with the sign of the mounting."""

    name = "gravity"
    sag_deg: float = number(1.5, "deg", 0, 30, "angle A that the weight takes off where the middle is level")
    mount_deg: float = number(0, "deg", -180, 180, "attitude φ of the base: 0 hangs, 90 level and bending up")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        sag, mount = self.sag_deg, math.radians(self.mount_deg)
        return {"angle": lambda value, now: value - sag * math.sin(mount + math.radians(value) / 2)}
