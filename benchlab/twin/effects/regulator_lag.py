"""regulator_lag: the regulator follows what is asked for with a lag, and ignores small changes.

    τ·dp_reg/dt = e − p_reg          e: what the regulator is after
    e moves only when |p_set − e| > b, and then stays b behind (backlash); p_set = 0 opens the exhaust: e = 0

τ `lag_s`: chosen 0.03 s, so that a step is nearly done after 0.1 s, the order of electro-pneumatic regulators without load.
b `deadband_MPa`: chosen 0.0005 MPa, a thousandth of a full scale of 0.5 MPa. Neither was measured, nor are they the paper's.
The way up and the way down lie 2·b apart. Exact for a command that is held between two exchanges.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Now, Stage, number, play


@dataclass(frozen=True)
class RegulatorLag(Effect):
    """`lag_s` = 0 is a regulator without lag; `deadband_MPa` = 0 one that answers to everything."""

    name = "regulator_lag"
    lag_s: float = number(0.03, "s", 0, 10, "time constant τ of the regulator")
    deadband_MPa: float = number(0.0005, "MPa", 0, 0.02, "change b that the regulator ignores")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"supply": _Regulator(self)}


class _Regulator:
    def __init__(self, effect: RegulatorLag) -> None:
        self.effect = effect
        self.after = self.pressure = 0.0

    def __call__(self, value: float, now: Now) -> float:
        self.after = play(self.after, value, self.effect.deadband_MPa) if value > 0 else 0.0
        lag = self.effect.lag_s
        share = math.exp(-now.dt_s / lag) if lag > 0 else 0.0
        self.pressure = self.after + (self.pressure - self.after) * share
        return self.pressure
