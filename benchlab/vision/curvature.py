"""From tracks to curvature and bending angle against time, with their uncertainty (paper Eqs 2 and 3).

The noise of a marker is estimated from its scatter about the fitted circle, pooled over neighbouring frames, and carried
through the fit to first order. Where a fit leaves no scatter to look at (three markers), the jitter of the tracks in
time stands in for it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from benchlab.vision.circle import CircleFits, fit_circles_robustly
from benchlab.vision.linking import Tracks
from benchlab.vision.picture import FloatArray
from benchlab.vision.scale import Scale, scale_from_span
from benchlab.vision.series import CurvatureSeries

POOLED_FRAMES = 31  # a frame and its neighbours, whose scatter is taken together
NOT_CIRCULAR = 0.005  # scatter about the circle, as a share of the arc, from which a body is no circular arc
NOT_NOISE = 4.0  # and by how much that scatter must exceed the jitter of the markers in time
DOUBTFUL_SD_RAD = np.radians(1.5)
UNBELIEVABLE_SPAN = 0.15  # variation of the marked length at which the markers cannot be the same all along
STRAIGHT = 1e-9  # rad: a smaller bend has no radius, noise or not


@dataclass(frozen=True)
class Body:
    """What is known of the filmed body: its length al, the length between its end markers, the scale.

    Without a scale the markers give it: they span `span_mm`, or, where that is unknown too, are assumed to span al.
    """

    length_mm: float
    span_mm: float | None = None
    scale: Scale | None = None


def measure_curvature(
    tracks: Tracks,
    time_s: FloatArray,
    body: Body,
    method: str = "taubin",
    flip: bool = False,
    stills: bool = False,
    names: tuple[str, ...] = (),
) -> tuple[CurvatureSeries, Scale]:
    """The curvature series of linked tracks, and the scale that was used.

    The angle is positive in the direction in which the recording bends most; `flip` turns that round.
    Frames with fewer than three markers are NaN, with the reason in `flag`.
    """
    jitter = track_jitter(tracks)
    fits, used = fit_circles_robustly(tracks.xy, method=method)
    scale = body.scale or scale_from_span(
        _full_spans(fits, used), body.span_mm or body.length_mm, assumed=body.span_mm is None
    )
    # Without scatter and without neighbours in time, what the pictures say about each centroid has to do.
    alone = jitter if np.isfinite(jitter) else float(np.nanmedian(tracks.sd_px))
    noise, student = _pooled_noise(fits, alone, stills)
    curvature = fits.curvature * _sign(fits.curvature, flip)
    curvature_sd = fits.curvature_sd_per_noise * noise * student
    per_mm = 1 / scale.mm_per_px
    scale_sd = scale.sd_mm_per_px / scale.mm_per_px
    kappa = curvature * per_mm
    kappa_sd = np.hypot(curvature_sd * per_mm, kappa * scale_sd)
    bent = np.abs(kappa) > np.maximum(2 * kappa_sd, STRAIGHT / body.length_mm)
    radius = np.divide(1.0, np.abs(kappa), out=np.full(len(kappa), np.nan), where=bent)
    series = CurvatureSeries(
        time_s=time_s,
        markers_px=tracks.xy,
        used=used,
        angle_rad=kappa * body.length_mm,
        angle_sd_rad=kappa_sd * body.length_mm,
        curvature_per_mm=kappa,
        curvature_sd_per_mm=kappa_sd,
        radius_mm=radius,
        centre_px=fits.centre,
        radius_px=fits.radius,
        curvature_per_px=curvature,
        fit_rms_px=fits.rms,
        centroid_sd_px=np.where(np.isfinite(curvature), noise, np.nan),
        flag=_flags(tracks, fits, used, jitter, kappa_sd * body.length_mm, scale.span_variation > UNBELIEVABLE_SPAN),
        names=names,
    )
    return series, scale


def track_jitter(tracks: Tracks) -> float:
    """Standard deviation (px) of a marker coordinate about smooth motion, from third differences in time; else NaN.

    The third difference of white noise has 20 times its variance; smooth motion leaves almost nothing in it.
    """
    if tracks.xy.shape[1] == 0 or len(tracks.xy) < 8:
        return float("nan")
    third = np.diff(tracks.xy, n=3, axis=0)
    third = third[np.isfinite(third)]
    return float(1.4826 * np.median(np.abs(third)) / np.sqrt(20)) if len(third) >= 8 else float("nan")


def _full_spans(fits: CircleFits, used: np.ndarray) -> FloatArray:
    """(T,) arc lengths of the frames in which both end markers were used, NaN elsewhere."""
    if used.shape[1] == 0:
        return np.full(len(used), np.nan)
    return np.where(used[:, 0] & used[:, -1], fits.arc_span, np.nan)


def _pooled_noise(fits: CircleFits, noise_alone: float, stills: bool) -> tuple[FloatArray, FloatArray]:
    """(T,) noise of a marker coordinate in px, and Student's factor that keeps ±2 sd at 95 % for few degrees of freedom.

    noise_alone: px, for frames that have no degree of freedom within reach.
    """
    freedom = np.where(np.isfinite(fits.rms), np.maximum(fits.dof, 0), 0).astype(float)
    count = freedom + 3
    squares = np.where(freedom > 0, np.nan_to_num(fits.rms) ** 2 * count, 0.0)
    window = np.ones(1 if stills else min(POOLED_FRAMES, 2 * len(freedom) - 1))
    centred = slice(len(window) // 2, len(window) // 2 + len(freedom))
    pooled = np.convolve(squares, window)[centred]
    total = np.convolve(freedom, window)[centred]
    alone = total < 0.5
    scatter = np.sqrt(pooled / np.where(alone, 1, total))
    noise = np.where(alone, noise_alone, scatter)
    student = np.where(alone, 1.0, stdtrit(np.maximum(total, 1), 0.97725) / 2)
    return noise, student


def _sign(curvature: FloatArray, flip: bool) -> float:
    seen = curvature[np.isfinite(curvature)]
    if not len(seen):
        return 1.0
    most = np.quantile(seen, [0.02, 0.98])
    sign = 1.0 if most[1] >= -most[0] else -1.0
    return -sign if flip else sign


def _flags(
    tracks: Tracks, fits: CircleFits, used: np.ndarray, jitter: float, angle_sd: FloatArray, length_varies: bool
) -> tuple[str, ...]:
    """One string a frame: the reason of a missing value, or what is doubtful about a measured one."""
    n = used.sum(axis=1)
    freedom = np.maximum(fits.dof, 1)
    scatter = np.nan_to_num(fits.rms) * np.sqrt(np.maximum(n, 1) / freedom)
    limit = np.maximum(NOT_CIRCULAR * np.nan_to_num(fits.arc_span), NOT_NOISE * np.nan_to_num(jitter))
    bent_otherwise = (fits.dof > 0) & (scatter > limit)
    present = np.isfinite(tracks.xy[..., 0])
    outlier = (present & ~used).any(axis=1)
    flags = []
    for t, reason in enumerate(tracks.reason):
        if not np.isfinite(fits.curvature[t]):
            flags.append(reason if reason and reason != "markers left out" else "fewer than 3 markers")
            continue
        words = [reason] if reason else []
        if outlier[t]:
            words.append("outlier left out")
        if n[t] == 3:
            words.append("only 3 markers")
        if length_varies:
            words.append("marked length varies")
        if bent_otherwise[t]:
            words.append("not constant curvature")
        if angle_sd[t] > DOUBTFUL_SD_RAD:
            words.append("large uncertainty")
        flags.append(";".join(words))
    return tuple(flags)
