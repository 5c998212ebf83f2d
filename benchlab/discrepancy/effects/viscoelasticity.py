"""viscoelasticity: part of the response comes late.

    θ = (1 − a)·u + a·x          τ·dx/dt = u − x          (plain)

a `late_share`, τ `time_s`; u: angle so far, taken for the one at rest after a long time. Forms: `two times`: halves
with τ/r and τ·r, r = √10; `log time`: five equal parts spread over τ/30 … τ·30, which creeps with log t as
polyurethanes do; `creep on top`: θ = u + a·x', x' the slow part's departure from the run's start, so that u is the
response at once; `log creep on top`: that with the times of `log time`.
By nature confounded: with friction at one rate without a hold; with regulator_lag where τ is short and all designs
are fast alike.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

SPREAD: dict[str, FloatArray] = {
    "plain": np.ones(1),
    "two times": np.sqrt(10.0) ** np.array([-1, 1]),
    "log time": np.geomspace(1 / 30, 30, 5),
    "creep on top": np.ones(1),
    "log creep on top": np.geomspace(1 / 30, 30, 5),
}
"""Time constants of equal parts, over τ; chosen."""


class Viscoelasticity(Effect):
    name: ClassVar[str] = "viscoelasticity"
    acts_on: ClassVar[str] = "time response"
    physics: ClassVar[str] = (
        "The polyurethane film relaxes: a share of the deformation follows the pressure with a delay of its own, "
        "as springs and dashpots in series do (Kelvin–Voigt elements, a Prony series of the creep compliance; "
        "Ferry, Viscoelastic Properties of Polymers, 1980). The share and the time are taken as one for all "
        "designs and pressures, linear in the angle."
    )
    looks_like: ClassVar[str] = (
        "creep at held pressure; a loop that changes its width with the rate; the angle comes back late after a vent"
    )
    shown_by: ClassVar[str] = "a hold of a few times τ, and loading and unloading at two rates"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("late_share", "", 0.0, 0.5, 0.07, 0.0, (0.02, 0.06, 0.15), "share of the response that comes late"),
        Parameter("time_s", "s", 0.05, 300.0, 3.0, None, (0.4, 3.0, 20.0), "time in which it comes (63 % of it)"),
    )
    forms: ClassVar[tuple[str, ...]] = tuple(SPREAD)
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg", "flex_V")

    def cannot_show(self, scene: Scene) -> str:
        return scene.shows_time

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        late = at.scene.follow_several(angle_deg, at.values["time_s"] * SPREAD[at.form])
        if at.form.endswith("on top"):
            return angle_deg + at.values["late_share"] * (late - angle_deg[0])
        return angle_deg + at.values["late_share"] * (late - angle_deg)
