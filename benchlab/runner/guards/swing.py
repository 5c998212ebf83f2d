"""A closed loop that swings."""

from __future__ import annotations

import math
from collections import deque

from benchlab.runner.end import Cause
from benchlab.runner.guards.limits import Limits
from benchlab.runner.tick import Tick


class Turns:
    """Counts where a value that goes up and down turns by at least `least`: the turning points of a line drawn through its swings."""

    def __init__(self) -> None:
        self.rising: bool | None = None
        self.low, self.high = math.inf, -math.inf

    def turned(self, value: float, least: float) -> bool:
        """Whether this value is so far from the last extreme that that was a turning point."""
        self.low, self.high = min(self.low, value), max(self.high, value)
        falls, rises = self.high - value >= least, value - self.low >= least
        if not (falls if self.rising else rises if self.rising is False else falls or rises):
            return False
        turned = self.rising is not None
        self.rising = rises
        self.low = self.high = value
        return turned


class SwingGuard:
    """The pressure that a controller asks for goes up and down by a quarter of its peak, over and over, and the reference does not.

    A turn of the reference may cost two turns of the pressure; those beyond, in the last ten seconds, are counted.
    """

    name = "oscillation"
    OVER_S = 10.0
    SHARE, LEAST_MPA, LEAST_DEG = 0.25, 0.03, 0.5

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self._forget()

    def _forget(self) -> None:
        self.peak_MPa = 0.0
        self.pressure, self.reference = Turns(), Turns()
        self.recent: deque[tuple[float, int]] = deque()

    def check(self, tick: Tick) -> Cause | None:
        if math.isnan(tick.reference_deg):
            self._forget()
            return None
        self.peak_MPa = max(self.peak_MPa, tick.command_MPa)
        swing = max(self.SHARE * self.peak_MPa, self.LEAST_MPA)
        count = int(self.pressure.turned(tick.command_MPa, swing))
        count -= 2 * self.reference.turned(tick.reference_deg, self.LEAST_DEG)
        if count:
            self.recent.append((tick.time_s, count))
        while self.recent and self.recent[0][0] <= tick.time_s - self.OVER_S:
            self.recent.popleft()
        if count <= 0 or (turns := sum(n for _, n in self.recent)) < self.limits.swings:
            return None
        took = tick.time_s - self.recent[0][0]
        words = f"the loop oscillates: the pressure asked for turned {turns} times in {took:.2g} s by {1e3 * swing:.0f} kPa or more"
        return Cause("oscillating", f"{words}, and the reference did not: smaller gains (`benchlab control tune`)")
