"""What an effect is: parameters with unit, typical value and bounds, and what it does to a value on its way through the bench."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar

from benchlab.errors import InputError
from benchlab.twin.curve import ResponseCurve


class Now:
    """The step that is being taken. dt_s: its length. time_s: its end, since_s: since the first exchange of the run.

    pressure_MPa: inside the actuator. shut: no air comes.
    """

    __slots__ = ("dt_s", "pressure_MPa", "shut", "since_s", "time_s")

    def __init__(self) -> None:
        self.dt_s = 0.0
        self.time_s = self.since_s = 0.0
        self.pressure_MPa = 0.0
        self.shut = False


Stage = Callable[[float, Now], float]
"""Takes a value in and gives the value out at the end of the step; keeps its own state."""

PLACES = {
    "supply": "MPa, from what is asked for to what the regulator gives",
    "line": "MPa, from the regulator to the inside of the actuator",
    "bend": "MPa, from the pressure inside to the one at which the response curve is read",
    "angle": "deg, from the response curve to the true bending angle",
    "monitor": "MPa, from the regulator to its monitor output",
    "monitor_V": "V, of the monitor output, as the microcontroller reads it",
    "flex": "deg, from the true angle to what the flex sensor feels",
    "flex_V": "V, of the flex sensor's divider, as the microcontroller reads it",
    "camera": "deg, from the true angle to the angle of the arc that the markers form",
}
"""Where on its way through the bench a value can be changed."""


@dataclass(frozen=True)
class Kit:
    """What effects may be made from: the response curve, the actuator's length, the seed."""

    curve: ResponseCurve
    length_mm: float
    seed: int


def number(typical: float, unit: str, low: float, high: float, what: str) -> Any:
    """A parameter of an effect: typical value, unit, smallest and largest allowed value, what it means."""
    return field(default=typical, metadata={"unit": unit, "low": low, "high": high, "what": what})


@dataclass(frozen=True)
class Effect:
    """A named piece of physics with its parameters. Raises InputError for a parameter out of its bounds."""

    name: ClassVar[str] = ""

    def __post_init__(self) -> None:
        for each in fields(self):
            value, low, high = getattr(self, each.name), each.metadata["low"], each.metadata["high"]
            if not (math.isfinite(value) and low <= value <= high):
                what = f"{each.name} is {value:g}, outside {low:g} to {high:g} {each.metadata['unit']}".rstrip()
                raise InputError(what, where=f"effect {self.name}", hint="give a value between the two")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        """What it does, by place (PLACES), beginning at rest; a new state each time. Nothing where it is asked for by name elsewhere."""
        return {}


def follow(start: float, from_value: float, to_value: float, dt_s: float, time_constant_s: float) -> float:
    """A first-order lag after dt_s, exactly, for an input that goes straight from one value to the other meanwhile.

    τ·y' = v − y, v = v0 + s·t  →  y1 = v1 − s·τ + (y0 − v0 + s·τ)·exp(−dt/τ).

    >>> round(follow(0.0, 1.0, 1.0, 1.0, 1.0), 6)  # 1 − 1/e
    0.632121
    """
    if dt_s == 0:
        return start
    if time_constant_s < 1e-9:
        return to_value
    ramp = (to_value - from_value) / dt_s * time_constant_s
    return to_value - ramp + (start - from_value + ramp) * math.exp(-dt_s / time_constant_s)


def play(last: float, value: float, half_width: float) -> float:
    """Backlash: stays where it is until the value is half a width away, then is dragged along at that distance."""
    if last > value + half_width:
        return value + half_width
    return max(last, value - half_width)
