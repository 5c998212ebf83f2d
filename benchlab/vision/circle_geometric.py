"""Orthogonal distances from a circle or line, their derivatives, and the fit that makes their squares least.

A curve is (A, B, C, D) with A(x²+y²) + Bx + Cy + D = 0 and B² + C² − 4AD = 1. With P the left side at a point, its
signed distance is d = 2P/(1 + √(1+4AP)), which holds for circles and lines alike (Chernov & Lesort 2005, J. Math.
Imaging and Vision 23, 239–252; Gander, Golub & Strebel 1994, BIT 34, 558–578, pose the problem).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchlab.vision.circle_algebraic import taubin
from benchlab.vision.picture import FloatArray

STEPS = 200
TOLERANCE = 1e-12
SMALLEST_STRETCH = 1e-6
LEAST_DAMPING = 1e-14  # of the trace: keeps the equations solvable where two points share a foot


@dataclass(frozen=True)
class Feet:
    """distance (T, N); normal (T, N, 2), the way it grows; stretch (T, N): distance from the centre over radius."""

    distance: FloatArray
    normal: FloatArray
    stretch: FloatArray


def feet(abcd: FloatArray, xy: FloatArray) -> Feet:
    """Signed distance and unit normal of every point (T, N, 2) for the curves (T, 4)."""
    a, b, c, d = (abcd[:, i, None] for i in range(4))
    x, y = xy[..., 0], xy[..., 1]
    algebraic = a * (x**2 + y**2) + b * x + c * y + d
    stretch = np.sqrt(np.maximum(1 + 4 * a * algebraic, 0.0))
    gradient = np.stack([2 * a * x + b, 2 * a * y + c], axis=-1)
    normal = gradient / np.maximum(stretch, SMALLEST_STRETCH)[..., None]
    return Feet(2 * algebraic / (1 + stretch), normal, stretch)


def middle(weights: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """(T,) index of the used point halfway along."""
    count = np.cumsum(weights, axis=1)
    return (2 * count < count[:, -1:]).sum(axis=1)


def jacobian(
    curvature: FloatArray, base: FloatArray, normal: FloatArray, xy: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Signed distances (T, N) and their derivatives (T, N, 3) to half the curvature, a shift along −normal, a turn.

    The curve passes through `base` (T, 2) with unit normal `normal` (T, 2) there and has the signed curvature (T,):
    three numbers that stay regular on lines and on full circles.
    """
    a = curvature[:, None] / 2
    step = xy - base[:, None, :]
    n, along_normal = normal[:, None, :], (step * normal[:, None, :]).sum(axis=-1)
    along_tangent = step[..., 1] * n[..., 0] - step[..., 0] * n[..., 1]
    square = along_normal**2 + along_tangent**2
    algebraic = a * square + along_normal
    stretch = np.sqrt(np.maximum(1 + 4 * a * algebraic, 0.0))
    distance = 2 * algebraic / (1 + stretch)
    columns = [square - distance**2, 1 + 2 * a * along_normal, along_tangent]
    return distance, np.stack(columns, axis=-1) / np.maximum(stretch, SMALLEST_STRETCH)[..., None]


def geometric(xy: FloatArray, weights: FloatArray) -> FloatArray:
    """Least squares of the orthogonal distances by Levenberg–Marquardt from Taubin's fit; (T, 4) as the algebraic fits.

    Every frame steps until its last step is below 1e-12 of its size; NaN where that takes more than 200 steps.
    """
    start = taubin(xy, weights)
    rows, mid = np.arange(len(xy)), middle(weights)
    at = feet(start, xy)
    normal = at.normal[rows, mid]
    # (half curvature, base x, base y, angle of the normal)
    state = np.column_stack(
        [start[:, 0], xy[rows, mid] - at.distance[rows, mid, None] * normal, np.arctan2(normal[:, 1], normal[:, 0])]
    )
    state = _iterated(state, xy, weights)
    a, base = state[:, 0], state[:, 1:3]
    normal = _direction(state[:, 3])
    slope = normal - 2 * a[:, None] * base
    return np.column_stack([a, slope, a * (base**2).sum(axis=1) - (normal * base).sum(axis=1)])


def _iterated(state: FloatArray, xy: FloatArray, weights: FloatArray) -> FloatArray:
    damping = np.zeros(len(xy))
    active = np.arange(len(xy))
    for _ in range(STEPS):
        if not active.size:
            return state
        points, w, old = xy[active], weights[active], state[active]
        distance, slopes = jacobian(2 * old[:, 0], old[:, 1:3], _direction(old[:, 3]), points)
        slopes = slopes * w[..., None]
        normal_matrix = slopes.transpose(0, 2, 1) @ slopes
        right = slopes.transpose(0, 2, 1) @ (distance * w)[..., None]
        scale = np.trace(normal_matrix, axis1=1, axis2=2) * (damping[active] + LEAST_DAMPING)
        step = -np.linalg.solve(normal_matrix + scale[:, None, None] * np.eye(3), right)[..., 0]
        new = np.column_stack(
            [old[:, 0] + step[:, 0], old[:, 1:3] - step[:, 1, None] * _direction(old[:, 3]), old[:, 3] + step[:, 2]]
        )
        now, _ = jacobian(2 * new[:, 0], new[:, 1:3], _direction(new[:, 3]), points)
        before, after = ((distance * w) ** 2).sum(axis=1), ((now * w) ** 2).sum(axis=1)
        better = after <= before * (1 + TOLERANCE) + TOLERANCE**2
        state[active[better]] = new[better]
        lower, higher = damping[active] / 10, np.maximum(10 * damping[active], 1e-3)
        done = better & (np.abs(step).max(axis=1) < TOLERANCE) & (damping[active] < 1e-3)
        damping[active] = np.where(better, np.where(lower < 1e-6, 0.0, lower), higher)
        active = active[~done]
    state[active] = np.nan
    return state


def _direction(angle: FloatArray) -> FloatArray:
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)
