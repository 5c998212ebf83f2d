"""camera_tilt: the camera does not look square at the plane of bending, and one direction is foreshortened.

    (x, z) → (x, z·cos β) (plain: along the base)          κ_seen: of the circle through the foreshortened arc, by least squares

β `tilt_deg`. Form `across`: (x·cos β, z). The circle is fitted by linear least squares (Kåsa, IEEE Trans. Instrum.
Meas. 25, 8, 1976) to 11 markers, evenly along the arc; θ_seen = κ_seen·al. For small angles κ_seen = κ/cos² β, across
κ·cos β; near 180° the two directions even out. Perspective is left out.
By nature confounded: with a scale error over small angles; angles beyond 90° tell.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.units import FloatArray

MARKERS = 11
NODES_deg = np.linspace(0.5, 400.5, 81)
"""Angles at which the ratio of seen to true angle is computed; straight between."""


class CameraTilt(Effect):
    name: ClassVar[str] = "camera_tilt"
    acts_on: ClassVar[str] = "sensor"
    physics: ClassVar[str] = (
        "A camera far away sees a plane that is tilted by β shortened by cos β in one direction (the affine camera "
        "of Hartley and Zisserman, Multiple View Geometry, 2004), and the arc as part of an ellipse, through which "
        "a circle is fitted."
    )
    looks_like: ClassVar[str] = (
        "a gap that changes its sign with the angle, the same for all designs, rates and directions"
    )
    shown_by: ClassVar[str] = "a square in the plane of bending, filmed with the actuator"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "tilt_deg", "deg", 0.0, 45.0, 8.0, 0.0, (6.0, 12.0, 25.0), "angle between camera axis and the normal"
        ),
    )
    forms: ClassVar[tuple[str, ...]] = ("plain", "across")
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg",)

    def camera(self, angle_deg: FloatArray, at: At) -> FloatArray:
        tilt = at.values["tilt_deg"]
        if tilt == 0:
            return angle_deg
        ratio = seen_over_true(NODES_deg, tilt, across=at.form == "across")
        return angle_deg * np.interp(np.abs(angle_deg), NODES_deg, ratio)


def seen_over_true(angle_deg: FloatArray, tilt_deg: float, *, across: bool) -> FloatArray:
    """(N,): κ_seen/κ of arcs of these angles, in (0, 400].

    >>> seen_over_true(np.array([1.0]), 10.0, across=False).round(3)
    array([1.031])
    """
    theta = np.radians(angle_deg)[:, None]
    along = np.linspace(0, 1, MARKERS) * theta
    squeeze = np.cos(np.radians(tilt_deg))
    x, z = 1 - np.cos(along), np.sin(along)  # in radii
    x, z = (x * squeeze, z) if across else (x, z * squeeze)
    size = np.hypot(np.ptp(x, axis=1), np.ptp(z, axis=1))[:, None]
    x, z = (x - x.mean(axis=1, keepdims=True)) / size, (z - z.mean(axis=1, keepdims=True)) / size
    matrix = np.stack([x, z, np.ones_like(x)], axis=2)
    right = x**2 + z**2
    twice = np.linalg.solve(matrix.transpose(0, 2, 1) @ matrix, np.einsum("nmk,nm->nk", matrix, right)[:, :, None])[
        ..., 0
    ]
    radius = np.sqrt(twice[:, 2] + (twice[:, 0] ** 2 + twice[:, 1] ** 2) / 4) * size[:, 0]
    return np.asarray(1 / radius)
