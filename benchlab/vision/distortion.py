"""Brown's lens distortion and its inverse, on the plane at distance 1 from the camera (x, y = tangents of view angles).

D. C. Brown (1971), "Close-range camera calibration", Photogrammetric Engineering 37, 855–866; its coefficients are
three radial and two tangential ones in OpenCV's order k1, k2, p1, p2, k3.
"""

from __future__ import annotations

import numpy as np

from benchlab.vision.picture import FloatArray

STEPS = 50
STILL = 1e-14
INVERTED = 1e-9


def bent(plane: FloatArray, coefficients: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where the lens puts points (..., 2), and the derivatives (..., 2, 2) of that."""
    k1, k2, p1, p2, k3 = coefficients
    x, y = plane[..., 0], plane[..., 1]
    r2 = x**2 + y**2
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    growth = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3))
    to_x = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x**2)
    to_y = y * radial + p1 * (r2 + 2 * y**2) + 2 * p2 * x * y
    across = x * y * growth + 2 * p1 * x + 2 * p2 * y
    xx = radial + x**2 * growth + 2 * p1 * y + 6 * p2 * x
    yy = radial + y**2 * growth + 6 * p1 * y + 2 * p2 * x
    slopes = np.stack([np.stack([xx, across], axis=-1), np.stack([across, yy], axis=-1)], axis=-2)
    return np.stack([to_x, to_y], axis=-1), slopes


def straightened(seen: FloatArray, coefficients: FloatArray) -> FloatArray:
    """The points (..., 2) that `bent` puts at `seen` (..., 2), by Newton's method from there; NaN where there is none.

    Where a fitted distortion folds the plane over itself, only the side of the fold that holds the centre counts.
    """
    plane = seen
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            there, slopes = bent(plane, coefficients)
            step = _solved(slopes, there - seen)
            plane = plane - step
            if not (np.abs(step) > STILL).any():
                break
        there, slopes = bent(plane, coefficients)
        unfolded = slopes[..., 0, 0] * slopes[..., 1, 1] > slopes[..., 0, 1] * slopes[..., 1, 0]
        hit = (np.abs(there - seen).max(axis=-1) < INVERTED) & unfolded
    return np.where(hit[..., None], plane, np.nan)


def _solved(slopes: FloatArray, right: FloatArray) -> FloatArray:
    """The solutions (..., 2) of 2×2 systems (..., 2, 2); not finite where there is none."""
    a, b, c, d = slopes[..., 0, 0], slopes[..., 0, 1], slopes[..., 1, 0], slopes[..., 1, 1]
    u, v = right[..., 0], right[..., 1]
    return np.stack([d * u - b * v, a * v - c * u], axis=-1) / (a * d - b * c)[..., None]
