"""The time of a run: real, or as fast as the bench can."""

from __future__ import annotations

import time
import typing

SPIN_S = 0.0002
"""How long before a deadline sleeping ends and looking at the clock begins: a sleep of Linux ends some 60 µs late."""


class Clock(typing.Protocol):
    """Seconds since `start`, and a wait for one of them."""

    def start(self) -> None: ...

    def now_s(self) -> float: ...

    def wait_until(self, time_s: float) -> None: ...


class RealClock:
    """A clock that nobody sets and that goes on while the computer sleeps, where the system has one (Linux: CLOCK_BOOTTIME).

    So that a computer that slept finds itself late, and does not take the run up where it was.

    >>> clock = RealClock()
    >>> clock.start()
    >>> clock.wait_until(0.003)
    >>> clock.now_s() >= 0.003
    True
    """

    def __init__(self) -> None:
        self._clock = getattr(time, "CLOCK_BOOTTIME", None)
        self._zero = self._raw()

    def start(self) -> None:
        self._zero = self._raw()

    def now_s(self) -> float:
        return self._raw() - self._zero

    def wait_until(self, time_s: float) -> None:
        """Sleep, and look at the clock for the last moment. Comes back at once from a time that is past."""
        while (left := time_s - self.now_s()) > SPIN_S:
            time.sleep(left - SPIN_S)
        while self.now_s() < time_s:
            pass

    def _raw(self) -> float:
        return time.perf_counter() if self._clock is None else time.clock_gettime(self._clock)


class VirtualClock:
    """A clock that jumps to whatever is waited for: a run takes as long as its computing.

    >>> clock = VirtualClock()
    >>> clock.start(); clock.wait_until(2.5); clock.now_s()
    2.5
    """

    def __init__(self) -> None:
        self._now = 0.0

    def start(self) -> None:
        self._now = 0.0

    def now_s(self) -> float:
        return self._now

    def wait_until(self, time_s: float) -> None:
        self._now = max(self._now, time_s)
