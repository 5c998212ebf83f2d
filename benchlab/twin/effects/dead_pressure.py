"""dead_pressure: nothing bends until slack is taken up and the tube has unfolded, at about the pressure p0.

    p → s(p − p0) − s(−p0)          s(x) = (x + √(x² + w²))/2, a smooth max(x, 0)

p0 `dead_MPa`: chosen 0.01 MPa; the paper's simulated volume rises fast up to about 0.015 MPa, the unfolding. w `smooth_MPa`: chosen
0.005 MPa, over which bending sets in. At 0 MPa the result is 0, and it never exceeds p. Off in the twin that comes with benchlab.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Stage, number


@dataclass(frozen=True)
class DeadPressure(Effect):
    """The response curve is read at a lower pressure than there is."""

    name = "dead_pressure"
    dead_MPa: float = number(0.01, "MPa", 0, 0.2, "pressure p0 at which bending sets in")
    smooth_MPa: float = number(0.005, "MPa", 0, 0.1, "width w over which it sets in")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        dead, smooth = self.dead_MPa, self.smooth_MPa

        def above(x: float) -> float:
            return (x + math.sqrt(x * x + smooth * smooth)) / 2

        return {"bend": lambda value, now: above(value - dead) - above(-dead)}
