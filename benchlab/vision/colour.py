"""Which colour the markers have, as a direction in the chroma plane, and how much of it each chroma sample shows."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np

from benchlab.errors import UsageError
from benchlab.vision.picture import Planes, UInt8Array

# Kr, Kb of ITU-R BT.601, BT.709 and BT.2020: luma is Kr·R + (1 − Kr − Kb)·G + Kb·B.
LUMA_WEIGHTS = {"bt601": (0.299, 0.114), "bt709": (0.2126, 0.0722), "bt2020": (0.2627, 0.0593)}

COLOURS = {
    "red": (1.0, 0.0, 0.0),
    "orange": (1.0, 0.5, 0.0),
    "yellow": (1.0, 1.0, 0.0),
    "green": (0.0, 1.0, 0.0),
    "cyan": (0.0, 1.0, 1.0),
    "blue": (0.0, 0.0, 1.0),
    "magenta": (1.0, 0.0, 1.0),
}


@dataclass(frozen=True)
class MarkerColour:
    """A hue to look for: `cb`, `cr` make a unit vector in the chroma plane, `hue_rad` its direction."""

    name: str
    cb: float
    cr: float

    @property
    def hue_rad(self) -> float:
        return math.atan2(self.cr, self.cb)


def chroma(rgb: tuple[float, float, float], matrix: str) -> tuple[float, float]:
    """Cb and Cr, each from −0.5 to 0.5, of red, green, blue from 0 to 1.

    >>> [round(c, 3) for c in chroma((1, 0, 0), "bt601")]
    [-0.169, 0.5]
    """
    kr, kb = LUMA_WEIGHTS[matrix]
    red, green, blue = rgb
    luma = kr * red + (1 - kr - kb) * green + kb * blue
    return (blue - luma) / (2 - 2 * kb), (red - luma) / (2 - 2 * kr)


def marker_colour(name: str, matrix: str) -> MarkerColour:
    """The chroma direction of a named colour under a picture's matrix. Raises UsageError for a colour not in COLOURS."""
    if name not in COLOURS:
        raise UsageError(f"unknown marker colour {name!r}", hint=f"choose one of {', '.join(COLOURS)}")
    cb, cr = chroma(COLOURS[name], matrix)
    length = math.hypot(cb, cr)
    return MarkerColour(name, cb / length, cr / length)


def colour_plane(planes: Planes, colour: MarkerColour) -> UInt8Array:
    """How strongly each chroma sample shows the colour: 128 for grey, more for the colour, less for its opposite.

    A hue close to one axis (red: Cr, blue: Cb) takes that plane as it is, without arithmetic; any other hue takes the
    projection on its direction. Shape as planes.cb.
    """
    if colour.cr > 0.9:
        return planes.cr
    if colour.cb > 0.9:
        return planes.cb
    return np.asarray(
        cv2.addWeighted(planes.cb, colour.cb, planes.cr, colour.cr, 128 * (1 - colour.cb - colour.cr)), np.uint8
    )
