"""What an effect is: parameters with unit and bounds, and what it does on the way from the recorded pressure to the recorded value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from benchlab.discrepancy.base import KNOBS
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

UNKNOWN_DESIGN = "the designs' dimensions are not known, so the base cannot tell how this piece of the structure acts"
UNKNOWN_LENGTH = "the actuators' length is not known"
"""Why effects that need a design cannot be shown."""


def without_knob(scene: Scene, knob: str) -> str:
    """Why an effect that turns a structural knob cannot be shown; empty where the base knows how its curves change with it."""
    if scene.has_knob(knob):
        return ""
    shapes = [scene.base.designs[name].shape for name in scene.names]
    return UNKNOWN_DESIGN if None in shapes else f"the simulation has no sensitivity to {knob} ({KNOBS[knob][1]})"


@dataclass(frozen=True)
class Parameter:
    """One number of an effect. neutral: at this value the effect is absent; None for a number that only shapes it (a time, an exponent).

    low, high: bounds. typical: as found in such actuators. starts: values from which fits begin, on both sides of neutral where it may be.
    """

    name: str
    unit: str
    low: float
    high: float
    typical: float
    neutral: float | None
    starts: tuple[float, ...]
    what: str


@dataclass(frozen=True)
class At:
    """Where an effect is asked: the scene, its own parameters, the form it takes.

    inside_MPa, load_MPa: (T, R), the pressures so far: inside, and that which bends.
    """

    scene: Scene
    values: Mapping[str, float]
    form: str
    inside_MPa: FloatArray
    load_MPa: FloatArray


class Effect:
    """A named piece of physics that a model may lack. Stateless: each method takes (T, R) and gives (T, R).

    The way of a prediction, in the order of the methods: the recorded pressure → `gauge` → that at the regulator → `inside` → in the
    actuator → `load` → that which bends → curves of the base with `knobs` → `angle` (true) → `camera` (as seen);
    `force` for the blocked force, `flex` from the true angle to what the flex sensor feels.

    forms: variants of the equation with the same parameters, "plain" the first; parameters are observable amounts (a width, a share),
    so that they mean the same in each form. acts_on: energy, material, design, load, time response or sensor.
    """

    name: ClassVar[str]
    acts_on: ClassVar[str]
    physics: ClassVar[str]
    """One paragraph, with source."""
    looks_like: ClassVar[str]
    shown_by: ClassVar[str]
    """The test that shows it."""
    parameters: ClassVar[tuple[Parameter, ...]]
    forms: ClassVar[tuple[str, ...]] = ("plain",)
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg", "flex_V", "volume_mL", "force_N")
    """Quantities that it changes; where none of them was measured, it cannot be shown."""
    needs: ClassVar[tuple[str, ...]] = ()
    """Curves of the base that it asks for beside those that it changes (DesignBase.curves)."""

    def cannot_show(self, scene: Scene) -> str:
        """Why data like these cannot show the effect at all (no hold, no order of runs, designs unknown …); empty where they can."""
        return ""

    def gauge(self, pressure_MPa: FloatArray, at: At) -> FloatArray:
        return pressure_MPa

    def inside(self, pressure_MPa: FloatArray, at: At) -> FloatArray:
        return pressure_MPa

    def load(self, pressure_MPa: FloatArray, at: At) -> FloatArray:
        return pressure_MPa

    def knobs(self, at: At) -> Mapping[str, FloatArray | float]:
        """Settings of structural knobs, of those in base.KNOBS."""
        return {}

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return angle_deg

    def camera(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return angle_deg

    def force(self, force_N: FloatArray, at: At) -> FloatArray:
        return force_N

    def flex(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return angle_deg


@dataclass(frozen=True)
class Active:
    """An effect with numbers: switched on in a model."""

    effect: Effect
    values: Mapping[str, float]
    form: str = "plain"

    @property
    def name(self) -> str:
        return self.effect.name
