"""Whether force and pressure were recorded on one clock."""

from __future__ import annotations

import math

import numpy as np
from scipy.signal import correlate

from benchlab.units import FloatArray

POINTS = 8192
"""Points in equal steps of time that two traces are compared at, at most."""


def lag_s(time_s: FloatArray, force_N: FloatArray, pressure_MPa: FloatArray) -> float:
    """How far the force comes behind the pressure, in seconds: where the two are most alike. All (n,), NaN where not known.

    Between cycles that are equal in height and length there is no telling which belongs to which. NaN where nothing is known.

    >>> time = np.arange(0, 60, 0.1)
    >>> press = lambda t: (t % 12 > 6) * (1 + t / 60)
    >>> round(lag_s(time, 100 * press(time - 1.5), press(time)), 1)
    1.5
    """
    known = np.isfinite(time_s) & np.isfinite(force_N) & np.isfinite(pressure_MPa)
    if known.sum() < 3:
        return math.nan
    order = np.argsort(time_s[known], kind="stable")
    time, force, pressure = (values[known][order] for values in (time_s, force_N, pressure_MPa))
    grid = np.linspace(time[0], time[-1], min(POINTS, len(time)))
    one, other = (np.interp(grid, time, values - values.mean()) for values in (force, pressure))
    alike = correlate(one, other, method="fft")
    return float((int(np.argmax(alike)) - (len(grid) - 1)) * (grid[1] - grid[0]))
