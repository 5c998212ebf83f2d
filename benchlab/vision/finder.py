"""Finds the marker candidates of successive pictures of one recording, and learns the threshold on the way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchlab.vision.colour import MarkerColour, marker_colour
from benchlab.vision.markers import measure_spots
from benchlab.vision.picture import Planes
from benchlab.vision.spots import Region, Spot, find_spots
from benchlab.vision.threshold import find_threshold

FIRST_TRIES, TRY_EVERY = 10, 5  # pictures in which a threshold is looked for until there is one
TOGETHER = 32  # pictures measured at once
LOST_FOR = 30  # pictures with fewer than three candidates after which it is learnt again


class MarkerFinder:
    """Give it pictures in order; it keeps their candidates (CANDIDATE records), measured many pictures at a time.

    threshold: a fixed level of the colour plane (128 is grey), or None to learn it from the pictures.
    each: learn it anew in every picture (stills, whose light may differ).
    """

    def __init__(
        self,
        colour: str = "red",
        threshold: float | None = None,
        region: Region | None = None,
        count: int | None = None,
        each: bool = False,
    ) -> None:
        self.colour_name, self.region, self.count, self.each = colour, region, count, each
        self.fixed = threshold
        self.threshold = threshold
        self._colour: MarkerColour | None = None
        self._seen = self._lost = 0
        self._layout: tuple[tuple[int, int], tuple[float, float]] | None = None
        self._waiting: list[list[Spot]] = []
        self._candidates: list[NDArray[np.void] | None] = []

    def look(self, planes: Planes) -> None:
        """Look at the next picture. Its planes are not needed any more afterwards."""
        colour = self._colour or marker_colour(self.colour_name, planes.matrix)
        self._colour = colour
        if self.fixed is None and self._is_time_to_learn():
            self.threshold = find_threshold(planes, colour, self.region, self.count) or self.threshold
            self._lost = 0
        self._seen += 1
        spots = [] if self.threshold is None else find_spots(planes, colour, self.threshold, self.region)
        self._lost = self._lost + 1 if len(spots) < 3 else 0
        layout = (planes.chroma_step, planes.chroma_offset)
        if layout != self._layout or len(self._waiting) >= TOGETHER:
            self._measure()
        self._layout = layout
        self._waiting.append(spots)

    def pass_over(self) -> None:
        """The next picture cannot be looked at: it has no candidates, which is not the same as none found."""
        self._measure()
        self._candidates.append(None)

    def candidates(self) -> list[NDArray[np.void] | None]:
        """The candidates of all pictures so far, None where one was passed over."""
        self._measure()
        return self._candidates

    def _measure(self) -> None:
        if self._waiting and self._colour and self._layout:
            self._candidates += measure_spots(self._waiting, self._colour, *self._layout)
            self._waiting = []

    def _is_time_to_learn(self) -> bool:
        if self.each or self._lost >= LOST_FOR:
            return True
        return self.threshold is None and (self._seen < FIRST_TRIES or self._seen % TRY_EVERY == 0)
