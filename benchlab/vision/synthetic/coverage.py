"""How much of each pixel an ellipse covers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchlab.vision.picture import FloatArray

SCANLINES = 24
"""Lines per pixel row; along each line the covered length is exact."""


def ellipse_coverage(centres: FloatArray, shapes: FloatArray) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Covered share of every pixel in a square window around each ellipse {c + J·u, |u| ≤ 1}.

    centres: (K, 2) x, y. shapes: (K, 2, 2) J, so a disc of radius r is r times the unit matrix.
    Returns coverage (K, n, n), rows first, and the x, y of each window's first pixel (K, 2).

    >>> import math
    >>> window, corner = ellipse_coverage(np.array([[3.3, 4.1]]), 2.5 * np.eye(2)[None])
    >>> math.isclose(window.sum(), math.pi * 2.5**2, rel_tol=2e-3)
    True
    """
    quadric = np.linalg.inv(shapes @ shapes.transpose(0, 2, 1))
    reach = int(np.ceil(np.sqrt(np.max((shapes**2).sum(axis=2))))) + 1
    corner = np.rint(centres).astype(np.int64) - reach
    n = 2 * reach + 1
    lines = (np.arange(n * SCANLINES) + 0.5) / SCANLINES - 0.5
    dy = lines[None, :] + (corner[:, 1] - centres[:, 1])[:, None]
    a, b, c = quadric[:, 0, 0, None], quadric[:, 0, 1, None], quadric[:, 1, 1, None]
    discriminant = (b * dy) ** 2 - a * (c * dy**2 - 1)
    half = np.sqrt(np.maximum(discriminant, 0)) / a
    middle = (centres[:, 0] - corner[:, 0])[:, None] - b * dy / a
    left = np.where(discriminant > 0, middle - half, 0).astype(np.float32)[..., None]
    right = np.where(discriminant > 0, middle + half, 0).astype(np.float32)[..., None]
    pixels = np.arange(n, dtype=np.float32)
    covered = np.minimum(right, pixels + np.float32(0.5)) - np.maximum(left, pixels - np.float32(0.5))
    np.maximum(covered, 0, out=covered)
    covered[discriminant <= 0] = 0
    return covered.reshape(len(centres), n, SCANLINES, n).mean(axis=2), corner
