"""How a design is cut, and which combinations of a design and a cut cannot be made."""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError

MOST_WINDOWS = 10_000
SMALLEST_MM, LARGEST_MM = 0.1, 10_000.0
"""What a laser can cut at all: the narrowest rib, window or strip, and the longest side of a part."""

HOLE_TO_EDGE = 1.5
"""From the centre of an alignment hole to any edge, in its diameters: one diameter of material stays around it."""


@dataclass(frozen=True)
class CutSettings:
    """Lengths in mm.

    weld_mm: of the windowed fabric and the film, how much lies under the strip along either long edge; None is half of the
    strip, so that the edges meet under its middle. cap_mm: length beyond al at either end for the caps. hole_mm: diameter
    of the alignment holes, 0 for none. kerf_mm: width that the beam takes away. corner_radius_mm: of the windows.
    """

    weld_mm: float | None = None
    cap_mm: float = 0.0
    hole_mm: float = 2.0
    kerf_mm: float = 0.0
    corner_radius_mm: float = 0.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None and not (math.isfinite(value) and value >= 0):
                raise UsageError(f"{name} is {value:g}", hint="give a length in mm, 0 or more")

    def weld_of(self, design: ShellDesign) -> float:
        return design.strip_width_mm / 2 if self.weld_mm is None else self.weld_mm

    @property
    def tab_mm(self) -> float:
        """Length of the tab at either end that holds the alignment holes."""
        return 2 * HOLE_TO_EDGE * self.hole_mm

    @property
    def window_radius_mm(self) -> float:
        """Of the corners as they come out: a beam leaves no corner sharper than half of its kerf."""
        return max(self.corner_radius_mm, self.kerf_mm / 2)


def check_cut(design: ShellDesign, settings: CutSettings) -> None:
    """Raises UsageError, with value, limit and remedy, for a design that cannot be cut with these settings."""
    _check_sizes(design, settings)
    if design.whole_windows > MOST_WINDOWS:
        raise UsageError(
            f"the design has {design.whole_windows} windows; up to {MOST_WINDOWS} are drawn",
            hint="lengths are in mm; make tw or fw larger",
        )
    _check_weld(design, settings)
    _check_kerf(design, settings)
    shorter = min(design.window_width_mm, design.window_length_mm)
    if settings.corner_radius_mm > shorter / 2:
        raise UsageError(
            f"corner_radius_mm is {settings.corner_radius_mm:g}; a window of {design.window_width_mm:g} x "
            f"{design.window_length_mm:g} mm takes up to {shorter / 2:g}",
            hint="make the radius smaller",
        )
    width = design.window_length_mm + 2 * settings.weld_of(design)
    if 4 * HOLE_TO_EDGE * settings.hole_mm > width:
        raise UsageError(
            f"hole_mm is {settings.hole_mm:g}; holes with a diameter of material around them fit in a sheet of "
            f"{width:g} mm up to {width / 4 / HOLE_TO_EDGE:.3g} mm",
            hint="make the holes smaller, or leave them out with 0",
        )


def _check_sizes(design: ShellDesign, settings: CutSettings) -> None:
    for name, value in _widths(design).items():
        if value < SMALLEST_MM:
            raise UsageError(
                f"the {name} is {value:g} mm; a laser cuts from {SMALLEST_MM:g} mm on",
                hint="lengths are in mm; change the design",
            )
    longest = max(design.length_mm + 2 * settings.cap_mm + 2 * settings.tab_mm, design.perimeter_mm)
    if longest > LARGEST_MM:
        raise UsageError(
            f"a part would be {longest:g} mm long; up to {LARGEST_MM:g} mm are drawn",
            hint="lengths are in mm; make al, the perimeter or --cap-mm smaller",
        )


def _widths(design: ShellDesign) -> dict[str, float]:
    return {
        "rib width fw": design.rib_width_mm,
        "window width tw": design.window_width_mm,
        "window length wl": design.window_length_mm,
        "strip width slw": design.strip_width_mm,
    }


def _check_weld(design: ShellDesign, settings: CutSettings) -> None:
    weld, most = settings.weld_of(design), design.strip_width_mm / 2
    if not 0 < weld <= most:
        raise UsageError(
            f"weld_mm is {weld:g}; it must be more than 0, and at most half of the strip, {most:g} mm, where the edges meet",
            hint="leave it out for half of the strip",
        )


def _check_kerf(design: ShellDesign, settings: CutSettings) -> None:
    limits = {**_widths(design), "hole diameter": settings.hole_mm or math.inf}
    narrowest = min(limits, key=lambda name: limits[name])
    if settings.kerf_mm >= limits[narrowest]:
        raise UsageError(
            f"kerf_mm is {settings.kerf_mm:g}, the {narrowest} is {limits[narrowest]:g} mm",
            hint="the beam must be narrower than what it cuts; a usual kerf is 0.1 to 0.3",
        )
