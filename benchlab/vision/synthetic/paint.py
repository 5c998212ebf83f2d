"""Frames of a scene: the still picture, the part that moves drawn anew, noise, and rounding to 8 bits."""

from __future__ import annotations

from collections.abc import Iterator

import cv2
import numpy as np

from benchlab.vision.picture import FloatArray, Planes, UInt8Array
from benchlab.vision.synthetic.encode import SITING, Float32Array, rgb_to_ycc, subsample, ycc_matrix
from benchlab.vision.synthetic.layers import (
    Part,
    Rect,
    add_markers,
    add_occluders,
    backdrop,
    blurred,
    body_outline,
    exposure_angles,
    flat_layers,
    light_field,
)
from benchlab.vision.synthetic.noise import NoisePool
from benchlab.vision.synthetic.scene import Scene
from benchlab.vision.synthetic.things import thing_outlines

Channels = tuple[Float32Array, Float32Array, Float32Array]


def draw_frame(scene: Scene, angle_rad: float, previous_rad: float, rng: np.random.Generator, frame: int = 0) -> Planes:
    """One frame whose exposure is centred on `angle_rad`; the body came from `previous_rad` one frame before.

    frame: its number, which says where drifting things are.
    """
    return _Painter(scene, rng, noise_fields=1).paint(angle_rad, previous_rad, frame)


def draw_frames(
    scene: Scene, angles_rad: FloatArray, rng: np.random.Generator, noise_fields: int = 6
) -> Iterator[Planes]:
    """The frames of the bending angles (T,), in order; each has arrays of its own. The first one stands still.

    Noise is cut at random places from `noise_fields` fields, each larger than the picture.
    """
    painter = _Painter(scene, rng, noise_fields)
    angles = np.asarray(angles_rad, dtype=float)
    for frame, angle in enumerate(angles):
        yield painter.paint(float(angle), float(angles[max(frame - 1, 0)]), frame)


class _Painter:
    """What stays the same from frame to frame, prepared once."""

    def __init__(self, scene: Scene, rng: np.random.Generator, noise_fields: int) -> None:
        self._scene = scene
        self._rng = rng
        self._matrix = ycc_matrix(scene.matrix, scene.full_range)
        self._backdrop = backdrop(scene)
        self._light = light_field(scene)
        bench = blurred(self._backdrop.astype(np.float32), scene.blur_px)
        self._still = self._channels(bench * self._light[..., None])
        self._noise = NoisePool(scene, rng, noise_fields) if scene.noise_sd else None

    def paint(self, angle_rad: float, previous_rad: float, frame: int) -> Planes:
        """The frame of one bending angle."""
        scene = self._scene
        angles = exposure_angles(scene, angle_rad, previous_rad)
        rect = _moving_part(scene, angles, frame)
        inside = np.s_[rect[1] : rect[3], rect[0] : rect[2]]
        flat = flat_layers(scene, self._backdrop[inside].copy(), rect, angles, frame)
        light = self._light[inside]
        part = Part(rect, flat * light[..., None], light)
        add_markers(scene, part, angles)
        add_occluders(scene, part, frame)
        return self._planes(rect, self._channels(part.rgb))

    def _channels(self, rgb: Float32Array) -> Channels:
        ycc = rgb_to_ycc(rgb, self._matrix)
        siting = self._scene.chroma_siting
        return ycc[..., 0], subsample(ycc[..., 1], siting), subsample(ycc[..., 2], siting)

    def _planes(self, rect: Rect, moving: Channels) -> Planes:
        """The still picture with the moving part put in, noise added and rounded."""
        scene = self._scene
        noise = self._noise.cut(self._rng) if self._noise else (None, None, None)
        pictures = []
        for step, still, part, grain in zip((1, 2, 2), self._still, moving, noise, strict=True):
            x0, y0, x1, y1 = rect[0] // step, rect[1] // step, -(-rect[2] // step), -(-rect[3] // step)
            skip = 1 if step == 2 and x0 else 0  # its chroma filter reaches outside the part
            place = np.s_[y0:y1, x0 + skip : x1]
            picture = _rounded(still, grain)
            picture[place] = _rounded(part[:, skip:], None if grain is None else grain[place])
            pictures.append(picture)
        luma, cb, cr = pictures
        return Planes(luma, cb, cr, (2, 2), SITING[scene.chroma_siting], scene.full_range, scene.matrix)


def _moving_part(scene: Scene, angles_rad: FloatArray, frame: int) -> Rect:
    """The rectangle outside of which the picture is the still one, with room for blur and chroma filter."""
    body = [body_outline(scene, angle, 1.5) for angle in (float(angles_rad[0]), float(angles_rad[-1]))]
    things = [outline for thing in (*scene.clutter, *scene.occluders) for outline in thing_outlines(thing, frame)]
    points = np.concatenate(body + things)
    margin, size = 8 + np.ceil(4 * scene.blur_px), np.array([scene.width, scene.height])
    low = np.clip(np.floor(points.min(axis=0) - margin), 0, size - 16).astype(int) // 2 * 2
    high = np.clip(np.ceil(points.max(axis=0) + margin), low + 16, size).astype(int)
    high = np.minimum(high + high % 2, size)
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])


def _rounded(values: Float32Array, noise: Float32Array | None) -> UInt8Array:
    """8-bit levels, halves to even, kept within 0–255 as a sensor does."""
    if noise is None:
        return np.clip(np.rint(values), 0, 255).astype(np.uint8)
    return np.asarray(cv2.add(np.ascontiguousarray(values), noise, dtype=cv2.CV_8U), dtype=np.uint8)
