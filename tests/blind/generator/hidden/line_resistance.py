"""The tube chokes the flow: what flows is a power of the pressure drop, what it fills is the actuator's dV/dp there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station

from scipy.interpolate import PchipInterpolator

from tests.blind.generator.solved import base


@dataclass(frozen=True)
class LineResistance(Hidden):
    """size: seconds·MPa/mL at a drop of 0.02 MPa. power: flow over drop, 1 laminar, 0.5 turbulent."""

    power: float
    name: ClassVar[str] = "line_resistance"
    bounds: ClassVar[tuple[float, float]] = (1e-5, 0.5)
    typical: ClassVar[float] = 0.006

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, rng.uniform(0.7, 1.0))

    def inside(self, supplied: FloatArray, at: Station) -> FloatArray:
        grid = np.linspace(0, 0.45, 451)
        capacity = np.empty((len(grid), len(at.samples)))
        for (tw, slw, length), columns in at.designs().items():
            cell = base(tw, slw)
            filled = PchipInterpolator(cell.pressure_MPa, cell.volume_mm2[0] * length / 1000)
            p = np.clip(grid, cell.pressure_MPa[0], cell.pressure_MPa[-1])
            capacity[:, columns] = filled.derivative()(p)[:, None]
        everyone = np.arange(capacity.shape[1])
        source = np.broadcast_to(supplied, (len(supplied), capacity.shape[1]))
        found = np.empty(source.shape)
        found[0] = now = source[0].copy()
        steps = 3
        for i in range(1, len(found)):
            for part in range(1, steps + 1):
                target = source[i - 1] + (source[i] - source[i - 1]) * part / steps
                here = np.clip((now * 1000).astype(int), 0, 450)
                drop = np.abs(target - now) + 1e-5
                time = self.size * capacity[here, everyone] * (drop / 0.02) ** (1 - self.power)
                now = target + (now - target) * np.exp(-at.step_s[i] / steps / time)
            found[i] = now
        return found
