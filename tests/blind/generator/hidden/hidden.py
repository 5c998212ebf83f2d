"""What an effect may do to a measurement, from the command to the reading. Everything it does not do stays as it is."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from tests.blind.generator.solved import Family
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class Hidden:
    """An effect of some size. Arrays are (T, S): times of a run, samples; pressures in MPa, angles in degrees, forces in N.

    size: how strong, in the effect's own unit, within `bounds`; `typical` is where the search for it begins.
    by_sample: samples of one design differ in it, by their time in the session or the way they are mounted.
    """

    size: float
    name: ClassVar[str]
    bounds: ClassVar[tuple[float, float]]
    typical: ClassVar[float]
    known: ClassVar[bool] = True
    quantity: ClassVar[str] = "angle_deg"
    by_sample: ClassVar[bool] = False

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        """A form of the effect, at its typical size."""
        return cls(cls.typical)

    def sized(self, size: float) -> Self:
        return replace(self, size=float(size))

    @property
    def same_form(self) -> bool:
        """Whether the truth is the textbook's one-parameter form, so that an interval for the parameter can be held against it."""
        return False

    def parameters(self) -> dict[str, Any]:
        """What is true, by names with units."""
        return {name: value for name, value in vars(self).items() if name != "size"} | {"size": self.size}

    def supplied(self, recorded: FloatArray, at: Station) -> FloatArray:
        """Pressure at the regulator's outlet, from what its own sensor makes it deliver."""
        return recorded

    def recorded(self, supplied: FloatArray, at: Station) -> FloatArray:
        """What the sensor says of the pressure at the outlet."""
        return supplied

    def inside(self, supplied: FloatArray, at: Station) -> FloatArray:
        """Pressure in the bladder."""
        return supplied

    def effective(self, inside: FloatArray, at: Station) -> FloatArray:
        """The pressure at which the cell as simulated would bend (or press) as this one does."""
        return inside

    def family(self, tw_mm: float, slw_mm: float) -> tuple[Family, float] | None:
        """Curves of a changed cell, and the value of the change."""
        return None

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        return angle

    def pressed(self, force: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        return force

    def seen(self, angle: FloatArray, at: Station) -> FloatArray:
        """The angle that comes out of the camera's picture."""
        return angle

    @property
    def ahead_s(self) -> float:
        """By how much the camera's stamps are later than the pressure's for the same moment."""
        return 0.0
