"""pressure_gain: the pressure sensor reads a·p.

a `gain`: chosen 1.02; makers give 1 to 3 % of full scale. The pressure itself is as it was. Off in the twin that comes with benchlab.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Stage, number


@dataclass(frozen=True)
class PressureGain(Effect):
    """At the regulator's monitor output."""

    name = "pressure_gain"
    gain: float = number(1.02, "", 0.5, 2, "factor a of the reading")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"monitor": lambda value, now: value * self.gain}
