"""The level that divides markers from everything else, found from the picture itself."""

from __future__ import annotations

import numpy as np

from benchlab.vision.chain import find_chain, is_convincing
from benchlab.vision.colour import MarkerColour, colour_plane
from benchlab.vision.markers import LEAST_CONTRAST, find_candidates
from benchlab.vision.picture import FloatArray, Planes, UInt8Array
from benchlab.vision.spots import Region

LEVELS_TRIED = 9


def find_threshold(
    planes: Planes, colour: MarkerColour, region: Region | None = None, count: int | None = None
) -> float | None:
    """The colour-plane level half way up the faintest marker, or None where no chain of markers is seen.

    Levels from just above the background to just below the strongest colour are tried; the one at which the spots form
    the best chain tells which spots are the markers.
    """
    score = colour_plane(planes, colour)
    if region:
        score = score[region.samples(planes)]
    best = None
    for level in _levels(score):
        candidates = find_candidates(planes, colour, level, region)
        chain = find_chain(candidates, count)
        if chain and is_convincing(chain, candidates) and (best is None or chain.score > best[0]):
            members = candidates[list(chain.order)]
            best = chain.score, float(np.min(members["level"] - members["contrast"] / 2))
    return best[1] if best else None


def _levels(score: UInt8Array) -> FloatArray:
    """Levels to try, geometrically spaced between the background and the strongest colour in the picture."""
    counts = np.bincount(score[::2, ::2].ravel(), minlength=256)
    below = np.cumsum(counts) / counts.sum()
    background, upper = np.searchsorted(below, [0.5, 0.84])
    low = background + max(LEAST_CONTRAST, 3.0 * (upper - background))
    strongest = float(np.flatnonzero(np.bincount(score.ravel(), minlength=256) >= 4)[-1])
    if strongest - background < LEAST_CONTRAST:
        return np.zeros(0)
    low = min(low, (background + strongest) / 2)
    return background + np.geomspace(low - background, 0.85 * (strongest - background), LEVELS_TRIED)
