"""leakage: air escapes, and the pressure in the actuator is below that at the regulator.

    p → (1 − l)·p (plain)          with the valve shut: p·exp(−r·t), t the time since the pressure stands still

l `share`: lost at 0.35 MPa while air is fed; r `fall_per_min`: of the pressure, in a hold with the valve shut. The
valve is taken to be shut where the recorded pressure stands still and no command asks for it (none is known, or less
than half of the pressure). Forms: `orifice`: the leak is an orifice (flow with the root of the pressure), p_in +
l·√(0.35 MPa·p_in) = p, so that small pressures lose a larger share.
By nature confounded: with pressure_gain while the pressure moves (plain); a hold with the valve shut tells them
apart.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

REFERENCE_MPa = 0.35


class Leakage(Effect):
    name: ClassVar[str] = "leakage"
    acts_on: ClassVar[str] = "load"
    physics: ClassVar[str] = (
        "Seams and fittings leak. While the regulator feeds the loss, the flow makes a pressure drop over tube and "
        "valve: in proportion to the pressure where both are laminar, with its root where the leak is an orifice. "
        "With the valve shut the pressure inside decays exponentially, and a gauge at the regulator does not see "
        "it."
    )
    looks_like: ClassVar[str] = (
        "a constant share of the pressure is missing; in a hold the angle falls slowly while the recorded pressure "
        "stays"
    )
    shown_by: ClassVar[str] = "a hold of a minute with the valve shut, and a slow ramp"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "share", "", 0.0, 0.4, 0.03, 0.0, (0.01, 0.03, 0.1), "share of the pressure that is lost, at 0.35 MPa"
        ),
        Parameter(
            "fall_per_min",
            "1/min",
            0.0,
            3.0,
            0.05,
            0.0,
            (0.0, 0.02, 0.1, 0.5),
            "share that it falls per minute in a hold",
        ),
    )
    forms: ClassVar[tuple[str, ...]] = ("plain", "orifice")

    def inside(self, pressure_MPa: FloatArray, at: At) -> FloatArray:
        share, fall = at.values["share"], at.values["fall_per_min"]
        fed = pressure_MPa * (1 - share)
        if at.form == "orifice" and share > 0:
            above, half = np.maximum(pressure_MPa, 0.0), share * np.sqrt(REFERENCE_MPa) / 2
            fed = np.minimum(pressure_MPa, 0.0) + (np.sqrt(half**2 + above) - half) ** 2
        if fall == 0 or not at.scene.holds:
            return fed
        return np.asarray(fed * np.exp(-fall / 60 * shut_s(at.scene)))


def shut_s(scene: Scene) -> FloatArray:
    """(T, R): time since the valve is taken to be shut, 0 where it is not."""
    asked = np.nan_to_num(scene.command_MPa, nan=0.0) >= 0.5 * scene.pressure_MPa
    return np.where(asked, 0.0, scene.hold_s)
