"""Algebraic circle fits, batched over frames: A(x²+y²) + Bx + Cy + D = 0 as the null direction of a moment matrix.

All work in the frame of `circle.fit_circles`: points centred on their mean and scaled so that the mean of x²+y² is
1. They differ in the quantity that is held constant while the algebraic residual is made small (Al-Sharadqah &
Chernov 2009, "Error analysis for circle fitting algorithms", Electronic Journal of Statistics 3,
886–911, doi:10.1214/09-EJS419).

xy is (T, N, 2), zero where unused; weights is (T, N), 1 for used points and 0 for others. Each fit returns (T, 4) rows
(A, B, C, D) with B² + C² − 4AD = 1, so that 2A is the curvature and A = 0 is an ordinary line; NaN where there is none.
"""

from __future__ import annotations

import numpy as np

from benchlab.vision.picture import FloatArray

ROUNDING = 1e-13


def kasa(xy: FloatArray, weights: FloatArray) -> FloatArray:
    """Kåsa (1976, IEEE Trans. Instrum. Meas. 25, 8–14): A = 1, linear least squares.

    Short arcs come out too strongly curved, the more so the noisier. On a line the linear system is singular; here
    it is written in the principal axes of the points and multiplied by the variance across them, so that it tends to
    the line, and points on a line to rounding give the line itself (curvature 0).
    """
    xx, yy, cross = (_mean(xy[..., i] * xy[..., j], weights) for i, j in ((0, 0), (1, 1), (0, 1)))
    angle = 0.5 * np.arctan2(2 * cross, xx - yy)
    cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
    along, across = xy[..., 0] * cos + xy[..., 1] * sin, xy[..., 1] * cos - xy[..., 0] * sin
    z = along**2 + across**2
    curvature = _mean(across**2, weights)
    slope_along = -curvature * _mean(along * z, weights) / _mean(along**2, weights)
    slope_across = -_mean(across * z, weights)
    straight = np.sqrt(curvature) < ROUNDING
    curvature = np.where(straight, 0.0, curvature)
    slope_along, slope_across = np.where(straight, 0.0, slope_along), np.where(straight, 1.0, slope_across)
    b = slope_along * cos[:, 0] - slope_across * sin[:, 0]
    c = slope_along * sin[:, 0] + slope_across * cos[:, 0]
    return _normalised(np.stack([curvature, b, c, -curvature * _mean(z, weights)], axis=1))


def taubin(xy: FloatArray, weights: FloatArray) -> FloatArray:
    """Taubin (1991, IEEE Trans. PAMI 13, 1115–1138): the mean square gradient is held constant.

    With centred points D = −A·mean(x²+y²) drops out, and what is left is an ordinary symmetric 3×3 eigenproblem.
    """
    z = (xy[..., 0] ** 2 + xy[..., 1] ** 2 - 1) * (0.5 * weights)
    columns = np.stack([z, xy[..., 0], xy[..., 1]], axis=1)
    a = np.linalg.eigh(columns @ columns.transpose(0, 2, 1))[1][:, :, 0]
    return np.stack([a[:, 0] / 2, a[:, 1], a[:, 2], -a[:, 0] / 2], axis=1)


def pratt(xy: FloatArray, weights: FloatArray) -> FloatArray:
    """Pratt (1987, SIGGRAPH Computer Graphics 21, 145–152): B² + C² − 4AD is held constant."""
    inverse = np.array([[0, 0, 0, -0.5], [0, 1, 0, 0], [0, 0, 1, 0], [-0.5, 0, 0, 0]])
    return _smallest_non_negative(inverse, xy, weights)


def hyper(xy: FloatArray, weights: FloatArray) -> FloatArray:
    """HyperLS (Al-Sharadqah & Chernov 2009): 8A² + B² + C² + 4AD, which cancels the essential bias."""
    inverse = np.array([[0, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0], [0.5, 0, 0, -2]])
    return _smallest_non_negative(inverse, xy, weights)


def _smallest_non_negative(inverse: FloatArray, xy: FloatArray, weights: FloatArray) -> FloatArray:
    """Solve M a = η N a, N given by its inverse. N has one negative eigenvalue and M none, so that one η is negative
    and the wanted one is the second from below, also where rounding puts it a little under 0."""
    z = xy[..., 0] ** 2 + xy[..., 1] ** 2
    columns = np.stack([z, xy[..., 0], xy[..., 1], weights], axis=1)
    moments = columns @ columns.transpose(0, 2, 1) / weights.sum(axis=1)[:, None, None]
    values, vectors = np.linalg.eig(inverse @ moments)
    second = np.argsort(values.real, axis=1)[:, 1]
    return _normalised(vectors.real[np.arange(len(xy)), :, second])


def _normalised(abcd: FloatArray) -> FloatArray:
    square = abcd[:, 1] ** 2 + abcd[:, 2] ** 2 - 4 * abcd[:, 0] * abcd[:, 3]
    return abcd / np.sqrt(np.where(square > 0, square, np.nan))[:, None]


def _mean(values: FloatArray, weights: FloatArray) -> FloatArray:
    return (values * weights).sum(axis=1) / weights.sum(axis=1)
