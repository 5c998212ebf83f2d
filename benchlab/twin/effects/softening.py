"""softening: rubber-like films are stiff the first time and softer ever after, up to the largest strain so far (Mullins).

    θ = [u + s·u·(1 − u/m)]·(1 + c·D)          m: largest u so far          D = 1 − exp(−W/(2·n·m))

u: angle so far in the chain, the measure of strain. On the first loading u = m and the angle is u. Below m it is larger by the share s
(softer), most at half of m, and the way back up joins the first one at m. W: way that u has gone below m, up and down; D grows
with it, so that each cycle to m bends a little more than the last, by c in all, most of it in the first n cycles.
s `softer`: chosen 0.06. c `growth`: chosen 0.03. n `cycles`: chosen 2. Not measured.
Sources: Mullins 1969 (Rubber Chem. Technol. 42, 339); of polyurethanes Qi and Boyce 2005 (Mechanics of Materials 37, 817).
The parabola is our choice.
Off in the twin that comes with benchlab.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Now, Stage, number


@dataclass(frozen=True)
class Softening(Effect):
    """Depends on the largest angle so far, and grows from cycle to cycle."""

    name = "softening"
    softer: float = number(0.06, "", 0, 0.5, "share s by which the angle is larger below the largest so far")
    growth: float = number(0.03, "", 0, 0.5, "share c by which the angle grows over many cycles")
    cycles: float = number(2, "", 0.1, 1000, "cycles n in which most of that growth happens")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"angle": _Softened(self, float(kit.curve.angle_deg[0]))}


class _Softened:
    def __init__(self, effect: Softening, rest_deg: float) -> None:
        self.effect = effect
        self.largest = max(rest_deg, 0.0)
        self.before = rest_deg
        self.way = 0.0

    def __call__(self, value: float, now: Now) -> float:
        # Only what lies below the largest angle so far is a way gone again.
        self.way += abs(min(value, self.largest) - min(self.before, self.largest))
        self.before = value
        self.largest = largest = max(self.largest, value)
        if largest <= 0 or value <= 0:
            return value
        effect = self.effect
        grown = 1 - math.exp(-self.way / (2 * effect.cycles * largest))
        return value * (1 + effect.softer * (1 - value / largest)) * (1 + effect.growth * grown)
