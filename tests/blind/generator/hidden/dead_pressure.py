"""Nothing bends until some pressure is passed: a kink, a softplus or a root."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class DeadPressure(Hidden):
    """size: p0, MPa. form: kink max(p − p0, 0); softplus of width p0/5; root sqrt(p² + p0²) − p0, which comes to p − p0."""

    form: str
    name: ClassVar[str] = "dead_pressure"
    bounds: ClassVar[tuple[float, float]] = (1e-4, 0.12)
    typical: ClassVar[float] = 0.008

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, str(rng.choice(["kink", "softplus", "root"])))

    @property
    def same_form(self) -> bool:
        return self.form == "kink"

    def parameters(self) -> dict[str, Any]:
        return {"dead_pressure_MPa": self.size, "form": self.form}

    def effective(self, inside: FloatArray, at: Station) -> FloatArray:
        p = np.maximum(inside, 0)
        if self.form == "kink":
            return np.maximum(p - self.size, 0)
        if self.form == "softplus":
            width = self.size / 5
            return width * (np.logaddexp(0, (p - self.size) / width) - np.logaddexp(0, -self.size / width))
        return np.sqrt(p**2 + self.size**2) - self.size
