"""viscoelasticity: TPU creeps. The angle answers to the pressure at once in part, and for the rest with two relaxation times.

    θ = (1 − a1 − a2)·u + a1·x1 + a2·x2          τ_i·dx_i/dt = u − x_i

u: angle of the response curve at the pressure inside, which is where θ comes to rest. a_i `share_1`, `share_2`; τ_i `time_1_s`,
`time_2_s`. After a step of u from 0 the angle creeps as u·(1 − a1·exp(−t/τ1) − a2·exp(−t/τ2)); in a cycle it lags, and the loop is
widest where the cycle's period is about 2π·τ_i (standard linear solid, one for each term: Prony series; Ferry, Viscoelastic Properties
of Polymers, 1980). That thermoplastic polyurethanes lag, creep and soften: Qi and Boyce 2005 (Mechanics of Materials 37, 817). The
values are chosen, not measured: a1 = 0.04 with 0.3 s, a2 = 0.03 with 8 s. Exact for an angle u that goes straight within a step.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.errors import InputError
from benchlab.twin.effects.effect import Effect, Kit, Now, Stage, follow, number


@dataclass(frozen=True)
class Viscoelasticity(Effect):
    """Two Prony terms between the angle at rest and the angle."""

    name = "viscoelasticity"
    share_1: float = number(0.04, "", 0, 1, "share a1 of the angle that comes with the first time")
    time_1_s: float = number(0.3, "s", 0.001, 1e5, "first relaxation time τ1")
    share_2: float = number(0.03, "", 0, 1, "share a2 of the angle that comes with the second time")
    time_2_s: float = number(8, "s", 0.001, 1e5, "second relaxation time τ2")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.share_1 + self.share_2 > 1:
            what = f"share_1 and share_2 are {self.share_1 + self.share_2:g} together, more than all of the angle"
            raise InputError(what, where=f"effect {self.name}", hint="give shares whose sum is at most 1")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"angle": _Prony(self, float(kit.curve.angle_deg[0]))}


class _Prony:
    def __init__(self, effect: Viscoelasticity, rest_deg: float) -> None:
        self.share_1, self.share_2 = effect.share_1, effect.share_2
        self.time_1, self.time_2 = effect.time_1_s, effect.time_2_s
        self.before = self.slow_1 = self.slow_2 = rest_deg

    def __call__(self, value: float, now: Now) -> float:
        self.slow_1 = follow(self.slow_1, self.before, value, now.dt_s, self.time_1)
        self.slow_2 = follow(self.slow_2, self.before, value, now.dt_s, self.time_2)
        self.before = value
        return (1 - self.share_1 - self.share_2) * value + self.share_1 * self.slow_1 + self.share_2 * self.slow_2
