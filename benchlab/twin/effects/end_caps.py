"""end_caps: a rigid length at each end does not bend.

    θ = κ·(al − 2·c), so the angle shrinks by the factor 1 − 2·c/al

c `cap_mm`: chosen 5 mm. al: the actuator's length. The camera's markers are drawn on one arc all the same: what is left out is that
the ends are straight. Off in the twin that comes with benchlab.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.errors import InputError
from benchlab.twin.effects.effect import Effect, Kit, Stage, number


@dataclass(frozen=True)
class EndCaps(Effect):
    """Part of the length is rigid."""

    name = "end_caps"
    cap_mm: float = number(5, "mm", 0, 1000, "rigid length c at each end")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        if 2 * self.cap_mm >= kit.length_mm:
            what = f"cap_mm is {self.cap_mm:g}, and nothing is left of {kit.length_mm:g} mm to bend"
            raise InputError(what, where=f"effect {self.name}", hint="give the length of one cap")
        factor = 1 - 2 * self.cap_mm / kit.length_mm
        return {"angle": lambda value, now: value * factor}
