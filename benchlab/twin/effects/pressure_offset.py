"""pressure_offset: the pressure sensor reads p + b.

b `offset_MPa`: chosen 0.002 MPa. The pressure itself is as it was. Off in the twin that comes with benchlab.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Stage, number


@dataclass(frozen=True)
class PressureOffset(Effect):
    """At the regulator's monitor output."""

    name = "pressure_offset"
    offset_MPa: float = number(0.002, "MPa", -0.1, 0.1, "what is added to the reading, b")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"monitor": lambda value, now: value + self.offset_MPa}
