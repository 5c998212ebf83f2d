"""What was found, drawn into the picture it was found in: markers, fitted circle, angle, time, pressure and doubts.

Sizes follow the picture's height. Lines are light with a dark edge and words stand on a darkened ground, so that they can
be read on bright and on dark pictures.
"""

from __future__ import annotations

import math

import cv2
import numpy as np

from benchlab.report.caption import write_caption
from benchlab.vision.picture import FloatArray, UInt8Array
from benchlab.vision.series import CurvatureSeries

_LIGHT, _DARK = (255, 255, 255), (30, 30, 30)
_ARC, _USED, _LEFT_OUT = (0, 220, 255), (174, 200, 0), (60, 60, 255)  # BGR: yellow, green, red
_SHIFT = 4  # OpenCV draws with 1/16 px
_STRAIGHT = 100.0  # radius in marker spans beyond which an arc is drawn as the line it cannot be told from


def draw_overlay(bgr: UInt8Array, series: CurvatureSeries, frame_index: int) -> UInt8Array:
    """A copy of the picture (H, W, 3) with what the series holds for one of its frames.

    Markers in the fit are rings with a filled centre, markers left out are crosses; the circle is drawn along the
    markers' span. Raises IndexError for a frame that the series does not have.
    """
    if not 0 <= frame_index < len(series.flag):
        raise IndexError(f"frame {frame_index} of {len(series.flag)}")
    drawn = np.ascontiguousarray(bgr).copy()
    size = max(3.0, drawn.shape[0] / 90)
    markers, used = series.markers_px[frame_index], series.used[frame_index]
    if series.measured[frame_index]:
        _draw_line(drawn, arc_points(series, frame_index), size)
    for marker, in_fit in zip(markers, used):
        if np.isfinite(marker).all() and np.abs(marker).max() < 1e5:
            (_draw_ring if in_fit else _draw_cross)(drawn, marker, size)
    write_caption(drawn, caption(series, frame_index))
    return drawn


def caption(series: CurvatureSeries, frame_index: int) -> list[str]:
    """The lines of words for one frame: "θ = 93.2° ± 0.3°" with one standard deviation, "t = 1.250 s   p = 0.210 MPa" and
    the file name as far as they are known, then each word of the flag.
    """
    theta, sd = math.degrees(series.angle_rad[frame_index]), math.degrees(series.angle_sd_rad[frame_index])
    digits = 1 if not math.isfinite(sd) or sd >= 0.05 else 2
    lines = [f"θ = {theta:.{digits}f}°" if math.isfinite(theta) else "θ not measured"]
    if math.isfinite(theta) and math.isfinite(sd):
        lines[0] += f" ± {sd:.{digits}f}°"
    known = []
    if math.isfinite(series.time_s[frame_index]):
        known.append(f"t = {series.time_s[frame_index]:.3f} s")
    if series.pressure_MPa is not None and math.isfinite(series.pressure_MPa[frame_index]):
        known.append(f"p = {series.pressure_MPa[frame_index]:.3f} MPa")
    if series.names:
        known.append(series.names[frame_index])
    words = [word.strip() for word in series.flag[frame_index].split(";") if word.strip()]
    return [*lines, *(["   ".join(known)] if known else []), *words]


def arc_points(series: CurvatureSeries, frame_index: int) -> FloatArray:
    """(K, 2) points in pixels along the fitted circle, from the first to the last marker of the fit.

    Where the circle is a line, or cannot be told from one in the picture: the two ends of the line fitted to the markers.
    """
    used = series.used[frame_index] & np.isfinite(series.markers_px[frame_index]).all(axis=1)
    markers = series.markers_px[frame_index][used]
    centre, radius = series.centre_px[frame_index], series.radius_px[frame_index]
    if len(markers) < 2:
        return np.empty((0, 2))
    span = float(np.ptp(markers, axis=0).max())
    if not (np.isfinite(centre).all() and 0 < radius < _STRAIGHT * max(span, 1.0)):
        mean = markers.mean(axis=0)
        along = np.linalg.svd(markers - mean)[2][0]
        places = (markers - mean) @ along
        ends: FloatArray = mean + np.array([places[0], places[-1]])[:, None] * along
        return ends
    offsets = markers - centre
    angles = np.unwrap(np.arctan2(offsets[:, 1], offsets[:, 0]))
    steps = max(2, math.ceil(abs(angles[-1] - angles[0]) / math.radians(1)) + 1)
    along_arc = np.linspace(angles[0], angles[-1], steps)
    points: FloatArray = centre + radius * np.stack([np.cos(along_arc), np.sin(along_arc)], axis=1)
    return points


def _draw_line(picture: UInt8Array, points: FloatArray, size: float) -> None:
    if len(points) < 2 or np.abs(points).max() > 1e5:
        return
    fixed = np.round(points * (1 << _SHIFT)).astype(np.int32).reshape(-1, 1, 2)
    for colour, width in ((_DARK, 0.5), (_ARC, 0.25)):
        cv2.polylines(picture, [fixed], False, colour, max(1, round(size * width)), cv2.LINE_AA, _SHIFT)


def _draw_ring(picture: UInt8Array, marker: FloatArray, size: float) -> None:
    at = _fixed(marker)
    for colour, width in ((_DARK, 0.5), (_LIGHT, 0.25)):
        cv2.circle(picture, at, _fixed_size(1.1 * size), colour, max(1, round(size * width)), cv2.LINE_AA, _SHIFT)
    cv2.circle(picture, at, _fixed_size(0.45 * size), _DARK, -1, cv2.LINE_AA, _SHIFT)
    cv2.circle(picture, at, _fixed_size(0.3 * size), _USED, -1, cv2.LINE_AA, _SHIFT)


def _draw_cross(picture: UInt8Array, marker: FloatArray, size: float) -> None:
    for colour, width in ((_DARK, 0.6), (_LEFT_OUT, 0.3)):
        for slope in (1, -1):
            arm = np.array([size, slope * size])
            ends = _fixed(marker - arm), _fixed(marker + arm)
            cv2.line(picture, *ends, colour, max(1, round(size * width)), cv2.LINE_AA, _SHIFT)


def _fixed(point: FloatArray) -> tuple[int, int]:
    return round(float(point[0]) * (1 << _SHIFT)), round(float(point[1]) * (1 << _SHIFT))


def _fixed_size(length: float) -> int:
    return round(length * (1 << _SHIFT))
