"""An arc in space, through a pinhole onto a picture, and a circle through what is seen there."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tests.blind.generator.station import FloatArray

MARKERS = 11
GRID_deg = np.linspace(-40.0, 240.0, 141)

Place = Callable[[FloatArray, float], FloatArray]
"""Markers in the plane of bending (A, M, 2), mm, as (towards the bending side, along the base's axis), for angles (A,) in rad."""
Look = Callable[[FloatArray], FloatArray]
"""From points in space (..., 3), mm, third towards the camera, to points of the picture (..., 2), in mm of its scale."""


def on_the_line(angle_rad: FloatArray, length_mm: float, aside_mm: FloatArray | float = 0.0) -> FloatArray:
    """Markers evenly along the arc, `aside_mm` from it, away from the centre of bending."""
    part = np.linspace(0, 1, MARKERS)
    turned = angle_rad[:, None] * part
    half = np.sinc(turned / 2 / np.pi) * length_mm * part
    x, z = half * np.sin(turned / 2), half * np.cos(turned / 2)
    aside = np.asarray(aside_mm)
    return np.stack([x - aside * np.cos(turned), z + aside * np.sin(turned)], axis=-1)


def straight_on(points: FloatArray) -> FloatArray:
    return points[..., :2]


def pinhole(distance_mm: float, nearer_mm: float = 0.0, turned_rad: float = 0.0, about: int = 1) -> Look:
    """A camera at `distance_mm` from the plane in which the scale was taken.

    nearer_mm: the actuator's plane is so much nearer. turned_rad: it is turned about its base's axis (about = 1) or about the
    direction across (0).
    """

    def look(points: FloatArray) -> FloatArray:
        x, z, depth = points[..., 0], points[..., 1], points[..., 2]
        c, s = np.cos(turned_rad), np.sin(turned_rad)
        if about == 1:
            x, depth = c * x - s * depth, s * x + c * depth
        else:
            z, depth = c * z - s * depth, s * z + c * depth
        larger = distance_mm / (distance_mm - nearer_mm - depth)
        return np.stack([x * larger, z * larger], axis=-1)

    return look


def seen_deg(angle_deg: FloatArray, length_mm: float, look: Look, place: Place = on_the_line) -> FloatArray:
    """The angle that a circle through the markers of the picture gives, curvature times length, for any array of angles."""
    flat = place(np.radians(GRID_deg), length_mm)
    picture = look(np.concatenate([flat, np.zeros_like(flat[..., :1])], axis=-1))
    return np.interp(angle_deg, GRID_deg, np.degrees(curvatures(picture) * length_mm))


def curvatures(points: FloatArray) -> FloatArray:
    """(A,) 1/mm of circles A(x² + z²) + Bx + Cz + D = 0 nearest to points (A, M, 2); positive towards x.

    The smallest singular vector, in scaled and centred coordinates: a line is a circle like others.
    """
    centre = points.mean(axis=1, keepdims=True)
    scale = np.sqrt(np.mean((points - centre) ** 2, axis=(1, 2)))[:, None, None]
    x, z = np.moveaxis((points - centre) / scale, -1, 0)
    square = x * x + z * z
    mean = square.mean(axis=1, keepdims=True)
    rows = np.stack([(square - mean) / (2 * np.sqrt(mean)), x, z], axis=-1)
    A, B, C = np.moveaxis(np.linalg.svd(rows, full_matrices=False)[2][:, -1], -1, 0)
    A = A / (2 * np.sqrt(mean[:, 0]))
    D = -A * mean[:, 0]
    found = 2 * A / np.sqrt(B * B + C * C - 4 * A * D) / scale[:, 0, 0]
    # The base's tangent is along z, the centre of bending on the side of x where −B/A > 0 in base's coordinates.
    at_base = points[:, 0] - centre[:, 0]
    towards = -(B * scale[:, 0, 0] + 2 * A * at_base[:, 0]) / scale[:, 0, 0]
    return np.where(towards * A > 0, 1, -1) * np.abs(found)
