"""Finds the marker candidates of successive pictures of one recording, and learns the threshold on the way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchlab.vision.colour import MarkerColour, marker_colour
from benchlab.vision.markers import CANDIDATE, Region, find_candidates
from benchlab.vision.picture import Planes
from benchlab.vision.threshold import find_threshold

FIRST_TRIES, TRY_EVERY = 10, 5  # pictures in which a threshold is looked for until there is one
LOST_FOR = 30  # pictures with fewer than three candidates after which it is learnt again


class MarkerFinder:
    """Give it pictures in order; it gives back their candidates (CANDIDATE records).

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

    def find(self, planes: Planes) -> NDArray[np.void]:
        colour = self._colour or marker_colour(self.colour_name, planes.matrix)
        self._colour = colour
        if self.fixed is None and self._is_time_to_learn():
            self.threshold = find_threshold(planes, colour, self.region, self.count) or self.threshold
            self._lost = 0
        self._seen += 1
        if self.threshold is None:
            return np.zeros(0, CANDIDATE)
        found = find_candidates(planes, colour, self.threshold, self.region)
        self._lost = self._lost + 1 if len(found) < 3 else 0
        return found

    def _is_time_to_learn(self) -> bool:
        if self.each or self._lost >= LOST_FOR:
            return True
        return self.threshold is None and (self._seen < FIRST_TRIES or self._seen % TRY_EVERY == 0)
