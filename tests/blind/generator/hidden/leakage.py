"""Air is lost at the actuator: orifice after ISO 6358 or laminar tube before it, and the balance of what comes and goes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from scipy.interpolate import PchipInterpolator

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station

AIR_MPa = 0.1013
CRITICAL = 0.35


@dataclass(frozen=True)
class Leakage(Hidden):
    """size: conductance of the leak over that of the line, squared for orifices. shut_time_s: in which a shut actuator loses pressure."""

    form: str
    shut_time_s: float
    name: ClassVar[str] = "leakage"
    bounds: ClassVar[tuple[float, float]] = (1e-4, 1.0)
    typical: ClassVar[float] = 0.06

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, str(rng.choice(["orifice", "laminar"])), rng.uniform(60, 200))

    def inside(self, supplied: FloatArray, at: Station) -> FloatArray:
        p = np.linspace(0, 0.6, 400)
        came_from = PchipInterpolator(self._supply(p), p)
        found = np.asarray(came_from(np.maximum(supplied, 0)))
        found = np.broadcast_to(found, (len(found), len(at.samples))).copy()
        for i in np.flatnonzero(at.shut):
            if i:
                loss = at.step_s[i] / self.shut_time_s * self.size / self.typical
                found[i] = found[i - 1] * np.exp(-loss)
        return found

    def _supply(self, p: FloatArray) -> FloatArray:
        """Pressure at the regulator with which p stays at the actuator."""
        out = p + AIR_MPa
        if self.form == "laminar":
            return np.sqrt(out**2 + self.size * (out**2 - AIR_MPa**2)) - AIR_MPa
        leak = np.sqrt(self.size) * out * _flow(AIR_MPa / out)
        low, high = out, out * 3
        for _ in range(60):
            middle = (low + high) / 2
            enough = middle * _flow(out / middle) > leak
            low, high = np.where(enough, low, middle), np.where(enough, middle, high)
        return (low + high) / 2 - AIR_MPa


def _flow(ratio: FloatArray) -> FloatArray:
    """Mass flow over the choked one."""
    below = np.clip((ratio - CRITICAL) / (1 - CRITICAL), 0, 1)
    return np.sqrt(1 - below**2)
