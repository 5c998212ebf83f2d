"""The tube chokes the flow: what flows is a power of the pressure drop, what it fills is the actuator's dV/dp there."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from scipy.interpolate import PchipInterpolator

from tests.blind.generator.hidden.friction import by_history
from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.solved import base
from tests.blind.generator.station import FloatArray, Station


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
        found = np.empty((len(supplied), len(at.samples)))
        source = np.broadcast_to(supplied, found.shape)
        for (tw, slw, length), columns in at.designs().items():
            cell = base(tw, slw)
            filled = PchipInterpolator(cell.pressure_MPa, cell.volume_mm2[0] * length / 1000)
            at_grid = np.clip(np.arange(0, 0.451, 0.001), cell.pressure_MPa[0], cell.pressure_MPa[-1])
            capacity = filled.derivative()(at_grid).tolist()
            fill = functools.partial(self._one, capacity, at.step_s.tolist())
            found[:, columns] = by_history(source[:, columns], fill)
        return found

    def _one(self, capacity: list[float], steps_s: list[float], source: list[float]) -> list[float]:
        """The pressure inside, from step to step by the time constant that capacity and drop have at its beginning."""
        now, before, found = source[0], source[0], []
        for target, step in zip(source, steps_s):
            parts = max(1, math.ceil(step / 0.025))
            for part in range(1, parts + 1):
                goal = before + (target - before) * part / parts
                drop = abs(goal - now) + 1e-5
                time = self.size * capacity[min(max(int(now * 1000), 0), 450)] * (drop / 0.02) ** (1 - self.power)
                now = goal + (now - goal) * math.exp(-step / parts / time)
            before = target
            found.append(now)
        return found
