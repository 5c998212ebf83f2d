"""The actuator hangs, stands or lies: its weight is integrated along the arc against the bending stiffness of the cell."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import PchipInterpolator

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.solved import base
from tests.blind.generator.station import FloatArray, Station

NEWTON_PER_GRAM = 9.81e-3
NODES = 41


@dataclass(frozen=True)
class Gravity(Hidden):
    """size: mass in g of 180 mm of actuator.

    orientation_deg: of the base's axis from straight down, turned towards the bending side; 0 hangs, 90 lies and bends upwards, 180 stands.
    Bending stiffness: straight-held moment over free curvature, at each pressure.
    """

    name: ClassVar[str] = "gravity"
    bounds: ClassVar[tuple[float, float]] = (0.1, 150.0)
    typical: ClassVar[float] = 15.0
    by_sample: ClassVar[bool] = True

    def parameters(self) -> dict[str, Any]:
        return {"mass_g": self.size}

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        found = angle.copy()
        for (tw, slw, length), columns in at.designs().items():
            cell = base(tw, slw)
            for orientation in np.unique(at.orientation_deg[columns]):
                here = columns[at.orientation_deg[columns] == orientation]
                change = _change_deg(tw, slw, length, float(orientation), self.size)
                change_at = PchipInterpolator(np.r_[0.0, cell.pressure_MPa], np.r_[0.0, change])
                found[:, here] += change_at(np.clip(effective[:, here], 0, cell.pressure_MPa[-1]))
        return found


@functools.lru_cache(maxsize=64)
def _change_deg(tw: float, slw: float, length: float, orientation: float, mass_g: float) -> FloatArray:
    """(P,): by what the weight changes the angle. A damped fixed point of the curvature along the arc."""
    cell = base(tw, slw)
    free = cell.angle_rad_per_mm[0][:, None]
    stiffness = cell.moment_Nmm[0][:, None] / free
    s = np.linspace(0, length, NODES)
    weight = mass_g * NEWTON_PER_GRAM / 180
    sums = cumulative_trapezoid(np.eye(NODES), s, axis=0, initial=0).T  # values (P, N) @ sums: integral from the base
    kappa = np.repeat(free, NODES, axis=1)
    for _ in range(200):
        aside = np.sin(np.radians(orientation) + kappa @ sums) @ sums
        whole = aside @ sums
        moment = weight * (whole[:, -1:] - whole - aside * (length - s))
        step = 0.4 * (free - moment / stiffness - kappa)
        kappa += step
        if np.abs(step).max() * length < 1e-9:
            break
    return np.degrees((kappa - free) @ sums[:, -1])
