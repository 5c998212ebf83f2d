"""The film gets warmer and softer in the course of a session: the cell is solved with softer and stiffer film."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from scipy.interpolate import RectBivariateSpline

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.solved import curve_deg, family
from tests.blind.generator.station import FloatArray, Station

NOMINAL_C = 23.0


@dataclass(frozen=True)
class Temperature(Hidden):
    """size: part of the film's modulus lost per K above 23 °C, exponentially."""

    name: ClassVar[str] = "temperature"
    bounds: ClassVar[tuple[float, float]] = (1e-5, 0.06)
    typical: ClassVar[float] = 0.008
    by_sample: ClassVar[bool] = True

    def parameters(self) -> dict[str, Any]:
        return {"loss_per_K": self.size}

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        found = angle.copy()
        modulus = np.clip(np.exp(-self.size * (at.temperature_C - NOMINAL_C)), 0.75, 1.18)
        for (tw, slw, length), columns in at.designs().items():
            cells = family("film_modulus_scale", tw, slw)
            p = np.linspace(0, 0.42, 85)
            curves = np.array([curve_deg(cells.pressure_MPa, a, length)(p) for a in cells.angle_rad_per_mm])
            change = RectBivariateSpline(cells.values, p, curves - curves[cells.values == 1.0], kx=3, ky=1)
            found[:, columns] += change.ev(modulus[:, columns], np.clip(effective[:, columns], 0, 0.42))
        return found
