"""Closed contours of straight edges and arcs, circles, and open strokes; all in mm, y upwards."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

Point = tuple[float, float]
Stroke = tuple[Point, ...]
"""An open line through points: engraved, not cut."""


@dataclass(frozen=True)
class Outline:
    """A closed contour, counterclockwise.

    points_mm: its n corners. bulges: n numbers, that of the edge from a corner to the next: 0 for a straight edge,
    tan(φ/4) for an arc that turns left by φ (the convention of DXF). Arcs are quarter turns between edges parallel to the
    axes, so that the box around the corners is the box around the contour.
    """

    points_mm: tuple[Point, ...]
    bulges: tuple[float, ...]

    def edges(self) -> list[tuple[Point, Point, float]]:
        """(from, to, bulge) of every edge."""
        return list(zip(self.points_mm, (*self.points_mm[1:], self.points_mm[0]), self.bulges, strict=True))

    @staticmethod
    def radius_mm(start: Point, end: Point, bulge: float) -> float:
        """Of an edge that is an arc: chord / 2 sin(φ/2)."""
        return math.dist(start, end) / 2 / math.sin(2 * math.atan(bulge))

    @property
    def area_mm2(self) -> float:
        """Shoelace sum, and a circular segment r²(φ − sin φ)/2 for each arc."""
        area = 0.0
        for (x0, y0), (x1, y1), bulge in self.edges():
            area += (x0 * y1 - x1 * y0) / 2
            if bulge:
                turn = 4 * math.atan(bulge)
                radius = self.radius_mm((x0, y0), (x1, y1), bulge)
                area += radius**2 * (turn - math.sin(turn)) / 2
        return area

    @property
    def length_mm(self) -> float:
        """Way of the beam along the contour."""
        length = 0.0
        for start, end, bulge in self.edges():
            turn = 4 * math.atan(bulge)
            length += math.dist(start, end) * (turn / 2 / math.sin(turn / 2) if bulge else 1)
        return length

    @property
    def box_mm(self) -> tuple[float, float, float, float]:
        """Left, bottom, right, top."""
        x, y = zip(*self.points_mm, strict=True)
        return min(x), min(y), max(x), max(y)

    def moved(self, dx: float, dy: float) -> Outline:
        return replace(self, points_mm=tuple((x + dx, y + dy) for x, y in self.points_mm))


@dataclass(frozen=True)
class Circle:
    """A round hole."""

    centre_mm: Point
    diameter_mm: float

    @property
    def length_mm(self) -> float:
        return math.pi * self.diameter_mm

    def moved(self, dx: float, dy: float) -> Circle:
        return replace(self, centre_mm=(self.centre_mm[0] + dx, self.centre_mm[1] + dy))


def polygon(*points_mm: Point) -> Outline:
    """Straight edges through corners in counterclockwise order."""
    return Outline(points_mm, (0.0,) * len(points_mm))


def rectangle(centre_mm: Point, width_mm: float, height_mm: float, radius_mm: float = 0.0) -> Outline:
    """A rectangle with rounded corners; with radius 0, four corners.

    >>> round(rectangle((0, 0), 3, 30, 0.5).area_mm2, 3), round(rectangle((0, 0), 3, 30, 0.5).length_mm, 3)
    (89.785, 65.142)
    """
    (x, y), a, b, r = centre_mm, width_mm / 2, height_mm / 2, radius_mm
    if r <= 0:
        return polygon((x - a, y - b), (x + a, y - b), (x + a, y + b), (x - a, y + b))
    quarter = math.tan(math.pi / 8)
    corners = (
        ((x - a + r, y - b), 0.0),
        ((x + a - r, y - b), quarter),
        ((x + a, y - b + r), 0.0),
        ((x + a, y + b - r), quarter),
        ((x + a - r, y + b), 0.0),
        ((x - a + r, y + b), quarter),
        ((x - a, y + b - r), 0.0),
        ((x - a, y - b + r), quarter),
    )
    return Outline(tuple(point for point, _ in corners), tuple(bulge for _, bulge in corners))


def moved_stroke(stroke: Stroke, dx: float, dy: float) -> Stroke:
    return tuple((x + dx, y + dy) for x, y in stroke)
