"""What a twin is made from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from types import MappingProxyType
from typing import Any, TypeVar

import numpy as np

from benchlab.errors import InputError
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.effects.catalogue import DEFAULT, EFFECTS
from benchlab.twin.effects.effect import Effect

Kind = TypeVar("Kind", bound=Effect)


def default_effects() -> Mapping[str, Effect]:
    """The effects of the twin that comes with benchlab, with their typical values (chosen, not measured)."""
    return MappingProxyType({name: EFFECTS[name]() for name in DEFAULT})


@dataclass(frozen=True)
class Camera:
    """The twin's camera. frames_per_s; picture in pixels; markers: on the actuator, from end to end, evenly spaced."""

    frames_per_s: float = 30.0
    width_px: int = 1280
    height_px: int = 720
    markers: int = 10

    def __post_init__(self) -> None:
        demands = {
            "frames_per_s from 1 to 1000": 1 <= self.frames_per_s <= 1000,
            "width_px and height_px from 320 to 4096, both even": all(
                320 <= side <= 4096 and side % 2 == 0 for side in (self.width_px, self.height_px)
            ),
            "markers from 3 to 30": 3 <= self.markers <= 30,
        }
        for demand, met in demands.items():
            if not met:
                raise InputError(f"a twin's camera needs {demand}")


@dataclass(frozen=True)
class TwinSettings:
    """Response curve, effects by name, seed of the noise, design in words, length of the actuator (mm), camera.

    effects: those that are on; faults are on only where they stand here. own_curve: whether its file says which curve, so that what
    somebody believes of the actuator does not take its place.
    """

    curve: ResponseCurve
    effects: Mapping[str, Effect] = field(default_factory=default_effects)
    seed: int = 1
    design: str = ""
    length_mm: float = 180.0
    camera: Camera = Camera()
    own_curve: bool = False

    def __post_init__(self) -> None:
        if not 0 <= self.seed < 2**63:
            raise InputError(f"a twin's seed is {self.seed}", hint="give a whole number from 0")
        if not 1 <= self.length_mm <= 10_000:
            raise InputError(f"a twin's length_mm is {self.length_mm:g}", hint="give 1 to 10000 mm")

    def effect(self, kind: type[Kind]) -> Kind | None:
        """The effect of this kind, None where it is off."""
        found = self.effects.get(kind.name)
        return found if isinstance(found, kind) else None

    def with_curve(
        self, pressure_MPa: Any, angle_deg: Any, volume_mL: Any = None, source: str = "given"
    ) -> TwinSettings:
        """The same twin with another curve, (P,) each, from 0 MPa. Without volumes, the line fills those of the curve that it had."""
        pressure, angle = np.asarray(pressure_MPa, dtype=float), np.asarray(angle_deg, dtype=float)
        volume = np.interp(pressure, self.curve.pressure_MPa, self.curve.volume_mL) if volume_mL is None else volume_mL
        curve = ResponseCurve(pressure, angle, np.asarray(volume, dtype=float), np.ones_like(pressure), source)
        return replace(self, curve=curve, design=source)

    def as_json(self) -> dict[str, Any]:
        """All of it, in JSON's own types."""
        columns = ("pressure_MPa", "angle_deg", "volume_mL", "axial_stretch")
        return {
            "design": self.design,
            "length_mm": self.length_mm,
            "curve": {"source": self.curve.source, **{name: getattr(self.curve, name).tolist() for name in columns}},
            "effects": {name: asdict(effect) for name, effect in self.effects.items()},
            "seed": self.seed,
            "camera": asdict(self.camera),
        }
