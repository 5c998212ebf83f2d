"""Monotone cubic interpolation whose single values are cheap: plain floats, no arrays."""

from __future__ import annotations

from bisect import bisect_right

import numpy as np
from numpy.typing import NDArray


class Cubic:
    """The PCHIP interpolant of y over x, (P,) each, x strictly increasing: monotone where the data are, so that nothing overshoots
    (Fritsch and Butland 1984). Outside of the first and last x, the value there.

    >>> line = Cubic(np.array([0.0, 1.0, 2.0]), np.array([0.0, 2.0, 4.0]))
    >>> line.value(1.5), line.slope(0.5), line.value(9.0)
    (3.0, 2.0, 4.0)
    """

    def __init__(self, x: NDArray[np.float64], y: NDArray[np.float64]) -> None:
        from scipy.interpolate import PchipInterpolator

        self._x: list[float] = x.tolist()
        self._pieces: list[list[float]] = PchipInterpolator(x, y).c.T.tolist()
        self._last = len(self._pieces) - 1

    def _at(self, x: float) -> tuple[list[float], float]:
        first, last = self._x[0], self._x[-1]
        x = first if x < first else last if x > last else x
        index = min(bisect_right(self._x, x) - 1, self._last)
        return self._pieces[index], x - self._x[index]

    def value(self, x: float) -> float:
        (a, b, c, d), t = self._at(x)
        return ((a * t + b) * t + c) * t + d

    def slope(self, x: float) -> float:
        (a, b, c, _), t = self._at(x)
        return (3 * a * t + 2 * b) * t + c
