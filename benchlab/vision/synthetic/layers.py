"""What is drawn on top of each other: bench, clutter, body, markers, occluders.

Every layer works on one rectangle of the picture, (x0, y0, x1, y1) with x0 and y0 even.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from benchlab.vision.picture import FloatArray, UInt8Array
from benchlab.vision.synthetic.coverage import ellipse_coverage
from benchlab.vision.synthetic.encode import Float32Array
from benchlab.vision.synthetic.geometry import local_shape, marker_points, ribbon, to_picture
from benchlab.vision.synthetic.scene import RGB, Scene
from benchlab.vision.synthetic.things import thing_colour, thing_outlines

Rect = tuple[int, int, int, int]


@dataclass(frozen=True)
class Part:
    """A rectangle of the picture: its colours (h, w, 3), drawn on in place, and the share of full light (h, w)."""

    rect: Rect
    rgb: Float32Array
    light: Float32Array


SHIFT = 4
"""Fractional bits of the corners of polygons."""

BODY_POSITIONS = 5
"""Positions of the body that are averaged while it moves."""


def light_field(scene: Scene) -> Float32Array:
    """(height, width) share of full light: a lamp at the upper left."""
    y, x = np.ogrid[: scene.height, : scene.width]
    distance = np.hypot(x / scene.width - 0.25, y / scene.height - 0.1) / np.hypot(0.75, 0.9)
    return np.asarray(1 - scene.light_gradient * distance**1.5, dtype=np.float32)


def backdrop(scene: Scene) -> UInt8Array:
    """(height, width, 3) the bench and the clamp, sharp and in full light."""
    canvas = np.empty((scene.height, scene.width, 3), dtype=np.uint8)
    canvas[:] = np.rint(scene.background_rgb)
    if scene.clamp:
        whole, wide = (0, 0, scene.width, scene.height), scene.body_width_px
        _fill(canvas, ribbon(scene, 0.0, (-3.2 * wide, -0.6 * wide), 2.6 * wide), whole, (58.0, 60.0, 64.0))
        _fill(canvas, ribbon(scene, 0.0, (-2.9 * wide, -0.9 * wide), 2.2 * wide), whole, (74.0, 76.0, 80.0))
    return canvas


def body_outline(scene: Scene, angle_rad: float, relative_width: float) -> FloatArray:
    """(M, 2) from inside the clamp to a little beyond the last marker."""
    span = (-1.2 * scene.body_width_px, scene.length_px + 0.8 * scene.body_width_px)
    return ribbon(scene, angle_rad, span, relative_width * scene.body_width_px)


def exposure_angles(scene: Scene, angle_rad: float, previous_rad: float) -> FloatArray:
    """Bending angles in the middle of equal parts of the exposure, which is centred on `angle_rad`.

    One part if nothing moves; else at least five, and no marker moves by more than a pixel in one.
    """
    sweep = (angle_rad - previous_rad) * scene.exposure_fraction
    ends = to_picture(scene, marker_points(scene, angle_rad + np.array([-0.5, 0.5]) * sweep))
    travel = float(np.linalg.norm(ends[1] - ends[0], axis=-1).max())
    if travel < 1e-3:
        return np.array([angle_rad])
    parts = max(5, int(np.ceil(travel)))
    return angle_rad + sweep * ((np.arange(parts) + 0.5) / parts - 0.5)


def flat_layers(scene: Scene, canvas: UInt8Array, rect: Rect, angles_rad: FloatArray, frame: int) -> Float32Array:
    """Clutter and the body, averaged over its positions `angles_rad` (S,), on the canvas; then defocus."""
    for thing in scene.clutter:
        for outline in thing_outlines(thing, frame):
            _fill(canvas, outline, rect, thing_colour(thing))
    moving = len(angles_rad) > 1
    shares = (np.arange(BODY_POSITIONS) + 0.5) / BODY_POSITIONS
    positions = np.quantile(angles_rad, shares) if moving else angles_rad
    total = np.zeros(canvas.shape, dtype=np.float32)
    for angle in positions:
        copy = canvas.copy()
        _add_body(scene, copy, rect, float(angle))
        cv2.accumulate(copy, total)
    return blurred(total / np.float32(len(positions)), scene.blur_px)


def add_markers(scene: Scene, part: Part, angles_rad: FloatArray) -> None:
    """Blend every marker in by the share of each pixel that it covers, averaged over the exposure."""
    points = marker_points(scene, angles_rad)
    shapes = scene.marker_radius_px * local_shape(scene, points)
    centres = to_picture(scene, points)
    _add_discs(scene, part, centres, shapes, (*scene.marker_rgb, 1.0))
    if scene.highlight:
        spots = centres - 0.35 * scene.marker_radius_px
        _add_discs(scene, part, spots, 0.25 * shapes, (255.0, 255.0, 255.0, scene.highlight))


def add_occluders(scene: Scene, part: Part, frame: int) -> None:
    """Draw what passes between the camera and the actuator."""
    for thing in scene.occluders:
        mask = np.zeros(part.light.shape, dtype=np.uint8)
        for outline in thing_outlines(thing, frame):
            _fill(mask, outline, part.rect, (255.0,))
        opacity = blurred(mask.astype(np.float32) / np.float32(255), scene.blur_px)
        _blend(part.rgb, part.light, opacity, thing_colour(thing))


def _fill(canvas: UInt8Array, outline: FloatArray, rect: Rect, colour: tuple[float, ...]) -> None:
    """A filled polygon with smooth edges. outline: (M, 2) picture coordinates."""
    corners = np.rint((outline - rect[:2]) * 2**SHIFT).astype(np.int32)
    cv2.fillPoly(canvas, [corners], colour, cv2.LINE_AA, SHIFT)


def blurred(canvas: Float32Array, sd_px: float) -> Float32Array:
    """(h, w) or (h, w, 3), out of focus by a Gaussian of this standard deviation."""
    return np.asarray(cv2.GaussianBlur(canvas, (0, 0), sd_px), dtype=np.float32) if sd_px else canvas


def _blend(rgb: Float32Array, light: Float32Array, opacity: Float32Array, colour: RGB) -> None:
    """Mix a lit colour into `rgb` (h, w, 3) by `opacity` (h, w), in place."""
    lit = light[..., None] * np.array(colour, dtype=np.float32)
    rgb += opacity[..., None] * (lit - rgb)


def _add_body(scene: Scene, canvas: UInt8Array, rect: Rect, angle_rad: float) -> None:
    """The body in three widths, the narrower the brighter, which makes it look round."""
    for width, shade in ((1.0, 0.5), (0.9, 0.22), (0.78, 0.0)):
        red, green, blue = (level * (1 - shade * scene.body_shading) for level in scene.body_rgb)
        _fill(canvas, body_outline(scene, angle_rad, width), rect, (red, green, blue))


def _add_discs(
    scene: Scene, part: Part, centres: FloatArray, shapes: FloatArray, colour: tuple[float, float, float, float]
) -> None:
    """Discs at S moments of the exposure: centres (S, N, 2), shapes (S, N, 2, 2), colour with opacity."""
    moments, count = centres.shape[:2]
    windows, corners = ellipse_coverage(centres.reshape(-1, 2), shapes.reshape(-1, 2, 2))
    n = windows.shape[1]
    windows, corners = windows.reshape(moments, count, n, n), corners.reshape(moments, count, 2)
    room = int(np.ceil(4 * scene.blur_px)) + 1 if scene.blur_px else 0
    for k in range(count):
        low = corners[:, k].min(axis=0) - room
        high = corners[:, k].max(axis=0) + n + room
        whole = np.zeros((high - low)[::-1], dtype=np.float32)
        for window, (x, y) in zip(windows[:, k], corners[:, k] - low, strict=True):
            whole[y : y + n, x : x + n] += window
        opacity = blurred(whole, scene.blur_px) * np.float32(colour[3] / moments)
        (left, top), (right, bottom) = np.maximum(low, part.rect[:2]), np.minimum(high, part.rect[2:])
        if left < right and top < bottom:
            inside = np.s_[top - part.rect[1] : bottom - part.rect[1], left - part.rect[0] : right - part.rect[0]]
            cut = opacity[top - low[1] : bottom - low[1], left - low[0] : right - low[0]]
            _blend(part.rgb[inside], part.light[inside], cut, colour[:3])
