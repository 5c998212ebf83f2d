"""The actuator hangs, stands or lies: its weight is integrated along the arc against the bending stiffness of the cell."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station

from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import PchipInterpolator

from tests.blind.generator.solved import base

NEWTON_PER_GRAM = 9.81e-3


@dataclass(frozen=True)
class Gravity(Hidden):
    """size: mass in g of 180 mm of actuator.

    orientation_deg: of the base's axis from straight down, turned towards the bending side; 0 hangs, 90 lies and bends upwards, 180 stands.
    Bending stiffness: straight-held moment over free curvature, at each pressure.
    """

    name: ClassVar[str] = "gravity"
    bounds: ClassVar[tuple[float, float]] = (0.1, 150.0)
    typical: ClassVar[float] = 15.0

    def parameters(self) -> dict[str, Any]:
        return {"mass_g": self.size}

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        found = angle.copy()
        for (tw, slw, length), columns in at.designs().items():
            cell = base(tw, slw)
            for orientation in np.unique(at.orientation_deg[columns]):
                here = columns[at.orientation_deg[columns] == orientation]
                change = self._change_deg(cell.angle_rad_per_mm[0], cell.moment_Nmm[0], length, float(orientation))
                change_at = PchipInterpolator(np.r_[0.0, cell.pressure_MPa], np.r_[0.0, change])
                found[:, here] += change_at(np.clip(effective[:, here], 0, cell.pressure_MPa[-1]))
        return found

    def _change_deg(self, free: FloatArray, moment: FloatArray, length: float, orientation: float) -> FloatArray:
        """(P,): by what the weight changes the angle. Marched to rest by a damped fixed point."""
        s = np.linspace(0, length, 41)
        weight = self.size * NEWTON_PER_GRAM / 180
        stiffness = (moment / free)[:, None]
        kappa = np.repeat(free[:, None], len(s), axis=1)
        for _ in range(60):
            attitude = np.radians(orientation) + cumulative_trapezoid(kappa, s, axis=1, initial=0)
            aside = cumulative_trapezoid(np.sin(attitude), s, axis=1, initial=0)
            beyond = cumulative_trapezoid(aside[:, ::-1], s, axis=1, initial=0)[:, ::-1]
            kappa += 0.4 * (free[:, None] - weight * (beyond - aside * (length - s)) / stiffness - kappa)
        return np.degrees(np.trapezoid(kappa - free[:, None], s, axis=1))
