"""dead_pressure: nothing bends until the slack is out.

    p → s(p − q) − s(−q), s(x) = (x + √(x² + (q/2)²))/2          (plain)

p0 `dead_MPa`: what is missing of the pressure far above it; q = p0/1.0590, so that it is p0 in the plain form too.
Forms: `hard`: max(p − p0, 0); `gradual`: p − p0·(1 − exp(−p/p0)). Pressures below 0 pass as they are.
By nature confounded: with pressure_offset above p0; readings near zero pressure tell them apart.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.units import FloatArray

LATE = 1 + (np.sqrt(1.25) - 1) / 2
"""What the plain form takes off far above q, over q."""


class DeadPressure(Effect):
    name: ClassVar[str] = "dead_pressure"
    acts_on: ClassVar[str] = "load"
    physics: ClassVar[str] = (
        "The folded shell and the oversized bladder must unfold, and creases open, before the walls carry load: "
        "the paper sees the volume rise fast up to about 0.015 MPa. Pressure up to there bends nothing, and what "
        "bends is what is above it."
    )
    looks_like: ClassVar[str] = "the curve starts late and then runs beside the simulated one, shifted along pressure"
    shown_by: ClassVar[str] = "a slow ramp with many readings below 0.05 MPa"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("dead_MPa", "MPa", 0.0, 0.1, 0.01, 0.0, (0.002, 0.006, 0.015, 0.03), "pressure that bends nothing"),
    )
    forms: ClassVar[tuple[str, ...]] = ("plain", "hard", "gradual")

    def load(self, pressure_MPa: FloatArray, at: At) -> FloatArray:
        dead, above = at.values["dead_MPa"], np.maximum(pressure_MPa, 0.0)
        below = pressure_MPa - above
        if dead == 0:
            return pressure_MPa
        if at.form == "hard":
            return below + np.maximum(above - dead, 0.0)
        if at.form == "gradual":
            return below + above + dead * np.expm1(-above / dead)
        at_zero = dead / LATE
        return below + _bent(above - at_zero, at_zero / 2) - _bent(-at_zero, at_zero / 2)


def _bent(x: FloatArray | float, width: float) -> FloatArray:
    return np.asarray((x + np.sqrt(np.square(x) + width**2)) / 2)
