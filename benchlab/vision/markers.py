"""From one picture to candidate markers: spots of the marker colour, each with a sub-pixel centroid.

Spots are found where the chroma plane passes a threshold. Each is then measured in a small window of that plane, and
again in the luma plane at full resolution; the two centroids are combined by their precision, so that luma counts where
the spot stands out plainly from an even surround, and chroma where it lies on an edge or carries a highlight.
"""

from __future__ import annotations

import functools
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
# Radii, as (factor of the spot's, samples more): the spot with its blurred edge lies inside INNER, its surround between.
INNER, OUTER = (1.25, 1.5), (1.6, 2.5)
CORE = 0.5
LEAST_CONTRAST = 10.0  # chroma levels above the surround: less is not told from noise, texture and compression
HUE_REACH = 0.7  # rad between a spot's hue and the colour looked for: skin and wood are out, a warm lamp is not


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
    in_chroma = _measure(score, centres, radii, passes=2)
    coarse = in_chroma.xy * step + offset
    in_luma = _measure(planes.luma, coarse, radii * np.sqrt(step[0] * step[1]), passes=1)
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
    hue_off = np.abs(np.angle(np.exp(1j * (found["hue_rad"] - colour.hue_rad))))
    return found[(found["contrast"] >= LEAST_CONTRAST) & (hue_off <= HUE_REACH)]


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
        # Lattice points inside and on the contour (Pick's theorem), whose steps are 1 or √2 long.
        samples = cv2.contourArea(contour) + cv2.arcLength(contour, True) / 2.4 + 1
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


@functools.cache
def _monomials(reach: int) -> tuple[FloatArray, FloatArray]:
    """1, x, y, x², xy, y² over a window of (2·reach + 1)² samples about its middle: (samples, 6), and (4, samples)."""
    axis = np.arange(-reach, reach + 1, dtype=np.float32)
    y, x = (a.ravel() for a in np.meshgrid(axis, axis, indexing="ij"))
    basis = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=1)
    return basis, np.ascontiguousarray(np.stack([x * x + y * y, x, y, np.ones_like(x)]))


def _measure(plane: UInt8Array, centres: FloatArray, radii: FloatArray, passes: int) -> _Measured:
    """Background-corrected centroids of n spots at `centres` (n, 2) with radii (n,), all in samples of the plane.

    All sums over windows are products with the monomials of `_monomials`, so that moments about any centre follow.
    """
    reach = int(np.ceil(OUTER[0] * min(radii.max(), 2 * MAX_RADIUS) + OUTER[1])) + 1
    height, width = plane.shape
    reach = min(reach, (min(height, width) - 1) // 2)
    size = 2 * reach + 1
    origin = np.clip(np.rint(centres).astype(int) - reach, 0, (width - size, height - size))
    basis, circle = _monomials(reach)
    window = sliding_window_view(plane, (size, size))[origin[:, 1], origin[:, 0]].reshape(len(radii), -1)
    window = window.astype(np.float32)
    start = centres - origin - reach

    squared = _squared(circle, start)
    radius = radii[:, None].astype(np.float32)
    inner, outer = (INNER[0] * radius + INNER[1]) ** 2, (OUTER[0] * radius + OUTER[1]) ** 2
    ring = (squared > inner).astype(np.float32)
    ring *= squared < outer
    # A plane through the surround, by least squares over the ring, taken off the window.
    sums, values = ring @ basis, (ring * window) @ basis[:, :3]
    normal = sums[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3).astype(float) + 1e-6 * np.eye(3)
    surround = np.linalg.solve(normal, values[:, :, None].astype(float))[:, :, 0]
    window -= surround.astype(np.float32) @ basis[:, :3].T
    ring_variance = np.einsum("ij,ij,ij->i", ring, window, window) / np.maximum(sums[:, 0], 1)
    core = (squared < np.maximum(CORE * radius, 0.75) ** 2).astype(np.float32)
    core_count = np.maximum(core.sum(axis=1), 1)
    core *= window
    contrast = core.sum(axis=1) / core_count
    core_variance = np.maximum(np.einsum("ij,ij->i", core, window) / core_count - contrast**2, 0)
    strength = np.where(np.abs(contrast) < 1e-3, 1e-3, contrast)
    window /= strength[:, None]

    centre = start
    for again in range(passes):
        if again:
            squared = _squared(circle, centre)
        support = (squared < inner).astype(np.float32)
        moments = ((support * window) @ basis).astype(float)
        total = np.maximum(moments[:, 0], 1e-3)
        centre = np.clip(moments[:, 1:3] / total[:, None], start - radii[:, None], start + radii[:, None])
    second = moments[:, 3:] / total[:, None] - centre[:, [0, 0, 1]] * centre[:, [0, 1, 1]]
    mean, half = (second[:, 0] + second[:, 2]) / 2, np.hypot((second[:, 0] - second[:, 2]) / 2, second[:, 1])
    spread = np.einsum("ij,ij->i", support, squared)
    noise = (ring_variance + core_variance) / strength**2
    return _Measured(
        xy=centre + origin + reach,
        variance=(noise + 1e-6) * spread / 2 / total**2,
        area=total,
        roundness=np.sqrt(np.clip(mean - half, 0, None) / np.maximum(mean + half, 1e-6)),
        contrast=contrast.astype(float),
        level=contrast + surround[:, 0] + (surround[:, 1:] * start).sum(axis=1),
        isolation=1 - np.minimum(np.sqrt(ring_variance) / np.abs(strength), 1),
    )


def _squared(circle: FloatArray, centre: FloatArray) -> FloatArray:
    """(n, samples) squared distances from the centres (n, 2), relative to the middle of the window."""
    x, y = centre[:, 0], centre[:, 1]
    return np.asarray(np.stack([np.ones_like(x), -2 * x, -2 * y, x * x + y * y], axis=1).astype(np.float32) @ circle)
