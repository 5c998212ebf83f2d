"""The zero of a load cell over a record: its level in each unloaded rest, and straight lines from rest to rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from benchlab.force.loading import Loading
from benchlab.force.noise import MAD_TO_SD, noise_sd, sd_of_mean, shortest_half
from benchlab.units import FloatArray

FLAT_SHARE = 0.05
"""Readings within this share of the loading's height over the lowest of a gap may be of the rest."""

FLAT = 0.01
"""A rest is flat where half of its readings lie within this share of the loading's height."""


@dataclass(frozen=True)
class Baseline:
    """Zero of a load cell. place: (R,) where the rests are, in readings from the first; level_N, sd_N: (R,) each with its standard
    deviation; flat: (R,) whether the force stays there. noise_N: standard deviation of single readings in the rests. slope_N_per_s: of the
    straight line through all rests, NaN for fewer than two and where no time is known.
    """

    place: FloatArray
    level_N: FloatArray
    sd_N: FloatArray
    flat: NDArray[np.bool_]
    noise_N: float
    slope_N_per_s: float

    def at(self, place: float) -> tuple[float, float]:
        """Level and standard deviation at a place; straight between two rests, level before the first and behind the last.

        >>> zero = Baseline(np.array([0.0, 10.0]), np.array([1.0, 2.0]), np.array([0.3, 0.4]), np.ones(2, bool), 0.1, np.nan)
        >>> zero.at(5.0), zero.at(99.0)
        ((1.5, 0.25), (2.0, 0.4))
        """
        level = float(np.interp(place, self.place, self.level_N))
        behind = int(np.clip(np.searchsorted(self.place, place), 0, len(self.place) - 1))
        before = max(behind - 1, 0) if place < self.place[behind] else behind
        width = self.place[behind] - self.place[before]
        share = (place - self.place[before]) / width if width else 0.0
        share = float(np.clip(share, 0, 1))
        return level, math.hypot((1 - share) * self.sd_N[before], share * self.sd_N[behind]) if width else float(
            self.sd_N[behind]
        )


def find_baseline(force_N: FloatArray, time_s: FloatArray | None, loadings: Sequence[Loading]) -> Baseline:
    """The zero of a record (n,) from the gaps between its loadings, which need at least one.

    A gap runs from half way down to half way up again. Its rest is what lies, smoothed, within 5 % of the height of the lower neighbour
    (or six times the noise) of the gap's lowest; its level is the mean of that half of these readings that lies closest together, so
    that neither the end of a slow fall nor a short swing below zero counts. Where that half is wider than 1 % of the height (and more
    than noise is) the force does not rest, and the level is the gap's lowest. Gaps that the record cuts are no rests.
    Raises ValueError where there is none.
    """
    noise = noise_sd(force_N)
    gaps = _gaps(loadings, len(force_N))
    rests = [_rest(force_N, *gap, noise) for gap in gaps if gap[1] > gap[0]]
    if not rests:
        raise ValueError("a record without a rest")
    place, level, sd, flat = (np.array([getattr(r, name) for r in rests]) for name in ("place", "level", "sd", "flat"))
    about = np.concatenate([rest.about for rest in rests if rest.flat] or [np.full(1, noise)])
    slope = math.nan
    if time_s is not None:
        at = np.interp(place, np.arange(len(time_s)), time_s)
        known = np.isfinite(at)
        slope = float(np.polyfit(at[known], level[known], 1)[0]) if len(set(at[known].tolist())) > 1 else math.nan
    return Baseline(place, level, sd, flat, float(MAD_TO_SD * np.median(np.abs(about))), slope)


@dataclass(frozen=True)
class _Rest:
    """about: readings about the level."""

    place: float
    level: float
    sd: float
    flat: bool
    about: FloatArray


def _gaps(loadings: Sequence[Loading], n: int) -> list[tuple[int, int, tuple[Loading, ...]]]:
    """First and last (exclusive) reading of each gap, with the loadings beside it."""
    edges: list[tuple[int, int, tuple[Loading, ...]]] = [(0, loadings[0].rise, (loadings[0],))]
    edges += [(a.fall + 1, b.rise, (a, b)) for a, b in pairwise(loadings)]
    edges += [(loadings[-1].fall + 1, n, (loadings[-1],))]
    cut_first, cut_last = loadings[0].cut == "start", loadings[-1].cut == "end"
    return edges[1 if cut_first else 0 : -1 if cut_last else None]


def _rest(force_N: FloatArray, first: int, stop: int, beside: tuple[Loading, ...], noise: float) -> _Rest:
    part = force_N[first:stop]
    window = max(1, len(part) // 10) | 1
    smooth = uniform_filter1d(part, window, mode="nearest")
    lowest = float(smooth.min())
    height = min(float(force_N[c.rise : c.fall + 1].max()) for c in beside) - lowest
    inside = np.flatnonzero(smooth <= lowest + max(FLAT_SHARE * height, 6 * noise / window**0.5))
    values = part[inside]
    half = shortest_half(values)
    width = float(half[-1] - half[0])
    if width > max(FLAT * height, 3 * noise):
        return _Rest(first + float(np.argmin(smooth)), lowest, width, False, np.empty(0))
    near = values[np.abs(values - half.mean()) <= 3 * width] if width > 0 else half
    spread = sd_of_mean(near)
    kept = inside[(values >= half[0]) & (values <= half[-1])]
    level = float(near.mean())
    return _Rest(first + float(kept.mean()), level, spread if math.isfinite(spread) else noise, True, near - level)
