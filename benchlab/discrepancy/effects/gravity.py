"""gravity: the actuator's own weight bends it, by the attitude in which it is mounted.

    θ → θ − q·(al/180 mm)²·C(p)·S(θ, φ)          S = 6/(W·al)·∂V/∂θ ≈ sin(φ + θ/2)          C = dθ/dp          (plain)

q `weight_MPa`: pressure whose bending moment is that of the weight of 180 mm where its middle is level, W·al/6 over
the moment per pressure; al: length (180 mm where it is not known). φ: attitude of the base, 0 hanging, 90 level and
bending upwards, 180 standing. V: potential energy of an arc of constant curvature and even weight; S is exact. C: how
far a little more pressure bends, taken from the base, which is what a little moment does where pressure acts as a
moment p·c with constant c. Forms: `secant`: C = θ/p; where the attitude is not told it is hanging, or, as forms,
`standing`, `level, bending up`, `level, bending down`.
By nature confounded: with softer or stiffer parts in one attitude; two attitudes tell it.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

ATTITUDE_deg = {"standing": 180.0, "level, bending up": 90.0, "level, bending down": -90.0}
"""Of the mounting, by form, where it is not told; 0, hanging, else."""

LENGTH_mm = 180.0


class Gravity(Effect):
    name: ClassVar[str] = "gravity"
    acts_on: ClassVar[str] = "load"
    physics: ClassVar[str] = (
        "Weight per length makes a moment along the arc; as a generalised force on the angle of a "
        "constant-curvature arc it is W·al/6·sin(φ + θ/2) for small angles. It works against the same stiffness as "
        "the pressure does, so it is told as a pressure: 15 g on 180 mm against 800 N·mm/MPa make 0.005 MPa "
        "(chosen)."
    )
    looks_like: ClassVar[str] = (
        "hanging: falls short in the middle of the range; level: a shift of one sign that changes with the way it bends"
    )
    shown_by: ClassVar[str] = "one design mounted hanging and level, or bending up and bending down"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "weight_MPa",
            "MPa",
            0.0,
            0.06,
            0.005,
            0.0,
            (0.002, 0.006, 0.02),
            "pressure that the weight outweighs where level",
        ),
    )
    forms: ClassVar[tuple[str, ...]] = ("plain", "secant", *ATTITUDE_deg)
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg", "flex_V")

    def cannot_show(self, scene: Scene) -> str:
        return (
            ""
            if np.isfinite(scene.orientation_deg).all()
            else "how the samples were mounted is not known (orientation_deg)"
        )

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        scene = at.scene
        told = scene.orientation_deg
        mount = np.where(np.isfinite(told), told, ATTITUDE_deg.get(at.form, 0.0))
        length = np.where(np.isfinite(scene.length_mm), scene.length_mm, LENGTH_mm)
        weight = at.values["weight_MPa"] * (length / LENGTH_mm) ** 2
        return angle_deg - weight * _compliance(at) * torque(angle_deg, mount)


def _compliance(at: At) -> FloatArray:
    """(T, R): C in °/MPa."""
    at_rest = at.scene.slope("angle_deg", np.maximum(at.load_MPa, 0.0))
    if at.form != "secant":
        return at_rest
    above = np.maximum(at.load_MPa, 1e-3)
    return at.scene.curve("angle_deg", above, {}) / above


def torque(angle_deg: FloatArray, mount_deg: FloatArray | float) -> FloatArray:
    """S(θ, φ): 6·∂V/∂θ/(W·al) with V = −W·al·[(cos φ − cos(φ + θ))/θ² − sin φ/θ], by its series below 0.2 rad.

    >>> torque(np.array([0.0, 20.0]), 90.0).round(3)
    array([1.   , 0.982])
    """
    theta, mount = np.radians(angle_deg), np.radians(mount_deg)
    far = np.where(np.abs(theta) < 0.2, 0.2, theta)
    end = mount + far
    exact = 6 * (2 * (np.cos(mount) - np.cos(end)) / far**3 - (np.sin(mount) + np.sin(end)) / far**2)
    near = np.sin(mount) * (1 - 3 * theta**2 / 20) + np.cos(mount) * (theta / 2 - theta**3 / 30)
    return np.asarray(np.where(np.abs(theta) < 0.2, near, exact))
