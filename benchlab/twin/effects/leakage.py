"""leakage: air leaves through seams and fittings, so that the pressure inside stays below the regulator's.

    supplied:   p_in = (1 − a)·p                 the flow that is lost costs pressure on its way, in proportion
    shut off:   p_in = p0·exp(−t/τ)              nothing follows, what is inside leaves

a `share`: chosen 0.02. τ `decay_s`: chosen 60 s. Neither was measured; both follow from one leak (orifice with laminar flow), but in
proportions that depend on the supply, so they are two numbers. The regulator of the bench is never shut off but by the fault `supply_shut`.
Off in the twin that comes with benchlab.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Now, Stage, number


@dataclass(frozen=True)
class Leakage(Effect):
    """Loss of pressure in proportion to it; decay where no air comes."""

    name = "leakage"
    share: float = number(0.02, "", 0, 0.95, "share a of the pressure that is lost while air is supplied")
    decay_s: float = number(60, "s", 0.01, 1e6, "time constant τ of the decay when no air comes")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"line": _Leak(self)}


class _Leak:
    def __init__(self, effect: Leakage) -> None:
        self.effect = effect
        self.pressure = 0.0

    def __call__(self, value: float, now: Now) -> float:
        if now.shut:
            self.pressure *= math.exp(-now.dt_s / self.effect.decay_s)
        else:
            self.pressure = (1 - self.effect.share) * value
        return self.pressure
