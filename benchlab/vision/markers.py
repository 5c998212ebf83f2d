"""From one picture to candidate markers: spots of the marker colour, each with a sub-pixel centroid.

Spots are found where the chroma plane passes a threshold. Each is then measured in a small window of that plane, and
again in the luma plane at full resolution; the two centroids are combined by their precision, so that luma counts where
the spot stands out plainly from an even surround, and chroma where it lies on an edge or carries a highlight.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from benchlab.vision.colour import MarkerColour, colour_plane
from benchlab.vision.picture import FloatArray, Planes, UInt8Array

CANDIDATE = np.dtype(
    [
        ("xy", np.float64, 2),  # centroid, luma pixels
        ("sd_px", np.float64),  # of each coordinate, from the noise around the spot
        ("area_px2", np.float64),  # colour-weighted area, luma pixels
        ("roundness", np.float64),  # smaller over larger principal axis of the spot, 1 for a disc
        ("contrast", np.float64),  # chroma levels of the spot above its surround
        ("level", np.float64),  # chroma level of the spot itself
        ("isolation", np.float64),  # 1 for an even surround, 0 where it varies as much as the spot stands out
        ("hue_rad", np.float64),  # direction of the spot's chroma
    ]
)

MAX_SPOTS = 120  # a picture with more has the wrong threshold; the largest are kept
MIN_SPOT_SAMPLES = 4  # chroma samples: a marker is at least about 5 luma pixels wide
MAX_RADIUS = 60.0  # chroma samples; anything wider is no marker


@dataclass(frozen=True)
class Region:
    """The part of a picture to look at, in chroma samples: rows top to bottom, columns left to right."""

    left: int
    top: int
    right: int
    bottom: int


def find_candidates(
    planes: Planes, colour: MarkerColour, threshold: float, region: Region | None = None
) -> NDArray[np.void]:
    """All spots of the colour in one picture, as an array of CANDIDATE records (n,), in no particular order.

    threshold: level of the colour plane (128 is grey) above which a chroma sample belongs to a spot.
    Spots that touch the border of the picture or of the region are cut off, so their centre is unknown: left out.
    """
    score = colour_plane(planes, colour)
    centres, radii = _spots(score, threshold, region)
    if not len(radii):
        return np.zeros(0, CANDIDATE)
    step = np.array(planes.chroma_step, float)
    offset = np.array(planes.chroma_offset, float)

    found = np.zeros(len(radii), CANDIDATE)
    in_chroma = _measure(score, centres, radii)
    coarse = in_chroma.xy * step + offset
    in_luma = _measure(planes.luma, coarse, radii * np.sqrt(step[0] * step[1]))
    chroma_variance = in_chroma.variance * step[0] * step[1]
    share = chroma_variance / (chroma_variance + in_luma.variance)
    apart = np.hypot(*(in_luma.xy - coarse).T) > 0.5 * radii * step[0]
    share[apart] = 0.0
    found["xy"] = coarse + share[:, None] * (in_luma.xy - coarse)
    found["sd_px"] = np.sqrt(np.where(apart, chroma_variance, share * in_luma.variance))
    found["area_px2"] = in_chroma.area * step[0] * step[1]
    found["roundness"] = in_chroma.roundness
    found["contrast"] = in_chroma.contrast
    found["level"] = in_chroma.level
    found["isolation"] = in_chroma.isolation
    column, row = np.rint(in_chroma.xy).astype(int).T
    row, column = np.clip(row, 0, score.shape[0] - 1), np.clip(column, 0, score.shape[1] - 1)
    found["hue_rad"] = np.arctan2(planes.cr[row, column] - 128.0, planes.cb[row, column] - 128.0)
    return found


def _spots(score: UInt8Array, threshold: float, region: Region | None) -> tuple[FloatArray, FloatArray]:
    """Centres (n, 2) and equivalent radii (n,) of the connected spots above the threshold, in chroma samples."""
    left, top = (region.left, region.top) if region else (0, 0)
    view = score[top : region.bottom, left : region.right] if region else score
    _, mask = cv2.threshold(view, threshold, 255, cv2.THRESH_BINARY)
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    if len(contours) > MAX_SPOTS:
        contours = sorted(contours, key=len, reverse=True)[:MAX_SPOTS]
    height, width = view.shape
    spots = []
    for contour in contours:
        x, y, w, h = cv2.boundingRect(contour)
        inside = x > 0 and y > 0 and x + w < width and y + h < height
        if not inside or w * h < MIN_SPOT_SAMPLES or max(w, h) > 2 * MAX_RADIUS:
            continue
        # Lattice points inside and on the contour (Pick's theorem), from its area and its length in king's steps.
        around = cv2.contourArea(contour)
        steps = np.abs(np.diff(contour[:, 0], axis=0, append=contour[:1, 0])).max(axis=1).sum() if len(contour) > 1 else 0
        samples = around + steps / 2 + 1
        if samples >= MIN_SPOT_SAMPLES:
            spots.append((left + x + (w - 1) / 2, top + y + (h - 1) / 2, np.sqrt(samples / np.pi)))
    table = np.array(spots, float).reshape(-1, 3)
    return table[:, :2], table[:, 2]


@dataclass(frozen=True)
class _Measured:
    """What one plane tells about n spots, in that plane's own samples."""

    xy: FloatArray
    variance: FloatArray
    area: FloatArray
    roundness: FloatArray
    contrast: FloatArray
    level: FloatArray
    isolation: FloatArray


