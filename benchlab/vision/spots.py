"""Spots of the marker colour in one picture: where the colour plane passes a threshold, cut out of the picture."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np

from benchlab.vision.colour import MarkerColour, colour_plane
from benchlab.vision.picture import Planes, UInt8Array
from benchlab.vision.window import SLACK, radius_class, reach_of

MAX_SPOTS = 120  # a picture with more has the wrong threshold; the largest are kept
MIN_SPOT_SAMPLES = 4  # chroma samples: a marker is at least about 5 luma pixels wide
MAX_RADIUS = 60.0  # chroma samples; anything wider is no marker


@dataclass(frozen=True)
class Region:
    """The part of a picture to look at, in luma pixels; the edges belong to it."""

    left: float
    top: float
    right: float
    bottom: float

    def samples(self, planes: Planes) -> tuple[slice, slice]:
        """Rows and columns of the chroma planes that lie inside."""
        (step_x, step_y), (offset_x, offset_y) = planes.chroma_step, planes.chroma_offset
        rows = slice(
            max(math.ceil((self.top - offset_y) / step_y), 0), math.floor((self.bottom - offset_y) / step_y) + 1
        )
        columns = slice(
            max(math.ceil((self.left - offset_x) / step_x), 0), math.floor((self.right - offset_x) / step_x) + 1
        )
        return rows, columns


class Cut(NamedTuple):
    """A square window of a plane, copied; the plane's sample (x, y) at its middle; the radius class it is cut for."""

    window: UInt8Array
    middle: tuple[int, int]
    size: int


class Spot(NamedTuple):
    """One spot: its middle and equivalent radius in chroma samples, its hue, and its windows of colour plane and luma."""

    x: float
    y: float
    radius: float
    hue_rad: float
    colour: Cut
    luma: Cut


def find_spots(planes: Planes, colour: MarkerColour, threshold: float, region: Region | None = None) -> list[Spot]:
    """The connected spots of the colour plane above a level (128 is grey), in no particular order.

    Spots that touch the border of the picture or of the region are cut off, so their centre is unknown: left out.
    """
    score = colour_plane(planes, colour)
    rows, columns = region.samples(planes) if region else (slice(0, None), slice(0, None))
    view, left, top = score[rows, columns], columns.start, rows.start
    _, mask = cv2.threshold(view, threshold, 255, cv2.THRESH_BINARY)
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    if len(contours) > MAX_SPOTS:
        contours = sorted(contours, key=len, reverse=True)[:MAX_SPOTS]
    height, width = view.shape
    (step_x, step_y), (offset_x, offset_y) = planes.chroma_step, planes.chroma_offset
    spots = []
    for contour in contours:
        x, y, w, h = cv2.boundingRect(contour)
        inside = x > 0 and y > 0 and x + w < width and y + h < height
        if not inside or w * h < MIN_SPOT_SAMPLES or max(w, h) > 2 * MAX_RADIUS:
            continue
        # Lattice points inside and on the contour (Pick's theorem), whose steps are 1 or √2 long.
        samples = cv2.contourArea(contour) + cv2.arcLength(contour, True) / 2.4 + 1
        if samples < MIN_SPOT_SAMPLES:
            continue
        radius = math.sqrt(samples / math.pi)
        middle_x, middle_y = left + x + (w - 1) / 2, top + y + (h - 1) / 2
        row, column = round(middle_y), round(middle_x)
        hue = math.atan2(float(planes.cr[row, column]) - 128, float(planes.cb[row, column]) - 128)
        in_luma = (middle_x * step_x + offset_x, middle_y * step_y + offset_y)
        luma = _cut(planes.luma, *in_luma, radius * math.sqrt(step_x * step_y))
        in_colour = _cut(score, middle_x, middle_y, radius)
        spots.append(Spot(middle_x, middle_y, radius, hue, in_colour, luma))
    return spots


def _cut(plane: UInt8Array, x: float, y: float, radius: float) -> Cut:
    """The window about the sample nearest to (x, y); beyond the border the outermost samples are repeated."""
    height, width = plane.shape
    size = radius_class(radius)
    reach, column, row = reach_of(size) + SLACK, round(x), round(y)
    if reach <= column < width - reach and reach <= row < height - reach:
        window = plane[row - reach : row + reach + 1, column - reach : column + reach + 1].copy()
    else:
        rows, columns = (
            np.clip(np.arange(m - reach, m + reach + 1), 0, n - 1) for m, n in ((row, height), (column, width))
        )
        window = plane[np.ix_(rows, columns)]
    return Cut(window, (column, row), size)
