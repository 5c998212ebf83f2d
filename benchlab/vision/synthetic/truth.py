"""Where the markers of a drawn recording are, and how much of each can be seen."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from benchlab.vision.picture import FloatArray
from benchlab.vision.synthetic.geometry import local_shape, marker_points, to_picture
from benchlab.vision.synthetic.scene import Scene
from benchlab.vision.synthetic.things import thing_outlines

DISC_SAMPLES = 160


@dataclass(frozen=True)
class MarkerTruth:
    """T frames, N markers.

    positions_px: (T, N, 2) centres in the picture in the middle of the exposure; NaN where all of the marker is hidden.
    visible: (T, N) share of the marker that is inside the picture and not covered, 0 to 1.
    """

    positions_px: FloatArray
    visible: FloatArray


def _sunflower(n: int) -> FloatArray:
    """(n, 2) points spread evenly over the unit disc."""
    k = np.arange(n) + 0.5
    turn = k * np.pi * (3 - np.sqrt(5))
    return np.sqrt(k / n)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)


def _hidden(scene: Scene, points: FloatArray, frame: int) -> NDArray[np.bool_]:
    """(M,) whether picture points lie outside the picture or under an occluder."""
    x, y = points[:, 0], points[:, 1]
    hidden = (x < -0.5) | (y < -0.5) | (x > scene.width - 0.5) | (y > scene.height - 0.5)
    for thing in scene.occluders:
        for outline in thing_outlines(thing, frame):
            low, high = outline.min(axis=0), outline.max(axis=0)
            contour = outline.astype(np.float32)
            for k in np.flatnonzero(~hidden & (points >= low).all(axis=1) & (points <= high).all(axis=1)):
                hidden[k] = cv2.pointPolygonTest(contour, (float(x[k]), float(y[k])), False) > 0
    return hidden


def marker_truth(scene: Scene, angle_rad: FloatArray) -> MarkerTruth:
    """True picture positions of every marker for the bending angles (T,) of frames 0 … T−1, after perspective and lens.

    The bending angle is θ = κ·length_px; occluders stand where they are in that frame.
    """
    angles = np.atleast_1d(np.asarray(angle_rad, dtype=float))
    on_bench = marker_points(scene, angles)
    centres = to_picture(scene, on_bench)
    samples = scene.marker_radius_px * np.einsum(
        "...ij,kj->...ki", local_shape(scene, on_bench), _sunflower(DISC_SAMPLES)
    )
    points = centres[:, :, None, :] + samples
    visible = np.stack(
        [1 - _hidden(scene, p.reshape(-1, 2), t).reshape(scene.markers, -1).mean(axis=1) for t, p in enumerate(points)]
    )
    return MarkerTruth(positions_px=np.where(visible[..., None] > 0, centres, np.nan), visible=visible)
