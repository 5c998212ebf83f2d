"""The three parts of a shell, unrolled (paper, section II-B): windowed fabric, film of the same size, closing strip.

Each part has its own origin in its middle, x along the actuator, so that equal x on two parts comes to lie on each other.
At either end, beyond al and the caps, a tab carries two alignment holes and is trimmed off after welding: no hole and no
pin mark lies in the pressurised length. The pins that register film on fabric then go through the strip as well, and so set
how far the long edges reach under it, that is, the perimeter.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from benchlab.actuator import ShellDesign
from benchlab.cutting.lettering import letters, width_of
from benchlab.cutting.outline import Circle, Outline, Point, Stroke, moved_stroke, polygon, rectangle
from benchlab.cutting.settings import HOLE_TO_EDGE, CutSettings, check_cut

LETTER_MM = 2.0
SMALLEST_LETTER_MM = 1.5
TICK_MM = 2.0


@dataclass(frozen=True)
class Part:
    """One piece of fabric or film, as the beam goes: contours already moved by half of the kerf.

    size_mm: length along the actuator and width around it, as the piece comes out. holes: round. marks: engraved. beside: what is to be
    engraved beside it, because the piece has no room for its name.
    """

    name: str
    size_mm: Point
    outer: Outline
    windows: tuple[Outline, ...] = ()
    holes: tuple[Circle, ...] = ()
    marks: tuple[Stroke, ...] = ()
    beside: str = ""

    def moved(self, dx: float, dy: float) -> Part:
        return replace(
            self,
            outer=self.outer.moved(dx, dy),
            windows=tuple(window.moved(dx, dy) for window in self.windows),
            holes=tuple(hole.moved(dx, dy) for hole in self.holes),
            marks=tuple(moved_stroke(mark, dx, dy) for mark in self.marks),
        )


def cut_parts(design: ShellDesign, settings: CutSettings) -> tuple[Part, Part, Part]:
    """Fabric, film and strip. Raises UsageError where the design cannot be cut so.

    >>> fabric, film, strip = cut_parts(ShellDesign(10, 3), CutSettings(hole_mm=0))
    >>> len(fabric.windows), fabric.size_mm, strip.size_mm
    (35, (180.0, 40.0), (180.0, 10.0))
    """
    check_cut(design, settings)
    return _sheet("fabric", design, settings), _sheet("film", design, settings), _strip(design, settings)


def window_centres_mm(design: ShellDesign) -> list[float]:
    """Along the axis, from mid length: whole windows of Eq 7, what is left over shared by the ends."""
    pitch = design.window_width_mm + design.rib_width_mm
    first = -(design.whole_windows - 1) / 2
    return [(first + i) * pitch for i in range(design.whole_windows)]


def _sheet(name: str, design: ShellDesign, settings: CutSettings) -> Part:
    """Fabric or film: equal but for the windows."""
    kerf, width = settings.kerf_mm, design.window_length_mm + 2 * settings.weld_of(design)
    length = _trimmed_mm(design, settings) + 2 * settings.tab_mm
    windows = [
        rectangle(
            (x, 0.0),
            design.window_width_mm - kerf,
            design.window_length_mm - kerf,
            settings.corner_radius_mm - kerf / 2,
        )
        for x in (window_centres_mm(design) if name == "fabric" else ())
    ]
    title = f"{name.upper()} {design.name}"
    label = _tab_label(title, length, width, settings.hole_mm)
    return Part(
        name,
        (length, width),
        rectangle((0.0, 0.0), length + kerf, width + kerf),
        tuple(windows),
        tuple(_holes(design, settings, width / 2 - HOLE_TO_EDGE * settings.hole_mm)),
        (*_ends(design, settings, width), *label),
        "" if label else title,
    )


def _strip(design: ShellDesign, settings: CutSettings) -> Part:
    """slw wide; its tabs are wider where the holes need it. They lie over the outside of the tube, not on its length."""
    kerf, width, length = settings.kerf_mm, design.strip_width_mm, _trimmed_mm(design, settings)
    edge_to_middle = width / 2 - settings.weld_of(design)
    reach = edge_to_middle + HOLE_TO_EDGE * settings.hole_mm
    tab_half = max(width / 2, reach + HOLE_TO_EDGE * settings.hole_mm)
    whole = length + 2 * settings.tab_mm
    if tab_half > width / 2:
        # From the lower left, counterclockwise: tab, body, tab, and back along the top.
        a, b, x, y = whole / 2 + kerf / 2, length / 2 - kerf / 2, tab_half + kerf / 2, width / 2 + kerf / 2
        below = ((-a, -x), (-b, -x), (-b, -y), (b, -y), (b, -x), (a, -x))
        outer = polygon(*below, *((-u, -v) for u, v in below))
    else:
        outer = rectangle((0.0, 0.0), whole + kerf, width + kerf)
    holes = tuple(_holes(design, settings, reach))
    ends = tuple(_ends(design, settings, width))
    return Part("strip", (whole, 2 * tab_half), outer, (), holes, ends, f"STRIP {design.name}")


def _trimmed_mm(design: ShellDesign, settings: CutSettings) -> float:
    """Length that stays after the tabs are trimmed off."""
    return design.length_mm + 2 * settings.cap_mm


def _holes(design: ShellDesign, settings: CutSettings, reach_mm: float) -> Iterator[Circle]:
    """Four holes, two a tab, `reach_mm` to either side of the middle line."""
    if settings.hole_mm == 0:
        return
    along = (_trimmed_mm(design, settings) + settings.tab_mm) / 2
    for x in (-along, along):
        for y in (-reach_mm, reach_mm):
            yield Circle((x, y), settings.hole_mm - settings.kerf_mm)


def _ends(design: ShellDesign, settings: CutSettings, width: float) -> Iterator[Stroke]:
    """A line where a tab is trimmed off, and ticks where al ends and the length for a cap begins."""
    for side in (-1, 1):
        if settings.hole_mm:
            x = side * _trimmed_mm(design, settings) / 2
            yield (x, -width / 2), (x, width / 2)
        if settings.cap_mm:
            x, tick = side * design.length_mm / 2, min(TICK_MM, width / 4)
            yield (x, -width / 2), (x, -width / 2 + tick)
            yield (x, width / 2), (x, width / 2 - tick)


def _tab_label(text: str, length: float, width: float, hole: float) -> tuple[Stroke, ...]:
    """The name on the left tab, between its holes; nothing where it would be too small to read."""
    height = min(LETTER_MM, HOLE_TO_EDGE * hole, (width - 4 * HOLE_TO_EDGE * hole) / width_of(text))
    if height < SMALLEST_LETTER_MM:
        return ()
    return letters(text, (-length / 2 + HOLE_TO_EDGE * hole, 0.0), height, 90.0)
