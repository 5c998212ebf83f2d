"""gravity: the actuator's own weight bends it, by the attitude in which it is mounted.

    θ → θ',   θ' = θ − w·al³/(6·B(p))·S(θ', φ)          S = 6/(w·al²)·∂V/∂θ ≈ sin(φ + θ/2)          B = ∂M/∂k

w `mass_g_per_m` times g: weight per length; al: length; B: bending stiffness of the base at constant pressure, with k = θ/al. φ: attitude
of the base, 0 hanging, 90 level and bending upwards, 180 standing. V: potential energy of an arc of constant curvature and even
weight; S is exact. What the weight bends more near the base than at the tip is of second order and left out.
By nature confounded: with softer or stiffer parts in one attitude; two attitudes tell it.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import UNKNOWN_LENGTH, At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

HANGING_deg = 0.0
"""The attitude where it is not told: of a model that is drawn, never of measured samples."""

NEWTON_PER_GRAM = 9.81e-3
TURNS = 4
"""Newton steps towards the angle at which weight and stiffness balance, with S' of small angles."""


class Gravity(Effect):
    name: ClassVar[str] = "gravity"
    acts_on: ClassVar[str] = "load"
    physics: ClassVar[str] = (
        "Weight per length makes a moment along the arc; as a generalised force on the angle of a "
        "constant-curvature arc it is w·al²/6·sin(φ + θ/2) for small angles. The actuator gives to it by its bending "
        "stiffness under pressure, which the simulation has: 15 g on 180 mm (chosen) against 10 000 N·mm² are 4.6° where level."
    )
    looks_like: ClassVar[str] = (
        "hanging: falls short in the middle of the range; level: a shift of one sign that changes with the way it bends"
    )
    shown_by: ClassVar[str] = "one design mounted hanging and level, or bending up and bending down"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "mass_g_per_m", "g/m", 0.0, 1000.0, 80.0, 0.0, (30.0, 100.0, 350.0), "mass of the actuator per length"
        ),
    )
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg", "flex_V")
    needs: ClassVar[tuple[str, ...]] = ("stiffness_Nmm2",)

    def cannot_show(self, scene: Scene) -> str:
        if not scene.lengths_known:
            return UNKNOWN_LENGTH
        if not np.isfinite(scene.orientation_deg).all():
            return "how the samples were mounted is not known (orientation_deg)"
        return ""

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        scene = at.scene
        mount = np.where(np.isfinite(scene.orientation_deg), scene.orientation_deg, HANGING_deg)
        stiffness = scene.curve("stiffness_Nmm2", np.maximum(at.load_MPa, 0.0), {})
        weight_N_per_mm = at.values["mass_g_per_m"] / 1000 * NEWTON_PER_GRAM
        bent = weight_N_per_mm * scene.length_mm**3 / (6 * stiffness)
        found = angle_deg
        for _ in range(TURNS if weight_N_per_mm else 0):
            off = found - angle_deg + np.degrees(bent * torque(found, mount))
            found = found - off / np.maximum(1 + bent / 2 * np.cos(np.radians(mount + found / 2)), 0.5)
        return found


def torque(angle_deg: FloatArray, mount_deg: FloatArray | float) -> FloatArray:
    """S(θ, φ): 6·∂V/∂θ/(w·al²) with V = −w·al²·[(cos φ − cos(φ + θ))/θ² − sin φ/θ], by its series below 0.2 rad.

    >>> torque(np.array([0.0, 20.0]), 90.0).round(3)
    array([1.   , 0.982])
    """
    theta, mount = np.radians(angle_deg), np.radians(mount_deg)
    far = np.where(np.abs(theta) < 0.2, 0.2, theta)
    end = mount + far
    exact = 6 * (2 * (np.cos(mount) - np.cos(end)) / far**3 - (np.sin(mount) + np.sin(end)) / far**2)
    near = np.sin(mount) * (1 - 3 * theta**2 / 20) + np.cos(mount) * (theta / 2 - theta**3 / 30)
    return np.asarray(np.where(np.abs(theta) < 0.2, near, exact))
