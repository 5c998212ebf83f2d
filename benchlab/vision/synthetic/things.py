"""Outlines of what lies about on a bench: red things that are not markers, a hand, and plates that hide markers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchlab.errors import UsageError
from benchlab.vision.picture import FloatArray

RGB = tuple[float, float, float]
Outlines = list[FloatArray]


def _capsule(start: tuple[float, float], end: tuple[float, float], radius: float) -> FloatArray:
    """A line with round ends: (M, 2)."""
    a, b = np.array(start), np.array(end)
    direction = np.arctan2(*(b - a)[::-1])
    half = np.linspace(-np.pi / 2, np.pi / 2, 14) + direction
    arc = radius * np.stack([np.cos(half), np.sin(half)], axis=1)
    return np.concatenate([b + arc, a - arc])


def _cable() -> Outlines:
    """A long, thin, slack line; its width is the whole of the unit width."""
    x = np.linspace(-0.5, 0.5, 60)
    y = 2.2 * np.sin(2 * np.pi * 1.3 * x) + 1.1 * np.sin(2 * np.pi * 3.1 * x + 0.7)
    return [np.concatenate([np.stack([x, y - 0.5], axis=1), np.stack([x, y + 0.5], axis=1)[::-1]])]


def _glove() -> Outlines:
    """A mitten with its cuff."""
    t = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    radius = 0.42 + 0.05 * np.cos(2 * t) + 0.03 * np.sin(3 * t)
    palm = np.stack([radius * np.cos(t) + 0.05, 0.9 * radius * np.sin(t)], axis=1)
    return [palm, _capsule((0.05, 0.25), (0.3, 0.48), 0.1), _capsule((-0.5, 0.0), (-0.2, 0.0), 0.22)]


def _hand() -> Outlines:
    """A palm, four fingers, a thumb and the wrist."""
    fingers = [
        _capsule((0.05, y), (0.36 + dx, 1.3 * y), 0.055) for y, dx in ((-0.18, 0.02), (-0.06, 0.1), (0.06, 0.08))
    ]
    return [
        _capsule((-0.12, -0.07), (-0.12, 0.07), 0.2),
        _capsule((-0.55, 0.0), (-0.1, 0.0), 0.15),
        _capsule((-0.05, 0.18), (0.28, 0.26), 0.05),
        _capsule((-0.15, -0.22), (0.08, -0.4), 0.06),
        *fingers,
    ]


def _dots() -> Outlines:
    """Seven specks of unlike sizes."""
    t = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    circle = np.stack([np.cos(t), np.sin(t)], axis=1)
    places = ((-0.5, -0.3, 0.01), (-0.3, 0.4, 0.022), (-0.1, -0.1, 0.008), (0.1, 0.5, 0.03), (0.2, -0.5, 0.014))
    more = ((0.35, 0.1, 0.006), (0.5, -0.2, 0.018))
    return [np.array([x, y]) + r * circle for x, y, r in places + more]


def _plate() -> Outlines:
    """A rectangle."""
    return [np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])]


SHAPES: dict[str, tuple[Callable[[], Outlines], RGB]] = {
    "cable": (_cable, (176.0, 34.0, 38.0)),
    "glove": (_glove, (188.0, 42.0, 46.0)),
    "dots": (_dots, (190.0, 40.0, 40.0)),
    "hand": (_hand, (214.0, 166.0, 140.0)),
    "plate": (_plate, (96.0, 98.0, 102.0)),
}
"""Outlines of unit length and width about (0, 0), and the colour that goes with them."""


@dataclass(frozen=True)
class Thing:
    """Something beside the actuator, of one of the `SHAPES`, in picture coordinates.

    at_px: its middle in frame 0. drift_px: its movement per frame. size_px: its (length, width).
    turn_rad: its direction, clockwise on the screen. rgb: None for the colour that goes with the shape.
    """

    kind: str
    at_px: tuple[float, float]
    size_px: tuple[float, float]
    drift_px: tuple[float, float] = (0.0, 0.0)
    turn_rad: float = 0.0
    rgb: RGB | None = None

    def __post_init__(self) -> None:
        if self.kind not in SHAPES:
            raise UsageError(f"no shape is called {self.kind}", hint=f"choose one of {', '.join(SHAPES)}")


def thing_colour(thing: Thing) -> RGB:
    return SHAPES[thing.kind][1] if thing.rgb is None else thing.rgb


def thing_outlines(thing: Thing, frame: int) -> Outlines:
    """The polygons, each (M, 2), of a thing at its place in one frame."""
    cos, sin = np.cos(thing.turn_rad), np.sin(thing.turn_rad)
    turn = np.array([[cos, -sin], [sin, cos]])
    middle = np.array(thing.at_px) + frame * np.array(thing.drift_px)
    return [(outline * np.array(thing.size_px)) @ turn.T + middle for outline in SHAPES[thing.kind][0]()]
