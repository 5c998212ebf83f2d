"""The response curve of an actuator: bending angle and volume at rest against the pressure inside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchlab.errors import InputError
from benchlab.units import FloatArray


@dataclass(frozen=True)
class ResponseCurve:
    """(P,) each: pressure_MPa, strictly increasing from 0; angle_deg; volume_mL, not falling; axial_stretch of the strip's line.

    source: what the curve is of and where it is from, in words. Raises InputError for a curve that no twin can follow.
    """

    pressure_MPa: FloatArray
    angle_deg: FloatArray
    volume_mL: FloatArray
    axial_stretch: FloatArray
    source: str

    def __post_init__(self) -> None:
        pressure = self.pressure_MPa
        columns = (pressure, self.angle_deg, self.volume_mL, self.axial_stretch)
        demands = {
            "two pressures at least": len(pressure) >= 2,
            "as many angles, volumes and stretches as pressures": len({len(column) for column in columns}) == 1,
            "finite values": all(bool(np.isfinite(column).all()) for column in columns),
            "pressures that begin at 0 MPa and grow": len(pressure) > 0
            and pressure[0] == 0
            and bool((np.diff(pressure) > 0).all()),
            "a volume that does not fall": bool((np.diff(self.volume_mL) >= 0).all()),
        }
        for demand, met in demands.items():
            if not met:
                hint = "make it with `benchlab simulate --pressure-MPa 0:0.35:0.01`"
                raise InputError(f"a twin's response curve needs {demand}", where=self.source, hint=hint)

    @property
    def last_MPa(self) -> float:
        """The largest pressure that the curve knows."""
        return float(self.pressure_MPa[-1])
