"""In which ranges the settings of `benchlab analyze` have a meaning, under the names of its options and of a study's `analysis:`."""

from __future__ import annotations

RANGES: dict[str, tuple[float, float]] = {
    "length_mm": (1e-3, 1e6),
    "reference_mm": (1e-3, 1e6),
    "marker_span_mm": (1e-3, 1e6),
    "aruco_mm": (1e-3, 1e6),
    "scale_mm_per_px": (1e-6, 1e3),
    "fps": (1e-3, 1e6),
    "capture_fps": (1e-3, 1e6),
    "threshold": (129, 254),
    "markers": (3, 60),
    "max_missing": (0, 1),
    "max_pixels": (1, 10**10),
}
SCALES = ("scale_mm_per_px", "reference_mm", "marker_span_mm", "aruco_mm")
"""Settings of which one at most tells the scale."""
