"""Everything that decides what `benchlab analyze` finds."""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.errors import UsageError
from benchlab.io.analysis_ranges import RANGES, SCALES


@dataclass(frozen=True)
class AnalyzeSettings:
    """Everything that decides the result. Lengths in mm, picture coordinates in pixels of the picture as displayed."""

    length_mm: float = 180.0
    markers: int | None = None
    colour: str = "red"
    threshold: float | None = None
    roi_px: tuple[float, float, float, float] | None = None  # left, top, width, height
    fit: str = "taubin"
    flip: bool = False
    scale_mm_per_px: float | None = None
    reference_mm: float | None = None
    reference_px: tuple[float, float, float, float] | None = None  # x1, y1, x2, y2
    marker_span_mm: float | None = None
    aruco_mm: float | None = None
    aruco_dictionary: str = "4x4_50"
    lens: str | None = None
    pressure: str | None = None
    ramp: str | None = None
    sync: float | None = None  # seconds; None: the onset of motion for a ramp, 0 for a file
    sync_onset: bool = False
    stream: int = 0
    fps: float | None = None
    capture_fps: float | None = None
    fast: bool = False
    allow_partial: bool = False
    max_pixels: int = 64_000_000
    max_missing: float = 1.0
    overlay: bool = False

    def check(self) -> None:
        """Raises UsageError for a value out of its range or a combination without meaning."""
        for name, (low, high) in RANGES.items():
            value = getattr(self, name)
            if value is not None and not low <= value <= high:
                option = "--" + name.replace("_", "-")
                raise UsageError(f"{option} is {value:g}", hint=f"give a number from {low:g} to {high:g}")
        given = [name for name in SCALES if getattr(self, name) is not None]
        if len(given) > 1:
            options = " and ".join("--" + n.replace("_", "-") for n in given)
            raise UsageError(f"{options} both set the scale", hint="give one of them")
        if (self.reference_mm is None) != (self.reference_px is None):
            raise UsageError(
                "--reference-mm and --reference-px belong together",
                hint="give the known length and the two points, as --reference-px X1,Y1,X2,Y2",
            )
        if self.pressure and self.ramp:
            raise UsageError("--pressure and --ramp both tell the pressure", hint="give one of them")
        if (self.sync is not None or self.sync_onset) and not (self.pressure or self.ramp):
            raise UsageError("--sync has no pressure to shift", hint="give --pressure FILE or --ramp START:END:SECONDS")