def _measure(plane: UInt8Array, centres: FloatArray, radii: FloatArray) -> _Measured:
    """Background-corrected centroids of n spots at `centres` (n, 2) with radii (n,), all in samples of the plane."""
    reach = int(np.ceil(1.7 * min(radii.max(), MAX_RADIUS * 2) + 3))
    height, width = plane.shape
    reach = min(reach, (min(height, width) - 1) // 2)
    size = 2 * reach + 1
    origin = np.clip(np.rint(centres).astype(int) - reach, 0, (width - size, height - size))
    window = sliding_window_view(plane, (size, size))[origin[:, 1], origin[:, 0]].astype(np.float32)
    start = (centres - origin).astype(np.float32)
    radius = radii.astype(np.float32)[:, None, None]
    axis = np.arange(size, dtype=np.float32)

    def geometry(centre: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        x = axis[None, None, :] - centre[:, 0, None, None]
        y = axis[None, :, None] - centre[:, 1, None, None]
        return x, y, x * x + y * y

    inner, outer = 1.25 * radius + 1.5, 1.6 * radius + 2.5
    x, y, squared = geometry(start)
    ring = ((squared > inner**2) & (squared < outer**2)).astype(np.float32)
    core = (squared < np.maximum(0.5 * radius, 0.75) ** 2).astype(np.float32)
    ring_count = np.maximum(ring.sum((1, 2)), 1)
    ring_window = ring * window
    background = ring_window.sum((1, 2)) / ring_count
    slope_x = (ring_window * x).sum((1, 2)) - background * (ring * x).sum((1, 2))
    slope_y = (ring_window * y).sum((1, 2)) - background * (ring * y).sum((1, 2))
    spread = np.maximum((ring * squared).sum((1, 2)) / 2, 1)
    excess = (
        window
        - background[:, None, None]
        - (slope_x / spread)[:, None, None] * x
        - (slope_y / spread)[:, None, None] * y
    )
    core_count = np.maximum(core.sum((1, 2)), 1)
    contrast = (core * excess).sum((1, 2)) / core_count
    ring_variance = (ring * excess**2).sum((1, 2)) / ring_count
    core_variance = np.maximum((core * excess**2).sum((1, 2)) / core_count - contrast**2, 0)
    sign = np.where(contrast < 0, -1.0, 1.0).astype(np.float32)
    strength = np.maximum(np.abs(contrast), 1e-3).astype(np.float32)
    share = excess * (sign / strength)[:, None, None]

    centre = start
    for _ in range(2):
        x, y, squared = geometry(centre)
        weight = share * (squared < inner**2)
        total = np.maximum(weight.sum((1, 2)), 1e-3)
        centre = centre + np.stack([(weight * x).sum((1, 2)), (weight * y).sum((1, 2))], axis=1) / total[:, None]
        centre = np.clip(centre, start - radii[:, None], start + radii[:, None]).astype(np.float32)
    x, y, squared = geometry(centre)
    support = squared < inner**2
    weight = share * support
    total = np.maximum(weight.sum((1, 2)), 1e-3)
    xx, yy, xy = ((weight * a * b).sum((1, 2)) / total for a, b in ((x, x), (y, y), (x, y)))
    mean, half = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    roundness = np.sqrt(np.clip(mean - half, 0, None) / np.maximum(mean + half, 1e-6))
    noise = (ring_variance + core_variance) / strength**2
    variance = (noise + 1e-6) * (support * squared).sum((1, 2)) / 2 / total**2
    return _Measured(
        xy=(centre + origin).astype(float),
        variance=variance.astype(float),
        area=total.astype(float),
        roundness=roundness.astype(float),
        contrast=(sign * strength).astype(float),
        level=(background + contrast).astype(float),
        isolation=(1 - np.minimum(np.sqrt(ring_variance) / strength, 1)).astype(float),
    )
