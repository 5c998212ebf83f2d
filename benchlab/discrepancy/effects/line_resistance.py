"""line_resistance: air must flow through the tube to fill a volume that grows with pressure.

    τ·dp/dt = p_reg − p          τ = R·C          C = dV/dp          (plain)

R `resistance_MPa_s_per_mL`; V(p): volume of the base, so that the lag differs between designs and pressures. C is
taken at the pressure inside, in three passes. Form `with air`: C = dV/dp + V/(p + p_atm), p_atm = 0.1013 MPa: the air
that is in there is compressed too (ideal gas, isothermal), scaled so that C is dV/dp on average over the base's
designs and pressures, and R means the same.
By nature confounded: with regulator_lag where dV/dp is alike for all designs and pressures.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

ATMOSPHERE_MPa = 0.1013
PASSES = 3
"""To find the pressure at which C is taken: within 3 % of the lag's effect for lags of up to half a ramp."""


class LineResistance(Effect):
    name: ClassVar[str] = "line_resistance"
    acts_on: ClassVar[str] = "time response"
    physics: ClassVar[str] = (
        "Laminar flow through the tube is in proportion to the difference of pressures (Hagen–Poiseuille: R = "
        "8·µ·L/(π·r⁴), 0.0018 MPa·s/mL for air in 1 m of 0.8 mm bore), and the actuator takes up volume as it "
        "inflates: a lag R·dV/dp."
    )
    looks_like: ClassVar[str] = (
        "a loop that widens with the rate, more for designs and pressures at which the volume grows fast"
    )
    shown_by: ClassVar[str] = "fast triangles on designs of small and large dV/dp, or a shorter tube"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "resistance_MPa_s_per_mL",
            "MPa·s/mL",
            0.0,
            0.1,
            0.004,
            0.0,
            (0.002, 0.006, 0.02, 0.06),
            "resistance of tube and fittings",
        ),
    )
    forms: ClassVar[tuple[str, ...]] = ("plain", "with air")
    needs: ClassVar[tuple[str, ...]] = ("volume_mL",)

    def cannot_show(self, scene: Scene) -> str:
        return scene.shows_time if scene.has("volume_mL") else "the volume of the designs is not known"

    def inside(self, pressure_MPa: FloatArray, at: At) -> FloatArray:
        resistance = at.values["resistance_MPa_s_per_mL"]
        if resistance == 0:
            return pressure_MPa
        late = pressure_MPa
        for _ in range(PASSES):
            middle = (late + np.concatenate([late[:1], late[:-1]])) / 2
            late = at.scene.follow(pressure_MPa, resistance * _compliance(middle, at))
        return late


def _compliance(pressure_MPa: FloatArray, at: At) -> FloatArray:
    """(T, R): C in mL/MPa, not below 0."""
    scene, pressure = at.scene, np.maximum(pressure_MPa, 0.0)
    walls = np.maximum(scene.slope("volume_mL", pressure), 0.0)
    if at.form == "plain":
        return walls
    air = np.maximum(scene.curve("volume_mL", pressure, {}), 0.0) / (pressure + ATMOSPHERE_MPa)
    return (walls + air) * _air_to_plain(scene)


def _air_to_plain(scene: Scene) -> float:
    """Mean of dV/dp over that of dV/dp + V/(p + p_atm), of the base's designs over their pressures."""
    walls, both = [], []
    for name in scene.names:
        design = scene.base.designs[name]
        pressure, volume = design.pressure_MPa, design.curves["volume_mL"]
        rise = np.ptp(volume) / np.ptp(pressure)
        walls.append(rise)
        both.append(rise + np.mean(volume / (pressure + ATMOSPHERE_MPa)))
    return float(np.mean(walls) / np.mean(both))
