"""Round spots measured in small windows: centroid, area, shape and contrast against the surround, many at once.

A window is compared with a template for spots of its size: a core, a support that holds the whole spot, a ring around it.
A quadratic fitted to the ring is the surround (a lit, rounded body is one); what rises above it inside the support is
the spot. All of it is linear in the samples but for two sums of squares, so that a batch of windows takes two products.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from benchlab.vision.picture import FloatArray, UInt8Array

CLASS_RATIO = 1.1  # from one radius class to the next
# Radii, as (factor of the spot's, samples more): a blurred spot lies in SUPPORT, its surround in RING beyond that.
SUPPORT, RING = (1.25, 1.5), (1.6, 2.5)
CORE = 0.5
SLACK = 2  # samples that a window is larger than its template on every side, so that it can be centred afterwards
GREY = 128.0  # taken off all samples, so that single precision is enough


@dataclass(frozen=True)
class Measured:
    """What one plane tells about n spots, in that plane's own samples; xy from the middle of the windows."""

    xy: FloatArray
    variance: FloatArray
    area: FloatArray
    roundness: FloatArray
    contrast: FloatArray
    level: FloatArray
    isolation: FloatArray


def radius_class(radius: float) -> int:
    """The class of spots that are measured alike; a radius differs from its class's by 5 % at most."""
    return round(math.log(max(radius, 0.5)) / math.log(CLASS_RATIO))


def reach_of(size: int) -> int:
    """Samples from the middle to the edge of the template of a radius class."""
    return math.ceil(RING[0] * CLASS_RATIO**size + RING[1])


def centred(windows: UInt8Array, xy: FloatArray) -> tuple[UInt8Array, FloatArray]:
    """Parts of windows (n, 2·(reach + SLACK) + 1, …) that fit the template, centred as well as may be on xy (n, 2).

    Returns the parts and the shifts (n, 2) of their middles; xy and shifts from the middle of the windows.
    """
    shift = np.clip(np.rint(xy).astype(int), -SLACK, SLACK)
    size = windows.shape[1] - 2 * SLACK
    parts = sliding_window_view(windows, (size, size), axis=(1, 2))
    return parts[np.arange(len(windows)), SLACK + shift[:, 1], SLACK + shift[:, 0]], shift.astype(float)


@dataclass(frozen=True)
class _Template:
    """Everything about a radius class that does not depend on the samples.

    sums: (samples, 13) float32: times a window, the sums of 1, x, y, x², xy, y² over ring and support, and of 1 over the core.
    squares: (samples, 2) float32: times a squared window, the ring's and the core's sum.
    fit: (6, 6) from the ring's sums to the surround's coefficients. under: (6, 6) a surround's share in the support's sums.
    spread: sum of squared distances over the support.
    """

    sums: FloatArray
    squares: FloatArray
    fit: FloatArray
    under: FloatArray
    spread: float
    ring_count: float
    core_count: float


@functools.cache
def _template(size: int) -> _Template:
    radius, reach = CLASS_RATIO**size, reach_of(size)
    axis = np.arange(-reach, reach + 1, dtype=float)
    y, x = (a.ravel() for a in np.meshgrid(axis, axis, indexing="ij"))
    away = np.hypot(x, y)
    powers = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=1)
    inner = SUPPORT[0] * radius + SUPPORT[1]
    support, ring = away <= inner, (away > inner) & (away <= RING[0] * radius + RING[1])
    core = away <= max(CORE * radius, 0.75)
    return _Template(
        sums=np.column_stack([ring[:, None] * powers, support[:, None] * powers, core]).astype(np.float32),
        squares=np.column_stack([ring, core]).astype(np.float32),
        fit=np.linalg.inv(powers[ring].T @ powers[ring]),
        under=powers[support].T @ powers[support],
        spread=float((away[support] ** 2).sum()),
        ring_count=float(ring.sum()),
        core_count=float(core.sum()),
    )


def measure_windows(windows: UInt8Array, size: int) -> Measured:
    """Background-corrected centroids of n spots of one radius class, each within half a sample of its window's middle.

    windows: (n, 2·reach + 1, 2·reach + 1).
    """
    template = _template(size)
    samples = windows.reshape(len(windows), -1).astype(np.float32) - np.float32(GREY)
    sums = (samples @ template.sums).astype(float)
    squares = (np.square(samples, out=samples) @ template.squares).astype(float)

    surround = sums[:, :6] @ template.fit
    ring_variance = np.maximum(squares[:, 0] - (surround * sums[:, :6]).sum(axis=1), 0) / template.ring_count
    core_mean = sums[:, 12] / template.core_count
    core_variance = np.maximum(squares[:, 1] / template.core_count - core_mean**2, 0)
    contrast = core_mean - surround[:, 0]
    strength = np.where(np.abs(contrast) < 1e-3, 1e-3, contrast)
    moments = (sums[:, 6:12] - surround @ template.under) / strength[:, None]
    area = np.maximum(moments[:, 0], 1e-3)
    xy = np.clip(moments[:, 1:3] / area[:, None], -reach_of(size), reach_of(size))
    second = moments[:, 3:] / area[:, None] - xy[:, [0, 0, 1]] * xy[:, [0, 1, 1]]
    mean, half = (second[:, 0] + second[:, 2]) / 2, np.hypot((second[:, 0] - second[:, 2]) / 2, second[:, 1])
    noise = (ring_variance + core_variance) / strength**2
    return Measured(
        xy=xy,
        variance=(noise + 1e-6) * template.spread / 2 / area**2,
        area=area,
        roundness=np.sqrt(np.clip(mean - half, 0, None) / np.maximum(mean + half, 1e-6)),
        contrast=contrast,
        level=core_mean + GREY,
        isolation=1 - np.minimum(np.sqrt(ring_variance) / np.abs(strength), 1),
    )
