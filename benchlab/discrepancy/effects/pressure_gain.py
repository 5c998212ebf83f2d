"""pressure_gain: the sensor reads a times the pressure.

    p = reading/a

a `gain`.
By nature confounded: with leakage in its plain form while the pressure moves; a reference gauge at full pressure
tells.
"""

from __future__ import annotations

from typing import ClassVar

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.units import FloatArray


class PressureGain(Effect):
    name: ClassVar[str] = "pressure_gain"
    acts_on: ClassVar[str] = "sensor"
    physics: ClassVar[str] = (
        "The slope of a pressure sensor, its amplifier or its calibration is off: a few percent where it was never "
        "checked. All that bends, fills and pushes follows the true pressure."
    )
    looks_like: ClassVar[str] = (
        "simulated curves fit when they are stretched along pressure, by one factor for all designs"
    )
    shown_by: ClassVar[str] = "a reference gauge at two pressures"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("gain", "", 0.75, 1.3, 1.02, 1.0, (0.9, 0.97, 1.03, 1.1), "reading over pressure"),
    )

    def gauge(self, pressure_MPa: FloatArray, at: At) -> FloatArray:
        return pressure_MPa / at.values["gain"]
