"""Values against time of what a step can be: constant, straight, sine, triangle. Pressures or angles, times in s."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from benchlab.units import FloatArray

Wave = Callable[[FloatArray], FloatArray]


def constant(value: float) -> Wave:
    """The same value throughout.

    >>> constant(0.2)(np.array([0.0, 1.0])).tolist()
    [0.2, 0.2]
    """
    return lambda time_s: np.full(len(time_s), value)


def straight(start: float, end: float, duration_s: float) -> Wave:
    """From start to end in a straight line; exactly `end` at the end.

    >>> straight(0.0, 0.3, 2.0)(np.array([0.0, 1.0, 2.0])).tolist()
    [0.0, 0.15, 0.3]
    """
    return lambda time_s: np.interp(time_s, [0.0, duration_s], [start, end])


def there_and_back(low: float, high: float, period_s: float) -> Wave:
    """From low to high and back to low, straight.

    >>> there_and_back(0.0, 0.3, 2.0)(np.array([0.0, 1.0, 1.5, 2.0])).tolist()
    [0.0, 0.3, 0.15, 0.0]
    """
    return lambda time_s: np.interp(time_s, [0.0, period_s / 2, period_s], [low, high, low])


def sine_from(start: float, mean: float, amplitude: float, period_s: float) -> Wave:
    """mean + amplitude · sin(2π·t/period + φ) with the phase φ, from −90° to 90°, at which it is `start`: it begins there, rising.

    >>> sine_from(0.1, 0.2, 0.1, 4.0)(np.array([0.0, 1.0, 2.0, 4.0])).round(3).tolist()
    [0.1, 0.2, 0.3, 0.1]
    """
    phase = math.asin(max(-1.0, min((start - mean) / amplitude, 1.0)))
    return lambda time_s: np.clip(
        mean + amplitude * np.sin(2 * math.pi * time_s / period_s + phase), mean - amplitude, mean + amplitude
    )
