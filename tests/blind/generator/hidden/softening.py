"""The first loading is stiffer: softening along the loading path, or after Ogden and Roxburgh (1999) from the largest energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from scipy.special import erf

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station

REFERENCE_MPa = 0.35


@dataclass(frozen=True)
class Softening(Hidden):
    """size: by what part the same pressure acts stronger when all has softened.

    form: path (softens exponentially with the loading gone through, half of it in about `cycles` cycles to 0.35 MPa) or ogden-roxburgh
    (energy below the largest seen, over `width` of that at 0.35 MPa). worn: the simulated curve is that of the softened actuator;
    otherwise of the new one.
    """

    form: str
    cycles: float
    width: float
    worn: bool
    name: ClassVar[str] = "softening"
    bounds: ClassVar[tuple[float, float]] = (1e-4, 0.6)
    typical: ClassVar[float] = 0.08

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        form = str(rng.choice(["path", "ogden-roxburgh"]))
        return cls(
            cls.typical, form, rng.uniform(0.6, 2.0), rng.uniform(0.15, 0.5), form == "path" and bool(rng.integers(2))
        )

    def effective(self, inside: FloatArray, at: Station) -> FloatArray:
        return self._path(inside, at) if self.form == "path" else self._ogden_roxburgh(inside, at)

    def _path(self, inside: FloatArray, at: Station) -> FloatArray:
        new = at.memory.get(self.name, np.ones(inside.shape[1]))  # what has not softened yet
        rising = np.maximum(np.diff(inside, axis=0, prepend=inside[:1]), 0)
        gone = np.cumsum(2 * np.maximum(inside, 0) * rising, axis=0) / REFERENCE_MPa**2
        left = new * np.exp(-np.log(2) * gone / self.cycles)
        at.memory[self.name] = left[-1]
        return np.asarray(inside * (1 - self.size * left if self.worn else 1 + self.size * (1 - left)))

    def _ogden_roxburgh(self, inside: FloatArray, at: Station) -> FloatArray:
        energy = (np.maximum(inside, 0) / REFERENCE_MPa) ** 2
        largest = np.maximum(np.maximum.accumulate(energy, axis=0), at.memory.get(self.name, 0.0))
        at.memory[self.name] = largest[-1]
        return np.asarray(inside / (1 - self.size / (1 + self.size) * erf((largest - energy) / self.width)))
