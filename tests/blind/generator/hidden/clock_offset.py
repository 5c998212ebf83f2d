"""The camera's clock is ahead: an angle stamped t shows the truth at t − Δt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.hidden.hidden import Hidden


@dataclass(frozen=True)
class ClockOffset(Hidden):
    """size: |Δt| in s; behind: Δt is negative."""

    behind: bool
    name: ClassVar[str] = "clock_offset"
    bounds: ClassVar[tuple[float, float]] = (1e-3, 2.0)
    typical: ClassVar[float] = 0.08

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        return cls(cls.typical, bool(rng.integers(2)))

    @property
    def same_form(self) -> bool:
        return True

    @property
    def ahead_s(self) -> float:
        return -self.size if self.behind else self.size

    def parameters(self) -> dict[str, Any]:
        return {"offset_s": self.ahead_s}
