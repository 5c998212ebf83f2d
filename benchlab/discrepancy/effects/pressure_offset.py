"""pressure_offset: the sensor reads b too much.

    p = reading − b

b `offset_MPa`.
By nature confounded: with dead_pressure at pressures above it; the reading of a vented actuator tells.
"""

from __future__ import annotations

from typing import ClassVar

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.units import FloatArray


class PressureOffset(Effect):
    name: ClassVar[str] = "pressure_offset"
    acts_on: ClassVar[str] = "sensor"
    physics: ClassVar[str] = (
        "The zero of a pressure sensor drifts with temperature and mounting, or absolute and gauge pressure were "
        "mixed by a little. All that bends, fills and pushes follows the true pressure."
    )
    looks_like: ClassVar[str] = (
        "simulated curves fit when they are shifted along pressure, also near zero; at rest the angle is not that "
        "of the reading"
    )
    shown_by: ClassVar[str] = "readings while vented"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("offset_MPa", "MPa", -0.06, 0.06, 0.003, 0.0, (-0.015, -0.004, 0.004, 0.015), "reading when vented"),
    )

    def gauge(self, pressure_MPa: FloatArray, at: At) -> FloatArray:
        return pressure_MPa - at.values["offset_MPa"]
