"""Inverse design along lines: where a function of one dimension takes a value, found with as few true evaluations as will do.

A coarse line of true values is interpolated (the surrogate), which says where to look; what is found is a root of the
function itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.optimize import brentq

from benchlab.errors import UsageError
from benchlab.simulation.laws.law import FloatArray

Function = Callable[[float], float]


@dataclass(frozen=True)
class Bracket:
    """Two places between which a function passes its target, its values there, and where the surrogate has the root."""

    low: float
    high: float
    at_low: float
    at_high: float
    guess: float


def spline_peak(x: FloatArray, y: FloatArray) -> float | None:
    """Where a cubic spline through (x, y), x growing, is largest, if that is clearly between two places and above all of them;
    NaN in y are left out.

    >>> round(spline_peak(np.array([0.0, 1.0, 2.0, 3.0]), -((np.arange(4) - 1.4) ** 2)), 3)
    1.4
    """
    known = np.isfinite(y)
    x, y = x[known], y[known]
    if len(x) < 4:
        return None
    spline = CubicSpline(x, y)
    places = [float(p) for p in spline.derivative().roots(extrapolate=False) if np.isfinite(p)]
    best = max(places, key=spline, default=None)
    apart = 0.05 * float(np.diff(x).min())
    if best is None or spline(best) <= y.max() or np.abs(x - best).min() < apart:
        return None
    return best


def brackets(x: FloatArray, y: FloatArray, target: float) -> list[Bracket]:
    """Where y (n,) over growing x passes `target`, from one place to the next; not across a NaN.

    >>> [round(b.guess, 2) for b in brackets(np.arange(4.0), np.array([0.0, 4.0, 4.0, 0.0]), 3.0)]
    [0.56, 2.44]
    """
    found = []
    for i in range(len(x) - 1):
        here, there = float(y[i]) - target, float(y[i + 1]) - target
        if (
            np.isfinite(here)
            and np.isfinite(there)
            and here * there <= 0
            and here != there
            and (there != 0 or i == len(x) - 2)
        ):
            guess = _surrogate_root(x, y - target, i)
            found.append(Bracket(float(x[i]), float(x[i + 1]), here + target, there + target, guess))
    return found


def _surrogate_root(x: FloatArray, y: FloatArray, i: int) -> float:
    """Root of a shape-preserving cubic between places i and i + 1, which know their neighbours as far as these are finite."""
    low, high = i, i + 1
    while low > 0 and np.isfinite(y[low - 1]):
        low -= 1
    while high < len(x) - 1 and np.isfinite(y[high + 1]):
        high += 1
    curve = PchipInterpolator(x[low : high + 1], y[low : high + 1])
    return float(brentq(curve, x[i], x[i + 1]))


def solve_bracket(function: Function, bracket: Bracket, target: float, tolerance: float) -> float:
    """Where `function` is `target` within the bracket, to `tolerance` in place: the guess first, then Brent's method.

    Raises UsageError where the function has no value on the way.

    >>> cube = lambda x: x**3
    >>> round(solve_bracket(cube, Bracket(0.0, 2.0, 0.0, 8.0, 1.0), 2.0, 1e-6), 5)
    1.25992
    """
    known = {bracket.low: bracket.at_low, bracket.high: bracket.at_high}

    def miss(x: float) -> float:
        if x not in known:
            known[x] = function(x)
        if not math.isfinite(known[x]):
            raise UsageError(
                f"no value at {x:g}, between {bracket.low:g} and {bracket.high:g}", hint="take a lower pressure"
            )
        return known[x] - target

    low, high = bracket.low, bracket.high
    for step in (0.0, 0.15, -0.15):
        # The root is next to the guess: a narrow bracket there saves evaluations.
        x = float(np.clip(bracket.guess + step, low, high))
        if miss(x) * miss(low) <= 0:
            high = x
        else:
            low = x
        if high - low <= 0.3:
            break
    return float(brentq(miss, low, high, xtol=tolerance)) if high - low > tolerance else low


def central_slope(function: Function, x: float, step: float) -> float:
    """Derivative at x by a central difference; NaN where a value is.

    >>> round(central_slope(lambda x: x**2, 3.0, 0.5), 6)
    6.0
    """
    return (function(x + step) - function(x - step)) / (2 * step)


def balanced(costs: FloatArray) -> int:
    """The row of costs (n, m), the less the better, that loses least over all columns, each scaled from its best to its worst.

    >>> balanced(np.array([[0.0, 10.0], [1.0, 1.0], [10.0, 0.0]]))
    1

    A column that is nowhere finite does not count; where some of it is not, those rows count as the worst.
    """
    total = np.zeros(len(costs))
    for column in costs.T:
        known = np.isfinite(column)
        if known.any():
            low, high = column[known].min(), column[known].max()
            total += np.where(known, (column - low) / max(high - low, 1e-300), 1.0)
    return int(np.argmin(total))


def whole_window_widths(
    low_mm: float, high_mm: float, length_mm: float, rib_width_mm: float, most: int
) -> tuple[float, ...]:
    """Up to `most` window widths (tw), evenly over the logarithm, with which whole windows fill the length (Eq 7), rounded down
    to 0.01 mm.

    >>> whole_window_widths(2.5, 4.0, 180.0, 2.0, 3)
    (2.56, 3.23, 3.93)
    """
    first = math.ceil((length_mm - rib_width_mm) / (high_mm + rib_width_mm) - 1e-9)
    last = math.floor((length_mm - rib_width_mm) / (low_mm + rib_width_mm) + 1e-9)
    counts = np.arange(max(first, 1), last + 1)
    widths = np.floor(((length_mm - rib_width_mm) / counts - rib_width_mm) * 100 + 1e-6) / 100
    widths = np.sort(widths[(widths >= low_mm - 1e-9) & (widths > 0)])
    if len(widths) > most:
        wanted = np.geomspace(widths[0], widths[-1], most)
        widths = np.unique([widths[np.abs(np.log(widths / w)).argmin()] for w in wanted])
    return tuple(float(w) for w in widths)


def nodes_between(low: float, high: float, count: int) -> FloatArray:
    """Places from low to high, ends included, evenly over the square root: closer where widths are small and tell more.

    >>> nodes_between(1.0, 9.0, 3)
    array([1., 4., 9.])
    """
    found = np.linspace(math.sqrt(low), math.sqrt(high), count) ** 2
    found[[0, -1]] = low, high
    return found


def best_rows(costs: FloatArray, names: Sequence[str]) -> dict[str, int]:
    """For `balanced` and each named column of costs (n, m), the best row; columns without a finite value are left out."""
    found = {"balanced": balanced(costs)}
    for name, column in zip(names, costs.T):
        if np.isfinite(column).any():
            found[name] = int(np.nanargmin(column))
    return found
