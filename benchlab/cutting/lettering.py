"""Words as outlines of letters, which every cutter's software reads alike."""

from __future__ import annotations

import functools
import logging
import math
from typing import Any

from benchlab.cutting.outline import Point, Stroke


def width_of(text: str) -> float:
    """Of a line of text, in heights of a capital.

    >>> width_of("FILM") > 2 * width_of("M")
    True
    """
    x = [x for contour in _contours(text) for x, _ in contour]
    return max(x) - min(x)


def letters(text: str, centre_mm: Point, height_mm: float, angle_deg: float = 0.0) -> tuple[Stroke, ...]:
    """The contours of a line of text around its middle; height_mm of a capital; angle_deg counterclockwise."""
    contours = _contours(text)
    x = [x for contour in contours for x, _ in contour]
    middle, turn = (max(x) + min(x)) / 2, math.radians(angle_deg)
    cos, sin = height_mm * math.cos(turn), height_mm * math.sin(turn)
    (u, v) = centre_mm
    return tuple(
        tuple((u + (x - middle) * cos - (y - 0.5) * sin, v + (x - middle) * sin + (y - 0.5) * cos) for x, y in contour)
        for contour in contours
    )


@functools.cache
def _contours(text: str) -> tuple[Stroke, ...]:
    """Closed contours of the letters, one unit from the base line to the top of a capital."""
    capital = _text_path("H").get_extents().y1
    return tuple(
        tuple((float(x), float(y)) for x, y in contour / capital) for contour in _text_path(text).to_polygons()
    )


def _text_path(text: str) -> Any:
    """In the font that comes with matplotlib, so that a name looks the same everywhere."""
    logger = logging.getLogger("matplotlib")
    level = logger.level
    logger.setLevel(logging.ERROR)  # of fonts and folders, on first use
    try:
        import matplotlib
        from matplotlib.font_manager import FontProperties
        from matplotlib.textpath import TextPath

        font = FontProperties(fname=f"{matplotlib.get_data_path()}/fonts/ttf/DejaVuSans.ttf")
        return TextPath((0, 0), text, size=100, prop=font)
    finally:
        logger.setLevel(level)
