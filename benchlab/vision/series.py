"""What the seeing half of the bench hands on: the curvature of one recording against time, frame by frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.vision.picture import FloatArray

SURE_FLAGS = ("", "markers left out")
"""Flags of frames whose values are not in doubt."""


@dataclass(frozen=True)
class CurvatureSeries:
    """T frames, N markers. Every array has T rows; NaN where nothing was measured, and `flag` says why.

    time_s: (T,) from the presentation stamps, first frame at 0; NaN for stills without a frame rate.
    markers_px: (T, N, 2) displayed-picture coordinates in order along the body, fixed end first; NaN where left out.
    used: (T, N) bool, the markers that entered the fit.
    angle_rad, angle_sd_rad: (T,) bending angle θ = κ·al (paper Eq 3) and its standard deviation.
    curvature_per_mm, curvature_sd_per_mm: (T,) signed; 0 on a straight line.
    radius_mm: (T,) 1/|κ|, NaN where the curvature cannot be told from 0.
    centre_px (T, 2), radius_px (T,): the fitted circle; NaN on a straight line.
    curvature_per_px: (T,) signed.
    fit_rms_px: (T,) root mean square distance of the used markers from the circle.
    centroid_sd_px: (T,) the noise of one marker coordinate, as estimated from the data.
    flag: T strings: "" for a plain measurement, else words joined by ";". Rows with NaN angle carry the reason.
    names: T file names for a folder of stills, else empty.
    pressure_MPa: (T,) at the time of each frame, NaN outside the record; None where no pressure was given.
    """

    time_s: FloatArray
    markers_px: FloatArray
    used: NDArray[np.bool_]
    angle_rad: FloatArray
    angle_sd_rad: FloatArray
    curvature_per_mm: FloatArray
    curvature_sd_per_mm: FloatArray
    radius_mm: FloatArray
    centre_px: FloatArray
    radius_px: FloatArray
    curvature_per_px: FloatArray
    fit_rms_px: FloatArray
    centroid_sd_px: FloatArray
    flag: tuple[str, ...]
    names: tuple[str, ...] = ()
    pressure_MPa: FloatArray | None = None

    @property
    def n_markers(self) -> NDArray[np.int64]:
        """(T,) how many markers entered the fit of each frame."""
        return self.used.sum(axis=1)

    @property
    def measured(self) -> NDArray[np.bool_]:
        """(T,) whether the frame has an angle."""
        return np.isfinite(self.angle_rad)

    @property
    def sure(self) -> NDArray[np.bool_]:
        """(T,) whether the frame has an angle without doubt."""
        return self.measured & np.array([flag in SURE_FLAGS for flag in self.flag], dtype=bool)
