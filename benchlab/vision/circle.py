"""Circles through the markers, one for every frame: signed curvature that is 0 on a line, its uncertainty, residuals.

The sign is that of the walk along the points in their order: positive when the body turns from +x towards +y, which is
clockwise as seen in a picture with y down.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import UsageError
from benchlab.vision.circle_algebraic import hyper, kasa, pratt, taubin
from benchlab.vision.circle_geometric import feet, geometric, jacobian, middle
from benchlab.vision.circle_outliers import is_outlier, suspects, usual_scatter
from benchlab.vision.picture import FloatArray

BoolArray = NDArray[np.bool_]

FITS: dict[str, Callable[[FloatArray, FloatArray], FloatArray]] = {
    "kasa": kasa,
    "pratt": pratt,
    "taubin": taubin,
    "hyper": hyper,
    "geometric": geometric,
}

LARGEST_RADIUS_IN_SPANS = 1e9
TOO_FEW_PLACES = 1e-13


@dataclass(frozen=True)
class CircleFits:
    """T frames of N points. A frame with fewer than three usable places is NaN throughout.

    curvature: (T,) signed, per px; 0 to rounding on a line.
    curvature_sd_per_noise: (T,) its standard deviation when every coordinate has independent noise of sd 1 px, to first
        order (from the derivatives of the orthogonal distances at the solution); multiply by the noise in px. Per px².
    centre: (T, 2) px, radius: (T,) px; NaN on a line, that is where the radius exceeds 1e9 spans.
    residuals: (T, N) signed orthogonal distances in px, positive to the left of the walk as seen in a picture with y
        down, which is away from the centre of a positive curvature; NaN for unused points.
    rms: (T,) px, root mean square of the residuals.
    dof: (T,) used points less the three parameters, at least 0.
    arc_span: (T,) px along the curve from the first to the last used point; steps between neighbours (below 180°) are
        added up, so that it may pass a full turn.
    arc_positions: (T, N) px along the curve from the first used point; NaN for unused points.
    leverage: (T, N) share of a point's own noise that the fit follows; a residual has the variance
        noise²·(1 − leverage).
    """

    curvature: FloatArray
    curvature_sd_per_noise: FloatArray
    centre: FloatArray
    radius: FloatArray
    residuals: FloatArray
    rms: FloatArray
    dof: NDArray[np.int64]
    arc_span: FloatArray
    arc_positions: FloatArray
    leverage: FloatArray


def fit_circles(points: FloatArray, used: BoolArray | None = None, method: str = "taubin") -> CircleFits:
    """Fit a circle to the points of every frame.

    points: (T, N, 2) px, in order along the body; a point that is not finite is never used.
    used: (T, N), which points may enter; all by default.
    method: a name in FITS. Taubin, Pratt, HyperLS and the geometric fit are nearly unbiased and agree within a
        fraction of their noise; Kåsa bends short arcs too much.
    Raises UsageError for an unknown method or arrays that do not fit together.

    >>> quarter = np.deg2rad(np.linspace(0, 90, 7))
    >>> fit = fit_circles(50 * np.stack([np.cos(quarter), np.sin(quarter)], axis=-1)[None])
    >>> round(float(fit.curvature[0] * fit.arc_span[0] * 2 / np.pi), 12), round(float(fit.radius[0]), 9)
    (1.0, 50.0)
    """
    points, used = _checked(points, used, method)
    count = used.sum(axis=1)
    weights = used.astype(float)
    xy = np.where(used[..., None], points, 0.0)
    mean = xy.sum(axis=1) / np.maximum(count, 1)[:, None]
    xy = (xy - mean[:, None]) * weights[..., None]
    scale = np.sqrt((xy**2).sum(axis=(1, 2)) / np.maximum(count, 1))
    some = (count >= 3) & (scale > TOO_FEW_PLACES * np.abs(mean).max(axis=1))
    xy = xy / np.where(some, scale, 1.0)[:, None, None]
    rows = np.flatnonzero(some)
    rows = rows[_has_three_places(xy[rows], weights[rows])]
    abcd = FITS[method](xy[rows], weights[rows])
    fitted = np.isfinite(abcd).all(axis=1)
    rows, abcd = rows[fitted], abcd[fitted]
    return _described(
        abcd=abcd, xy=xy[rows], used=used[rows], mean=mean[rows], scale=scale[rows], rows=rows, count=count
    )


def fit_circles_robustly(
    points: FloatArray, used: BoolArray | None = None, method: str = "taubin", noise: float | FloatArray | None = None
) -> tuple[CircleFits, BoolArray]:
    """As `fit_circles`, leaving out at most one outlying marker a frame; the fits, and (T, N) which points they used.

    noise: px, sd of one coordinate, one for all or (T,); None takes it from the scatter of the frames around.
    The criterion is in `circle_outliers`: it asks for five points, for a gain far beyond chance and beyond what the
    smooth misfit of a body without constant curvature gives.
    """
    points, used = _checked(points, used, method)
    fits = fit_circles(points, used, method)
    n = used.sum(axis=1)
    squares = n * fits.rms**2
    scatter, scatter_dof = usual_scatter(squares, n - 3)
    rows = suspects(fits.residuals, fits.leverage, scatter)
    if not rows.size:
        return fits, used
    given = np.broadcast_to(np.asarray(0.0 if noise is None else noise, dtype=float), scatter.shape)
    known = given >= scatter
    reference, reference_dof = np.where(known, given, scatter), np.where(known, np.inf, scatter_dof)
    best, rest = _best_left_out(points[rows], used[rows], method)
    out = is_outlier(
        squares[rows],
        rest,
        n=n[rows],
        span=fits.arc_span[rows],
        noise=given[rows],
        reference=reference[rows],
        reference_dof=reference_dof[rows],
    )
    used[rows[out], best[out]] = False
    again = fit_circles(points[rows[out]], used[rows[out]], method)
    for field in fields(CircleFits):
        getattr(fits, field.name)[rows[out]] = getattr(again, field.name)
    return fits, used


def _best_left_out(points: FloatArray, used: BoolArray, method: str) -> tuple[NDArray[np.int64], FloatArray]:
    """(S,) which point is best left out of each frame, and (S,) the sum of squared residuals of the others."""
    frames, markers = used.shape
    without = used[:, None, :] & ~np.eye(markers, dtype=bool)
    fits = fit_circles(np.repeat(points, markers, axis=0), without.reshape(-1, markers), method)
    squares = (without.sum(axis=2).reshape(-1) * fits.rms**2).reshape(frames, markers)
    squares = np.where(used & np.isfinite(squares), squares, np.inf)
    best = np.argmin(squares, axis=1)
    return best, squares[np.arange(frames), best]


def _checked(points: FloatArray, used: BoolArray | None, method: str) -> tuple[FloatArray, BoolArray]:
    points = np.asarray(points, dtype=float)
    if method not in FITS:
        raise UsageError(f"no circle fit is called {method!r}", hint=f"choose one of {', '.join(FITS)}")
    if points.ndim != 3 or points.shape[2] != 2:
        raise UsageError(f"points have the shape {points.shape}, not (frames, points, 2)")
    finite = np.isfinite(points[..., 0]) & np.isfinite(points[..., 1])
    if used is not None and np.shape(used) != finite.shape:
        raise UsageError(f"`used` has the shape {np.shape(used)}, the points need {finite.shape}")
    return points, finite if used is None else finite & np.asarray(used, dtype=bool)


def _has_three_places(xy: FloatArray, weights: FloatArray) -> BoolArray:
    """(T,) whether the points lie at three places at least: the moments of (x²+y²−1, x, y) have rank two or more."""
    columns = np.stack([(xy[..., 0] ** 2 + xy[..., 1] ** 2 - 1) * weights, xy[..., 0], xy[..., 1]], axis=1)
    m = columns @ columns.transpose(0, 2, 1)
    trace = np.trace(m, axis1=1, axis2=2)
    minors = (trace**2 - (m**2).sum(axis=(1, 2))) / 2
    return minors > TOO_FEW_PLACES * trace**2


def _described(
    *,
    abcd: FloatArray,
    xy: FloatArray,
    used: BoolArray,
    mean: FloatArray,
    scale: FloatArray,
    rows: NDArray[np.int64],
    count: NDArray[np.int64],
) -> CircleFits:
    """Turn curves of centred and scaled points into px. They belong to the frames `rows`; `count` (T,) is for all."""
    at = feet(abcd, xy)
    positions = _arc_positions(xy - at.distance[..., None] * at.normal, at.normal, used)
    sign = np.where(positions[:, -1:].sum(axis=1) < 0, -1.0, 1.0)
    positions = positions * (sign * scale)[:, None]
    a = sign * abcd[:, 0]
    span = positions[:, -1:].sum(axis=1)
    curvature = 2 * a / scale
    bent = np.abs(curvature) * span * LARGEST_RADIUS_IN_SPANS > 1
    divisor = np.where(bent, 2 * abcd[:, 0], np.nan)
    residuals = np.where(used, at.distance * (sign * scale)[:, None], np.nan)
    frames = len(count)
    design = _design(abcd, xy, used)
    covariance = _inverse(design.transpose(0, 2, 1) @ design)
    leverage = ((design @ covariance) * design).sum(axis=2)
    return CircleFits(
        curvature=_spread(curvature + 0.0, rows, frames),
        curvature_sd_per_noise=_spread(2 * np.sqrt(covariance[:, 0, 0]) / scale**2, rows, frames),
        centre=_spread(mean - abcd[:, 1:3] * (scale / divisor)[:, None], rows, frames),
        radius=_spread(scale / np.abs(divisor), rows, frames),
        residuals=_spread(residuals, rows, frames),
        rms=_spread(np.sqrt((np.where(used, residuals, 0.0) ** 2).sum(axis=1) / used.sum(axis=1)), rows, frames),
        dof=np.maximum(count - 3, 0).astype(np.int64),
        arc_span=_spread(span, rows, frames),
        arc_positions=_spread(np.where(used, positions, np.nan), rows, frames),
        leverage=_spread(np.where(used, leverage, np.nan), rows, frames),
    )


def _arc_positions(foot: FloatArray, normal: FloatArray, used: BoolArray) -> FloatArray:
    """(T, N) signed arc length from the first used foot, along the normal turned a quarter from +x towards +y."""
    index = np.where(used, np.arange(used.shape[1]), -1)
    index = np.maximum.accumulate(index, axis=1)
    index = np.where(index < 0, (np.cumsum(used, axis=1) == 0).sum(axis=1)[:, None], index)[..., None]
    foot, normal = np.take_along_axis(foot, index, axis=1), np.take_along_axis(normal, index, axis=1)
    before, after = normal[:, :-1], normal[:, 1:]
    cross = before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0]
    turn = np.arctan2(cross, (before * after).sum(axis=-1))
    chord = foot[:, 1:] - foot[:, :-1]
    both = before + after
    forwards = np.sign(chord[..., 1] * both[..., 0] - chord[..., 0] * both[..., 1])
    steps = forwards * np.hypot(chord[..., 0], chord[..., 1]) / np.sinc(turn / (2 * np.pi))
    positions = np.zeros(used.shape)
    positions[:, 1:] = np.cumsum(steps, axis=1)
    return positions


def _design(abcd: FloatArray, xy: FloatArray, used: BoolArray) -> FloatArray:
    """(T, N, 3) derivatives of the distances at the curve, 0 for unused points."""
    rows, mid = np.arange(len(xy)), middle(used.astype(float))
    at = feet(abcd, xy[rows, mid][:, None])
    base = xy[rows, mid] - at.distance * at.normal[:, 0]
    return jacobian(2 * abcd[:, 0], base, at.normal[:, 0], xy)[1] * used[..., None]


def _inverse(matrices: FloatArray) -> FloatArray:
    """Inverses of symmetric positive 3×3 matrices (T, 3, 3), NaN where the determinant is not above rounding."""
    r = matrices
    rows = [np.cross(r[:, 1], r[:, 2]), np.cross(r[:, 2], r[:, 0]), np.cross(r[:, 0], r[:, 1])]
    determinant = (r[:, 0] * rows[0]).sum(axis=1)
    regular = determinant > TOO_FEW_PLACES**2 * np.trace(r, axis1=1, axis2=2) ** 3
    return np.stack(rows, axis=2) / np.where(regular, determinant, np.nan)[:, None, None]


def _spread(values: FloatArray, rows: NDArray[np.int64], frames: int) -> FloatArray:
    everywhere = np.full((frames, *values.shape[1:]), np.nan)
    everywhere[rows] = values
    return everywhere
