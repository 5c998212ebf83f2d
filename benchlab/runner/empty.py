"""Whether a bench that was vented is empty, as far as its monitor and its flex sensor show it.

The monitor is at the regulator: air that is locked in behind a shut valve or a kinked tube does not show there, but keeps the actuator
bent.
"""

from __future__ import annotations

import math

from benchlab.bench import Bench
from benchlab.devices.interface import Status
from benchlab.runner.end import Cause
from benchlab.runner.tick import Tick

EMPTY_MPA = 0.01
"""A monitor below this shows that there is nothing at the regulator."""

BENT_DEG, BACK_SHARE, BACK_DEG = 10.0, 0.2, 5.0
"""An actuator that bent by the first is straight again with less than the second of its largest angle left, or than the third."""

FLEX_MARGIN_V = 0.02
"""The flex sensor is not believed nearer to the ends of its divider."""


class Sight:
    """Sees every tick of a run, so that it knows what bent and what straight is, and after its vent whether it is empty."""

    name = "empty"

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.rest_deg, self.peak_deg, self.moved_deg = math.nan, 0.0, math.nan
        self.pressure_MPa, self.code, self.armed = math.nan, -1, True

    def check(self, tick: Tick) -> Cause | None:
        """Look at a tick; never a cause to stop."""
        if tick.status & Status.NO_ANSWER.value:
            return None
        reading = tick.reading
        self.pressure_MPa, self.code = reading.pressure_MPa, reading.code
        self.armed = bool(tick.status & Status.ARMED.value)
        believed = FLEX_MARGIN_V <= reading.flex_V <= self.bench.supply_V - FLEX_MARGIN_V
        angle = tick.angle_deg if believed else math.nan
        if math.isnan(self.rest_deg):
            self.rest_deg = angle
        self.moved_deg = angle - self.rest_deg
        self.peak_deg = max(self.peak_deg, self.moved_deg)
        return None

    def empty(self, disbelieved: str = "") -> bool | None:
        """Whether it was empty at the last tick, by all that shows it. disbelieved: a sensor that is not looked at."""
        seen = [each for each in (self._by_monitor(disbelieved), self._by_flex(disbelieved)) if each is not None]
        return False if self.code != 0 or self.armed else all(seen) if seen else None

    def words(self, disbelieved: str = "") -> str:
        """What was seen at the last tick."""
        told = []
        if self.code != 0 or self.armed:
            code = self.code if self.code >= 0 else "unknown"
            told.append("the device is armed" if self.armed else f"the DAC's code is {code}")
        if self._by_monitor(disbelieved) is not None:
            told.append(f"the monitor shows {round(1e3 * self.pressure_MPa, 1) + 0.0:.1f} kPa")
        if self._by_flex(disbelieved) is not None:
            told.append(f"{max(0.0, self.moved_deg):.1f}° of {self.peak_deg:.1f}° are left")
        elif told:
            told.append("the angle tells nothing")
        return ", ".join(told) or "no sensor shows it"

    def _by_monitor(self, disbelieved: str) -> bool | None:
        unknown = disbelieved == "pressure sensor" or math.isnan(self.pressure_MPa)
        return None if unknown else self.pressure_MPa <= EMPTY_MPA

    def _by_flex(self, disbelieved: str) -> bool | None:
        if disbelieved == "flex sensor" or math.isnan(self.moved_deg) or self.peak_deg < BENT_DEG:
            return None
        return self.moved_deg <= max(BACK_DEG, BACK_SHARE * self.peak_deg)
