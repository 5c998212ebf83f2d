"""What one pixel is in millimetres: from a given number, a known distance, an ArUco marker or the markers' span."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from benchlab.errors import InputError, UsageError
from benchlab.vision.aruco import find_aruco
from benchlab.vision.picture import FloatArray, UInt8Array

SMALLEST_MM_PER_PX = 1e-6
LARGEST_MM_PER_PX = 1000.0
SHORTEST_REFERENCE_PX = 10.0
LARGEST_SIDE_SPREAD = 0.15
CORNER_SD_PX = 0.1


@dataclass(frozen=True)
class Scale:
    """mm_per_px and its standard deviation; `source` says where it is from, `assumed` that nobody measured it.

    span_variation: how far the marked length ranged over the recording (95th less 5th percentile, over the median);
    0 for scales that are not from the span. Above 0.03 the body stretches or leaves the plane of the picture.
    """

    mm_per_px: float
    sd_mm_per_px: float
    source: str
    assumed: bool
    span_variation: float = 0.0


def scale_given(mm_per_px: float) -> Scale:
    """A scale known beforehand, taken as exact. Raises UsageError outside 1e-6 … 1000 mm/px.

    >>> scale_given(0.2).mm_per_px
    0.2
    """
    return Scale(_in_range(mm_per_px), 0.0, f"{mm_per_px:g} mm/px was given", assumed=False)


def scale_from_reference(a_px: FloatArray, b_px: FloatArray, length_mm: float, pick_sd_px: float = 0.5) -> Scale:
    """Two points (2,) px that are length_mm apart, each picked with a standard deviation of pick_sd_px a coordinate.

    Raises UsageError for points less than 10 px apart, a length that is not positive, or a scale out of range.

    >>> scale_from_reference(np.array([100, 200]), np.array([500, 500]), 100.0).mm_per_px
    0.2
    """
    length_mm = _positive(length_mm, "reference length")
    a, b = np.asarray(a_px, dtype=float), np.asarray(b_px, dtype=float)
    distance = float(np.hypot(*(b - a)))
    if not distance >= SHORTEST_REFERENCE_PX:
        raise UsageError(
            f"the two reference points are {distance:.3g} px apart, fewer than {SHORTEST_REFERENCE_PX:g}",
            hint="pick two points that are far apart in the picture",
        )
    mm_per_px = _in_range(length_mm / distance)
    source = f"two picked points {distance:.1f} px apart are {length_mm:g} mm"
    return Scale(mm_per_px, mm_per_px * math.sqrt(2) * pick_sd_px / distance, source, assumed=False)


def scale_from_span(span_px: FloatArray, span_mm: float, assumed: bool = True) -> Scale:
    """The median of the marked arc lengths (T,) px is span_mm; NaN frames are left out.

    The standard deviation is that of a median, with as many independent frames as the scatter's correlation from
    frame to frame leaves; it is 0 for a single frame, which has no scatter. With no finite span the scale is NaN.
    Raises UsageError for a span_mm that is not positive, or a scale out of range.

    >>> scale_from_span(np.array([900.0, 901.0, 899.0, np.nan]), 180.0).mm_per_px
    0.2
    """
    span_mm = _positive(span_mm, "span of the markers")
    spans = np.asarray(span_px, dtype=float)
    spans = spans[np.isfinite(spans)]
    source = f"markers assumed to span {span_mm:g} mm (--length-mm)" if assumed else f"markers span {span_mm:g} mm"
    if not spans.size:
        return Scale(math.nan, math.nan, f"{source}, but no frame shows both ends", assumed)
    median = float(np.median(spans))
    mm_per_px = _in_range(span_mm / median if median > 0 else math.inf)
    scatter = 1.4826 * float(np.median(np.abs(spans - median))) / median
    low, high = np.quantile(spans, [0.05, 0.95])
    relative_sd = math.sqrt(math.pi / 2) * scatter / math.sqrt(_independent(spans))
    return Scale(mm_per_px, mm_per_px * relative_sd, source, assumed, float((high - low) / median))


def scale_from_aruco(picture: UInt8Array, side_mm: float, dictionary: str = "4x4_50") -> Scale:
    """Scale from ArUco markers with sides of side_mm in a grey picture (H, W) uint8; see `find_aruco` for its errors.

    Raises InputError too when the sides differ by more than 15 % (seen at an angle, or markers of different sizes).
    """
    side_mm = _positive(side_mm, "side of the ArUco marker")
    identities, corners = find_aruco(picture, dictionary)
    return scale_from_corners(corners, side_mm, f"ArUco marker {', '.join(str(i) for i in identities)} of {dictionary}")


def scale_from_corners(corners_px: FloatArray, side_mm: float, name: str = "square") -> Scale:
    """Scale from the corners (M, 4, 2) px of squares with sides of side_mm, in order round each.

    The standard deviation is the scatter of the sides, which a tilted square makes large, and at least a corner's.
    """
    side_mm = _positive(side_mm, "side of the square")
    sides = np.linalg.norm(corners_px - np.roll(corners_px, -1, axis=1), axis=2).ravel()
    mean = float(sides.mean())
    if sides.max() - sides.min() > LARGEST_SIDE_SPREAD * mean:
        raise InputError(
            f"the sides of {name} are {sides.min():.1f} to {sides.max():.1f} px, which differ by more than 15 %",
            hint="turn it to the camera, in the plane of the actuator; all markers in view must have one size",
        )
    mm_per_px = _in_range(side_mm / mean)
    sd_px = max(float(sides.std()), CORNER_SD_PX * math.sqrt(2 / sides.size))
    return Scale(mm_per_px, mm_per_px * sd_px / mean, f"{name}, sides {side_mm:g} mm and {mean:.1f} px", assumed=False)


def _independent(values: FloatArray) -> float:
    """How many independent values a series is worth for its mean, from its correlation with itself one step later."""
    away = values - values.mean()
    total = float((away**2).sum())
    if len(values) < 3 or total == 0:
        return 1.0
    correlation = min(max(float((away[1:] * away[:-1]).sum()) / total, 0.0), 1.0)
    return max(len(values) * (1 - correlation) / (1 + correlation), 1.0)


def _positive(length_mm: float, what: str) -> float:
    if not (math.isfinite(length_mm) and length_mm > 0):
        raise UsageError(f"the {what} is {length_mm:g} mm, not a positive number", hint="give it in millimetres")
    return float(length_mm)


def _in_range(mm_per_px: float) -> float:
    if not SMALLEST_MM_PER_PX <= mm_per_px <= LARGEST_MM_PER_PX:
        raise UsageError(
            f"the scale is {mm_per_px:g} mm/px, outside {SMALLEST_MM_PER_PX:g} to {LARGEST_MM_PER_PX:g}",
            hint="check the lengths and points that it is made from",
        )
    return float(mm_per_px)
