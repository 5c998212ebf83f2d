"""The zero of a load cell over a record: its level in each unloaded rest, and straight lines from rest to rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import uniform_filter1d

from benchlab.force.loading import Loading
from benchlab.force.noise import MAD_TO_SD, noise_sd, sd_of_mean, shortest_half
from benchlab.units import FloatArray

FLAT_SHARE = 0.05
"""Readings within this share of the loading's height over the lowest of a gap may be of the rest."""


@dataclass(frozen=True)
class Baseline:
    """Zero of a load cell. place: (R,) where the rests are, in readings from the first; level_N, sd_N: (R,) each with its standard
    deviation. noise_N: standard deviation of single readings in the rests. slope_N_per_s: of the straight line through all rests, NaN for
    fewer than two and where no time is known.
    """

    place: FloatArray
    level_N: FloatArray
    sd_N: FloatArray
    noise_N: float
    slope_N_per_s: float

    def at(self, place: float) -> tuple[float, float]:
        """Level and standard deviation at a place; straight between two rests, level before the first and behind the last.

        >>> zero = Baseline(np.array([0.0, 10.0]), np.array([1.0, 2.0]), np.array([0.3, 0.4]), 0.1, np.nan)
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
    that neither the end of a slow fall nor a short swing below zero counts. Gaps that the record cuts, and those that stay high, are
    no rests. Raises ValueError where there is none.
    """
    noise = noise_sd(force_N)
    rests = [found for gap in _gaps(loadings, len(force_N)) if (found := _rest(force_N, *gap, noise)) is not None]
    if not rests:
        raise ValueError("a record without a rest")
    place, level, sd = (np.array(column) for column in zip(*((p, m, s) for p, m, s, _ in rests)))
    about = np.concatenate([values for *_, values in rests])
    slope = math.nan
    if time_s is not None and len(place) > 1:
        slope = float(np.polyfit(np.interp(place, np.arange(len(time_s)), time_s), level, 1)[0])
    return Baseline(place, level, sd, float(MAD_TO_SD * np.median(np.abs(about))), slope)


def _gaps(loadings: Sequence[Loading], n: int) -> list[tuple[int, int, tuple[Loading, ...]]]:
    """First and last (exclusive) reading of each gap, with the loadings beside it."""
    edges: list[tuple[int, int, tuple[Loading, ...]]] = [(0, loadings[0].rise, (loadings[0],))]
    edges += [(a.fall + 1, b.rise, (a, b)) for a, b in pairwise(loadings)]
    edges += [(loadings[-1].fall + 1, n, (loadings[-1],))]
    cut_first, cut_last = loadings[0].cut == "start", loadings[-1].cut == "end"
    return edges[1 if cut_first else 0 : -1 if cut_last else None]


def _rest(
    force_N: FloatArray, first: int, stop: int, beside: tuple[Loading, ...], noise: float
) -> tuple[float, float, float, FloatArray] | None:
    """Place, level, standard deviation of the level, and readings about the level; None where there is no reading."""
    part = force_N[first:stop]
    if not len(part):
        return None
    window = max(1, len(part) // 10) | 1
    smooth = uniform_filter1d(part, window, mode="nearest")
    height = min(float(force_N[c.rise : c.fall + 1].max()) for c in beside) - float(smooth.min())
    inside = np.flatnonzero(smooth <= smooth.min() + max(FLAT_SHARE * height, 6 * noise / window**0.5))
    values = part[inside]
    half = shortest_half(values)
    kept = (values >= half[0]) & (values <= half[-1])
    near = values[np.abs(values - half.mean()) <= max(3 * (half[-1] - half[0]), 1e-300)] if len(half) > 1 else values
    level = float(near.mean())
    spread = sd_of_mean(near)
    sd = spread if math.isfinite(spread) else noise
    return float(first + inside[kept].mean()), level, sd, near - level
