"""A painter of curved surfaces: small flat faces with Lambert's shading, the farthest first, seen without perspective."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
UInt8Array = NDArray[np.uint8]

SUPERSAMPLED = 3
_FRACTION_BITS = 4
_AMBIENT, _LAMBERT, _GLOSS = 0.58, 0.46, 0.08
_LIGHT = np.array([-0.45, 0.65, 0.75])
"""Where light comes from, in the picture's axes: to the right, up, towards the viewer."""


@dataclass(frozen=True)
class View:
    """Where a picture is seen from: unit vectors to the right, up and towards the viewer, as rows."""

    axes: FloatArray

    @classmethod
    def of(cls, towards: tuple[float, float, float], up: tuple[float, float, float]) -> View:
        """From the direction `towards`, with `up` upwards in the picture.

        >>> View.of((0, 0, 1), (0, 1, 0)).axes.tolist()
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        """
        viewer = np.array(towards, dtype=float) / np.linalg.norm(towards)
        right = np.cross(np.array(up, dtype=float), viewer)
        right /= np.linalg.norm(right)
        return cls(np.stack([right, np.cross(viewer, right), viewer]))


@dataclass(frozen=True)
class Faces:
    """Quadrilaterals to paint: corners_mm (n, 4, 3), normals (n, 3) outwards, colours of outer and inner side (n, 3) in 0..1.

    lines (n, 4): whether the edge from each corner to the next is drawn dark.
    """

    corners_mm: FloatArray
    normals: FloatArray
    outer: FloatArray
    inner: FloatArray
    lines: NDArray[np.bool_]

    def towards(self, view: View) -> Faces:
        """Only those whose outer side is seen: enough for a closed surface."""
        seen = self.normals @ view.axes[2] > -0.02
        return Faces(*(getattr(self, name)[seen] for name in vars(self)))

    def joined(self, other: Faces) -> Faces:
        return Faces(*(np.concatenate([getattr(self, name), getattr(other, name)]) for name in vars(self)))


@dataclass(frozen=True)
class Painting:
    """rgba (height, width, 4), transparent where there is nothing; pixels a millimetre."""

    rgba: UInt8Array
    px_per_mm: float


def paint(faces: Faces, view: View, size_px: tuple[int, int]) -> Painting:
    """The faces as large as they fit into (width, height)."""
    seen = faces.corners_mm @ view.axes.T
    low, high = seen[..., :2].min(axis=(0, 1)), seen[..., :2].max(axis=(0, 1))
    scale = float(((np.array(size_px) - 4) / np.maximum(high - low, 1e-9)).min())
    centre = (low + high) / 2
    flat = (seen[..., :2] - centre) * [1, -1] * scale + np.array(size_px) / 2
    fine = np.round((flat * SUPERSAMPLED - 0.5) * (1 << _FRACTION_BITS)).astype(np.int32)
    colours, dark = _shaded(faces, view)
    canvas = np.zeros((size_px[1] * SUPERSAMPLED, size_px[0] * SUPERSAMPLED, 4), np.uint8)
    width = max(1, round(0.55 * SUPERSAMPLED))
    lined: list[bool] = np.any(faces.lines, axis=1).tolist()
    depth: FloatArray = seen[..., 2].mean(axis=1)
    for index in np.argsort(depth, kind="stable").tolist():
        corners = fine[index]
        cv2.fillConvexPoly(canvas, corners, colours[index], cv2.LINE_8, _FRACTION_BITS)
        if lined[index]:
            for side in np.flatnonzero(faces.lines[index]).tolist():
                start, end = corners[side].tolist(), corners[(side + 1) % 4].tolist()
                cv2.line(canvas, start, end, dark[index], width, cv2.LINE_8, _FRACTION_BITS)
    return Painting(_reduced(canvas, size_px), scale)


def _shaded(faces: Faces, view: View) -> tuple[list[list[float]], list[list[float]]]:
    """Colours (0..255 with alpha) of faces and of their lines; the side that looks at the viewer counts."""
    normals = faces.normals @ view.axes.T
    front = normals[:, 2] >= 0
    normals = np.where(front[:, None], normals, -normals)
    light = _LIGHT / np.linalg.norm(_LIGHT)
    half = light + np.array([0.0, 0.0, 1.0])
    half /= np.linalg.norm(half)
    lambert = np.clip(normals @ light, 0, 1)
    gloss = np.where(front, np.clip(normals @ half, 0, 1) ** 40, 0)
    strength = np.where(front, 1.0, 0.78) * (_AMBIENT + _LAMBERT * lambert)
    base = np.where(front[:, None], faces.outer, faces.inner)
    colours = np.clip(base * strength[:, None] + _GLOSS * gloss[:, None], 0, 1)
    opaque = np.ones((len(colours), 1))
    return (255 * np.hstack([colours, opaque])).tolist(), (255 * np.hstack([0.45 * colours, opaque])).tolist()


def _reduced(canvas: UInt8Array, size_px: tuple[int, int]) -> UInt8Array:
    """Averaged over the fine pixels, colours weighted with what is there."""
    whole = canvas.astype(np.float32)
    weight = cv2.resize(whole[..., 3], size_px, interpolation=cv2.INTER_AREA)
    sums = cv2.resize(whole[..., :3] * (whole[..., 3:] / 255), size_px, interpolation=cv2.INTER_AREA)
    colours = sums / np.maximum(weight / 255, 1e-6)[..., None]
    return np.dstack([colours, weight]).round().clip(0, 255).astype(np.uint8)
