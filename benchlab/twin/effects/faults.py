"""Faults: what breaks at a time of the run (s, on its clock). They test guards, are off unless named, and are told in the run's head.

`burst`: the bladder tears. The pressure inside falls with `time_s`; the regulator cannot hold more than `monitor_share` of its pressure.
`tube_off`: the same at the fitting, with a smaller hole for the regulator to feed.
`supply_shut`: no air comes any more; what is inside stays, or leaves by `leakage`. The monitor shows what is asked for.
`stuck_sensor`: the flex sensor's voltage stays as it was.
`sensor_out_of_range`: its wire breaks; the divider gives the supply.
Every number is chosen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Now, Stage, number
from benchlab.twin.lines import SUPPLY_V

_LATEST_S = 1e6


class _Opened:
    """Pressure behind a hole: from the time of the fault it falls exponentially, whatever is supplied."""

    def __init__(self, at_s: float, time_constant_s: float) -> None:
        self.at_s, self.time_constant_s = at_s, time_constant_s
        self.pressure = 0.0

    def __call__(self, value: float, now: Now) -> float:
        if now.time_s < self.at_s:
            self.pressure = value
        else:
            since_s = min(now.dt_s, now.time_s - self.at_s)
            self.pressure *= math.exp(-since_s / self.time_constant_s)
        return self.pressure


def _opened(at_s: float, time_constant_s: float, monitor_share: float) -> dict[str, Stage]:
    return {
        "line": _Opened(at_s, time_constant_s),
        "monitor": lambda value, now: value * monitor_share if now.time_s >= at_s else value,
    }


@dataclass(frozen=True)
class Burst(Effect):
    """The bladder tears."""

    name = "burst"
    at_s: float = number(1, "s", 0, _LATEST_S, "when")
    time_s: float = number(0.03, "s", 0.001, 10, "time constant of the pressure's fall")
    monitor_share: float = number(0.2, "", 0, 1, "share of its pressure that the regulator can hold")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return _opened(self.at_s, self.time_s, self.monitor_share)


@dataclass(frozen=True)
class TubeOff(Effect):
    """The tube comes off the fitting."""

    name = "tube_off"
    at_s: float = number(1, "s", 0, _LATEST_S, "when")
    time_s: float = number(0.05, "s", 0.001, 10, "time constant of the pressure's fall")
    monitor_share: float = number(0.5, "", 0, 1, "share of its pressure that the regulator can hold")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return _opened(self.at_s, self.time_s, self.monitor_share)


@dataclass(frozen=True)
class SupplyShut(Effect):
    """A valve before the actuator is shut."""

    name = "supply_shut"
    at_s: float = number(1, "s", 0, _LATEST_S, "when")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"line": _Shut(self.at_s)}


class _Shut:
    def __init__(self, at_s: float) -> None:
        self.at_s = at_s
        self.pressure = 0.0

    def __call__(self, value: float, now: Now) -> float:
        now.shut = now.time_s > self.at_s
        if not now.shut:
            self.pressure = value
        return self.pressure


@dataclass(frozen=True)
class StuckSensor(Effect):
    """The flex sensor's reading freezes."""

    name = "stuck_sensor"
    at_s: float = number(1, "s", 0, _LATEST_S, "when")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"flex_V": _Stuck(self.at_s)}


class _Stuck:
    def __init__(self, at_s: float) -> None:
        self.at_s = at_s
        self.volts: float | None = None

    def __call__(self, value: float, now: Now) -> float:
        if self.volts is None or now.time_s < self.at_s:
            self.volts = value
        return self.volts


@dataclass(frozen=True)
class SensorOutOfRange(Effect):
    """The flex sensor's wire breaks."""

    name = "sensor_out_of_range"
    at_s: float = number(1, "s", 0, _LATEST_S, "when")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"flex_V": lambda value, now: SUPPLY_V if now.time_s >= self.at_s else value}
