"""When one marker of a frame may be left out of its circle: the tests, without the fits.

Leaving out the best of n points always lowers the sum of squares; the question is whether it does so decisively. Let
SS be the sum of squares of all n residuals, SS_i that of the fit without point i, and F_i = (SS − SS_i)(n − 4)/SS_i.
The denominator SS_i/(n − 4) is never taken below the noise that is given. A point is an outlier when both hold:

1. F_i ≥ 20. A body that is not of constant curvature has residuals that are smooth along it; their leading, cubic part
   gives F_i ≈ 7 for an end point whatever n, so that bodies are not trimmed into circles.
2. It is too much for chance, with Bonferroni's factor n for having looked at all points: n·P(F > f) < 1e-4, either
   within the frame, f = F_i with (1, n − 4) degrees of freedom, or against what this recording usually shows,
   f = (SS − SS_i)/s² with s the larger of the noise given and the median scatter of the frames around. What persists in
   time is the body's shape and enters s; an outlier comes and goes.

The first comparison is made from seven points on: with five, the fourth-order part of a body's shape can look exactly
like a middle point gone astray. So a single picture of five markers keeps all five.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter
from scipy.special import chdtrc, chdtri, fdtrc

from benchlab.vision.picture import FloatArray

FEWEST_POINTS = 5
FEWEST_POINTS_WITHIN_A_FRAME = 7
DECISIVE = 20.0
CHANCE = 1e-4
FRAMES_AROUND = 31
ROUNDING_IN_SPANS = 1e-10


def usual_scatter(squares: FloatArray, dof: NDArray[np.int64]) -> tuple[FloatArray, FloatArray]:
    """Median scatter (px per degree of freedom) of up to 31 frames around each, and the degrees of freedom behind it.

    squares: (T,) sum of squared residuals, NaN where there is no fit. A frame without a fit or without degrees of
    freedom has NaN and 0.
    """
    scatter, weight = np.full(len(squares), np.nan), np.zeros(len(squares))
    rows = np.flatnonzero(np.isfinite(squares) & (dof > 0))
    if rows.size:
        around = min(FRAMES_AROUND, rows.size)
        variance = squares[rows] / chdtri(dof[rows], 0.5)
        scatter[rows] = np.sqrt(median_filter(variance, size=around, mode="nearest"))
        # the median of n values is about as good as the mean of n/2
        weight[rows] = dof[rows] * max(around / 2, 1)
    return scatter, weight


def suspects(residuals: FloatArray, leverage: FloatArray, scatter: FloatArray) -> NDArray[np.int64]:
    """Frames where leaving a point out may pay: a residual beyond 3 s, or one that holds most of the sum of squares."""
    n = np.isfinite(residuals).sum(axis=1)
    square = np.where(np.isfinite(residuals), residuals, 0.0) ** 2
    taken = (square / np.maximum(1 - np.nan_to_num(leverage), 1e-6)).max(axis=1, initial=0.0)
    # F ≥ 20 takes 20/(n + 16) of the sum of squares; a little less is asked for since leverages are first order
    large = (taken * (n + 16) > 0.8 * DECISIVE * square.sum(axis=1)) | (
        np.sqrt(square.max(axis=1, initial=0.0)) > 3 * scatter
    )
    return np.flatnonzero(large & (n >= FEWEST_POINTS))


def is_outlier(
    all_squares: FloatArray,
    rest_squares: FloatArray,
    *,
    n: NDArray[np.int64],
    span: FloatArray,
    noise: FloatArray,
    reference: FloatArray,
    reference_dof: FloatArray,
) -> NDArray[np.bool_]:
    """(S,) whether the fit without the best left-out point (`rest_squares`) is decisively better than that with all n.

    reference: px, s of the module's text, resting on reference_dof (may be infinite). span: px, arc of the points.
    noise: px, 0 where it is not known.
    """
    floor = (ROUNDING_IN_SPANS * span) ** 2
    gain = all_squares - rest_squares
    within = gain / np.maximum(rest_squares / (n - 4), np.maximum(noise**2, floor))
    against = gain / np.maximum(reference**2, floor)
    alone = np.where(n >= FEWEST_POINTS_WITHIN_A_FRAME, fdtrc(1, n - 4, within), 1.0)
    chance = np.minimum(alone, _upper_tail(against, reference_dof))
    return (within >= DECISIVE) & (n * chance < CHANCE)


def _upper_tail(ratio: FloatArray, dof: FloatArray) -> FloatArray:
    return np.where(np.isinf(dof), chdtrc(1, ratio), fdtrc(1, np.where(np.isinf(dof), 1, dof), ratio))
