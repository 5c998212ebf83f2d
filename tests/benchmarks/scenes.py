"""The drawn recordings that the tracker is measured on: each a scene, its bending angles and a frame rate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchlab.vision.picture import FloatArray
from benchlab.vision.synthetic import Scene, Thing

Recording = tuple[Scene, FloatArray, float]
"""Scene, bending angle in radians of each frame (T,), frames per second."""

FPS = 60.0
PLAIN = Scene(noise_sd=2.0)

CLUTTER = (
    Thing("cable", (960, 1000), (1500, 9), drift_px=(0.6, -0.5), turn_rad=0.05),
    Thing("glove", (2080, 760), (420, 320), drift_px=(-5.0, -1.0), turn_rad=3.4),
    Thing("dots", (1500, 260), (320, 320), drift_px=(-0.2, 0.1)),
    Thing("dots", (300, 800), (420, 420)),
    Thing("hand", (760, 1250), (460, 340), drift_px=(0.5, -2.2), turn_rad=-1.4),
)
OCCLUDERS = (
    Thing("plate", (300, 300), (46, 900), drift_px=(5.0, 0.0), turn_rad=0.2),
    Thing("plate", (1500, 520), (150, 30), drift_px=(-3.0, -0.5)),
)


def _rise(start_deg: float, end_deg: float, frames: int) -> FloatArray:
    """(frames,) radians: from rest to rest, once."""
    share = (1 - np.cos(np.linspace(0, np.pi, frames))) / 2
    return np.deg2rad(start_deg + (end_deg - start_deg) * share)


def _swing(amplitude_deg: float, frequency_hz: float, frames: int) -> FloatArray:
    """(frames,) radians: from 0 to twice the amplitude and back, over and over."""
    return np.deg2rad(amplitude_deg * (1 - np.cos(2 * np.pi * frequency_hz * np.arange(frames) / FPS)))


SCENES: dict[str, Recording] = {
    "clean_0_180": (PLAIN, _rise(0, 180, 300), FPS),
    "clean_fast": (replace(PLAIN, exposure_fraction=0.4), _swing(60, 0.8, 200), FPS),
    "clutter": (replace(PLAIN, clutter=CLUTTER), _rise(0, 126, 240), FPS),
    "occlusion": (replace(PLAIN, occluders=OCCLUDERS), _rise(10, 100, 240), FPS),
    "uneven_light": (replace(PLAIN, light_gradient=0.65), _rise(0, 150, 200), FPS),
    "blur": (replace(PLAIN, blur_px=3.0), _rise(0, 150, 200), FPS),
    "perspective": (replace(PLAIN, tilt_rad=0.15, tilt_axis_rad=0.6), _rise(0, 150, 200), FPS),
    "lens": (replace(PLAIN, lens_k1=-0.15, lens_k2=0.03, focal_px=1900.0), _rise(0, 150, 200), FPS),
    "straight": (replace(PLAIN, heading_rad=0.13), np.zeros(150), FPS),
    "near_straight": (replace(PLAIN, heading_rad=-0.07, base_px=(420.0, 500.0)), _rise(0, 2, 150), FPS),
    "beyond_180": (PLAIN, _rise(150, 300, 200), FPS),
    "leaves_view": (replace(PLAIN, base_px=(1250.0, 220.0)), _rise(120, 10, 200), FPS),
    "full_range_601": (replace(PLAIN, full_range=True, matrix="bt601"), _rise(0, 126, 200), FPS),
    "small_markers": (replace(PLAIN, marker_radius_px=5.0, body_width_px=26.0), _rise(0, 150, 200), FPS),
}
