"""Rigid ends do not bend."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class EndCaps(Hidden):
    """size: rigid length at each end, mm, for whatever length of actuator."""

    name: ClassVar[str] = "end_caps"
    bounds: ClassVar[tuple[float, float]] = (1e-2, 40.0)
    typical: ClassVar[float] = 4.0

    @property
    def same_form(self) -> bool:
        return True

    def parameters(self) -> dict[str, Any]:
        return {"cap_mm": self.size}

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        return angle * (1 - 2 * self.size / at.length_mm)
