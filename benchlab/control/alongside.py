"""Whether two series are of the same run: how much of one the other covers, how alike they move, how late one is."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from benchlab.control.tracking import lag_s
from benchlab.units import FloatArray


@dataclass(frozen=True)
class Alongside:
    """other: (T,) at the first series' times, NaN where it has none. covered: share of the first's time that it spans. correlation:
    Pearson's, NaN where one stands still. late_s: by how much it is late, NaN where that cannot be told."""

    other: FloatArray
    covered: float
    correlation: float
    late_s: float


def lay_alongside(time_s: FloatArray, values: FloatArray, other_time_s: FloatArray, other: FloatArray) -> Alongside:
    """Compare values (T,) over time_s (T,) with another series (A,) over other_time_s (A,) on the same clock.

    >>> t = np.arange(0, 20, 0.01)
    >>> found = lay_alongside(t, np.sin(t), t + 5, np.sin(t + 4.9))
    >>> round(found.covered, 2), round(found.correlation, 2), round(found.late_s, 2)
    (0.75, 0.99, 0.1)
    """
    laid = np.interp(time_s, other_time_s, other, left=np.nan, right=np.nan)
    span = float(np.ptp(time_s))
    common = float(min(time_s[-1], other_time_s[-1]) - max(time_s[0], other_time_s[0]))
    both = np.isfinite(values) & np.isfinite(laid)
    correlation = late = math.nan
    if both.sum() > 3 and np.ptp(values[both]) > 0 and np.ptp(laid[both]) > 0:
        correlation = float(np.corrcoef(values[both], laid[both])[0, 1])
        late = lag_s(time_s[both], values[both], math.copysign(1.0, correlation) * laid[both])
    return Alongside(laid, max(0.0, common / span) if span > 0 else 0.0, correlation, late)
