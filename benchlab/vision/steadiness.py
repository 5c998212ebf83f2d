"""Whether the camera stood still and saw new pictures in even light: what spoils a measurement without any error."""

from __future__ import annotations

import numpy as np

from benchlab.vision.picture import FloatArray, UInt8Array

ROWS = 9  # rows of luma that are compared: whole rows, because scattered samples cost a cache miss each
FROZEN_S = 1.0
FROZEN_FRAMES = 30
LIGHT_STEP = 0.06  # relative change of mean brightness from one frame to the next
SHAKE_PX = 1.0  # acceleration, per frame², that all markers share


class Steadiness:
    """Look at each luma plane in turn, then ask for the warnings."""

    def __init__(self) -> None:
        self._last: UInt8Array | None = None
        self._last_mean = 0.0
        self._run_start = 0.0
        self._run_frames = 0
        self._frozen: list[tuple[float, float]] = []
        self._steps: list[float] = []

    def look(self, luma: UInt8Array, time_s: float) -> None:
        step = max(1, len(luma) // ROWS)
        sample = luma[step // 2 :: step].copy()
        mean = float(sample.mean())
        if self._last is not None:
            if np.array_equal(sample, self._last):
                self._run_frames += 1
                long_enough = time_s - self._run_start >= FROZEN_S or not np.isfinite(time_s)
                if self._run_frames >= FROZEN_FRAMES and long_enough:
                    if self._frozen and self._frozen[-1][0] == self._run_start:
                        self._frozen.pop()
                    self._frozen.append((self._run_start, time_s))
            else:
                self._run_start, self._run_frames = time_s, 0
                if abs(mean - self._last_mean) > LIGHT_STEP * max(self._last_mean, 1.0):
                    self._steps.append(time_s)
        self._last, self._last_mean = sample, mean

    def warnings(self) -> list[str]:
        found = [
            f"frames identical for {end - start:.1f} s from {start:.2f} s: did the camera hang?"
            for start, end in self._frozen
        ]
        if self._steps:
            found.append(f"the light or exposure jumps {len(self._steps)} times, first at {self._steps[0]:.2f} s")
        return found


def find_shakes(markers_px: FloatArray, time_s: FloatArray) -> FloatArray:
    """Times at which all markers (T, N, 2) jerk together, as they do when the camera is knocked."""
    if len(markers_px) < 3 or markers_px.shape[1] < 3:
        return np.zeros(0)
    jerk = np.diff(markers_px, n=2, axis=0)
    whole = np.asarray(np.isfinite(jerk).all(axis=(1, 2)))
    jerk = np.where(whole[:, None, None], jerk, 0.0)
    common = np.median(jerk, axis=1)
    apart = np.hypot(*np.moveaxis(jerk - common[:, None], -1, 0)).max(axis=1)
    size = np.hypot(common[:, 0], common[:, 1])
    return np.asarray(time_s[1:-1][(size > SHAKE_PX) & (apart < 0.5 * size)])
