"""What guards remember of the past: how long something has been so, and a pressure that lags."""

from __future__ import annotations

import math


class Timer:
    """How long something has been so: counts up while it is, and down again while it is not, so that noise does not reset it."""

    __slots__ = ("_last", "for_s")

    def __init__(self) -> None:
        self.for_s, self._last = 0.0, math.nan

    def count(self, time_s: float, so: bool) -> float:
        """Seconds that it has been so, at time_s, with a nanosecond for the rounding of sums."""
        passed = time_s - self._last if self._last == self._last else 0.0
        self._last = time_s
        self.for_s = max(0.0, self.for_s + (passed if so else -passed))
        return self.for_s + 1e-9


class Lag:
    """A pressure that follows what is asked for as a first-order lag."""

    __slots__ = ("_last", "lag_s", "value")

    def __init__(self, lag_s: float) -> None:
        self.lag_s, self.value, self._last = lag_s, 0.0, math.nan

    def after(self, time_s: float, command_MPa: float) -> float:
        """The lagging pressure at time_s, if command_MPa was asked for since the call before."""
        if self._last == self._last:
            self.value += (command_MPa - self.value) * -math.expm1(-(time_s - self._last) / self.lag_s)
        self._last = time_s
        return self.value
