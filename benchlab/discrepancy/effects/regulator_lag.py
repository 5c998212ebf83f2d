"""regulator_lag: the pressure inside comes a time τ after what is asked for, alike for all designs.

    τ·dx/dt = c − x          p_inside = p − (c − x)          (plain)

τ `lag_s`; c: the command where it is known for a whole run, else the recorded pressure p. What lags behind the
command is taken off the recorded pressure, so that without a lag the recorded pressure is that inside, and its noise
is not filtered. Forms: `second order`: two lags in a row, of 2τ/3 and τ/3; `delay`: x(t) = c(t − τ). In a ramp all of
them are τ behind.
By nature confounded: with clock_offset (the form `delay` wholly, in the angle; volume and force tell them apart) and
with line_resistance where the designs' dV/dp are alike.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


class RegulatorLag(Effect):
    name: ClassVar[str] = "regulator_lag"
    acts_on: ClassVar[str] = "time response"
    physics: ClassVar[str] = (
        "A pressure regulator fills its outlet through a valve that it opens in proportion to the error, so that "
        "its outlet follows as a first-order lag for small steps; its own dynamics add a second. Datasheets of "
        "electro-pneumatic regulators give some tenths of a second to full scale (typical value chosen)."
    )
    looks_like: ClassVar[str] = (
        "a loop that widens with the rate, by the same pressure τ·dp/dt for all designs; nothing in a hold but its "
        "first moments"
    )
    shown_by: ClassVar[str] = "triangles at two rates, ten times apart, on two designs"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("lag_s", "s", 0.0, 3.0, 0.1, 0.0, (0.03, 0.1, 0.3, 1.0), "time by which the pressure inside is late"),
    )
    forms: ClassVar[tuple[str, ...]] = ("plain", "second order", "delay")

    def cannot_show(self, scene: Scene) -> str:
        return scene.shows_time

    def inside(self, pressure_MPa: FloatArray, at: At) -> FloatArray:
        lag, command = at.values["lag_s"], at.scene.command_MPa
        if lag == 0:
            return pressure_MPa
        asked = np.where(np.isfinite(command).all(axis=0), command, pressure_MPa)
        return pressure_MPa - (asked - _late(asked, lag, at))


def _late(asked_MPa: FloatArray, lag_s: float, at: At) -> FloatArray:
    if at.form == "delay":
        return at.scene.delayed(asked_MPa, lag_s)
    if at.form == "second order":
        return 2 * at.scene.follow(asked_MPa, 2 * lag_s / 3) - at.scene.follow(asked_MPa, lag_s / 3)
    return at.scene.follow(asked_MPa, lag_s)
