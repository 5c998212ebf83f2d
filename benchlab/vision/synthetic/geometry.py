"""Where the points of a bending body lie, on the bench and in the picture."""

from __future__ import annotations

import numpy as np

from benchlab.vision.picture import FloatArray
from benchlab.vision.synthetic.scene import Scene


def arc_points(
    scene: Scene, angle_rad: FloatArray, along_px: FloatArray, across_px: FloatArray | float = 0.0
) -> FloatArray:
    """Points of the bench plane at arc length `along_px` from the first marker and `across_px` to its right.

    angle_rad: (T,). along_px, across_px: (M,). Returns (T, M, 2).
    The chord of an arc of length s and curvature κ is s·sin(κs/2)/(κs/2) long and turned by κs/2, which holds on a
    straight line too. Before the first marker the body is straight: it is held there.
    """
    kappa = scene.bend_sign * np.asarray(angle_rad, dtype=float)[:, None] / scene.length_px
    turn = kappa * np.maximum(along_px, 0)
    chord = along_px * np.sinc(turn / (2 * np.pi))
    middle = scene.heading_rad + turn / 2
    end = scene.heading_rad + turn
    x = scene.base_px[0] + chord * np.cos(middle) - across_px * np.sin(end)
    y = scene.base_px[1] + chord * np.sin(middle) + across_px * np.cos(end)
    return np.stack([x, y], axis=-1)


def to_picture(scene: Scene, points: FloatArray) -> FloatArray:
    """Points of the bench plane (..., 2), in untilted pixels, as the tilted camera with its lens shows them."""
    if not (scene.tilt_rad or scene.lens_k1 or scene.lens_k2):
        return points
    middle = np.array([(scene.width - 1) / 2, (scene.height - 1) / 2])
    axis = np.array([np.cos(scene.tilt_axis_rad), np.sin(scene.tilt_axis_rad)])
    normal = np.array([-axis[1], axis[0]])
    offset = points - middle
    u, v = offset @ axis, offset @ normal
    depth = 1 + v * np.sin(scene.tilt_rad) / scene.focal_px
    flat = (u[..., None] * axis + (v * np.cos(scene.tilt_rad))[..., None] * normal) / depth[..., None]
    r2 = (flat**2).sum(axis=-1, keepdims=True) / scene.focal_px**2
    return middle + flat * (1 + scene.lens_k1 * r2 + scene.lens_k2 * r2**2)


def local_shape(scene: Scene, points: FloatArray) -> FloatArray:
    """(..., 2, 2): how `to_picture` stretches a small neighbourhood of each point of the bench plane."""
    if not (scene.tilt_rad or scene.lens_k1 or scene.lens_k2):
        return np.broadcast_to(np.eye(2), (*points.shape, 2))
    step = 0.5
    columns = [
        (to_picture(scene, points + step * unit) - to_picture(scene, points - step * unit)) / (2 * step)
        for unit in np.eye(2)
    ]
    return np.stack(columns, axis=-1)


def marker_points(scene: Scene, angle_rad: FloatArray) -> FloatArray:
    """(T, N, 2) marker centres on the bench plane, evenly spaced along the arc but for their placement errors."""
    along = np.linspace(0, scene.length_px, scene.markers)
    offset = np.array(scene.marker_offset_px).reshape(-1, 2) if scene.marker_offset_px else np.zeros((scene.markers, 2))
    return arc_points(scene, angle_rad, along + offset[:, 0], offset[:, 1])


def ribbon(
    scene: Scene, angle_rad: float, span_px: tuple[float, float], width_px: float, samples: int = 72
) -> FloatArray:
    """(2·samples, 2) outline in the picture of the body between two arc lengths, of a given width."""
    along = np.linspace(*span_px, samples)
    sides = [arc_points(scene, np.array([angle_rad]), along, side * width_px / 2)[0] for side in (-1, 1)]
    return to_picture(scene, np.concatenate([sides[0], sides[1][::-1]]))
