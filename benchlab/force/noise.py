"""The scatter of a trace, found without knowing its shape."""

from __future__ import annotations

import math

import numpy as np

from benchlab.units import FloatArray

MAD_TO_SD = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""


def noise_sd(values: FloatArray) -> float:
    """Standard deviation of white noise on a smooth trace (n,): from the median size of its second differences, whose variance
    is six times that of the noise. 0 for fewer than three values, and where most neighbours are equal.

    >>> round(noise_sd(np.sin(np.arange(5000) / 100) + np.random.default_rng(1).normal(0, 0.2, 5000)), 2)
    0.2
    """
    if len(values) < 3:
        return 0.0
    return float(MAD_TO_SD * np.median(np.abs(np.diff(values, 2))) / math.sqrt(6))


def shortest_half(values: FloatArray) -> FloatArray:
    """The half of the values (n,) that lies closest together, sorted: where most of them are, whatever the others do.

    >>> shortest_half(np.array([0.0, 9.0, 5.0, 5.2, 5.1, 30.0])).tolist()
    [5.0, 5.1, 5.2]
    """
    ordered = np.sort(values)
    half = (len(ordered) + 1) // 2
    widths = ordered[half - 1 :] - ordered[: len(ordered) - half + 1]
    first = int(np.argmin(widths))
    return ordered[first : first + half]


def sd_of_mean(values: FloatArray) -> float:
    """Standard deviation of the mean of successive values (n,), neighbours being alike as in a first-order autoregression:
    n·(1 − ρ)/(1 + ρ) of them count. NaN for fewer than two.

    >>> values = np.random.default_rng(1).normal(0, 1, 400)
    >>> round(sd_of_mean(values), 2)
    0.05
    """
    n = len(values)
    if n < 2:
        return math.nan
    about = values - values.mean()
    square = float(about @ about)
    if square == 0:
        return 0.0
    alike = min(max(float(about[1:] @ about[:-1]) / square, 0.0), 1 - 1 / n)
    return math.sqrt(square / (n - 1) / max(n * (1 - alike) / (1 + alike), 1.0))
