"""friction: the bladder rubs on the shell, and the angle stays behind whichever way it goes, at any rate.

    θ = P(u)          P: play (backlash) of half width h(p) = h·(1 − g + g·p/0.35 MPa)          (plain)

h `half_width_deg`: half the loop's width at 0.35 MPa, after a way of several h; g `grows`: share of it that grows
with pressure (Coulomb: the pressure presses bladder and shell together). Forms: `spread`: mean of three plays of h/2,
h, 3h/2 (Prandtl–Ishlinskii; Kuhnen, Eur. J. Control 9, 407, 2003); `gradual`: θ = u − z, dz/du = (1 − z/h·sgn u̇)/2
(Dahl 1968), which stands still at a turn and comes near to h over a way of 2h.
By nature confounded: with viscoelasticity and all lags where there is one rate and no hold.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

REFERENCE_MPa = 0.35
"""Where the width is told; chosen: the largest pressure of the paper's bench."""


class Friction(Effect):
    name: ClassVar[str] = "friction"
    acts_on: ClassVar[str] = "load"
    physics: ClassVar[str] = (
        "The oversized bladder slides on the shell. Dry friction holds back the motion by a moment that does not "
        "depend on the speed, and grows with the pressure between the two; seen in the angle it is a play, or a "
        "sum of plays with spread thresholds (Visintin, Differential Models of Hysteresis, 1994)."
    )
    looks_like: ClassVar[str] = (
        "a loop between loading and unloading that is alike at all rates and wider at higher pressure; the angle "
        "waits after each turn"
    )
    shown_by: ClassVar[str] = "loading and unloading at two rates: the loop does not change"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "half_width_deg", "deg", 0.0, 20.0, 1.5, 0.0, (0.3, 1.0, 3.0), "half the width of the loop at 0.35 MPa"
        ),
        Parameter("grows", "", 0.0, 1.0, 0.8, None, (0.2, 0.9), "share of the width that grows with pressure"),
    )
    forms: ClassVar[tuple[str, ...]] = ("plain", "spread", "gradual")
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg", "flex_V")

    def cannot_show(self, scene: Scene) -> str:
        return "" if scene.goes_back else "there is no unloading"

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        grows = at.values["grows"]
        if at.values["half_width_deg"] == 0:
            return angle_deg
        half = at.values["half_width_deg"] * (1 - grows + grows * np.maximum(at.inside_MPa, 0.0) / REFERENCE_MPa)
        if at.form == "gradual":
            return angle_deg - _dahl(angle_deg, half)
        if at.form == "spread":
            return sum((at.scene.play(angle_deg, part * half) for part in (0.5, 1.0, 1.5)), np.zeros(())) / 3
        return at.scene.play(angle_deg, half)


def _dahl(value: FloatArray, half: FloatArray) -> FloatArray:
    """(T, R): z of dz/du = (1 − z/h·sgn u̇)/2, exact over each step; from 0."""
    move = np.diff(value, axis=0, prepend=value[:1])
    with np.errstate(divide="ignore", invalid="ignore"):
        kept = np.where(move == 0, 1.0, np.exp(-np.abs(move) / (2 * half)))
    goal = np.sign(move) * half
    out = np.zeros_like(value)
    for i in range(1, len(value)):
        out[i] = goal[i] + (out[i - 1] - goal[i]) * kept[i]
    return out
