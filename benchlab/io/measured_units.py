"""What a column of a table of measurements is, by its name: a quantity, its unit, and whether it is a mean or a standard deviation.

A name is words between underscores or blanks, the unit last or in brackets: `pressure_kPa`, `Angle [rad]`, `angle_sd_deg`.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchlab.actuator import DIMENSIONS
from benchlab.units import UNITS, FloatArray, known_unit, parse_column, to_mm, to_MPa, to_N, to_s

_SHARED: dict[str, Callable[[FloatArray, str], FloatArray]] = {
    "pressure": to_MPa,
    "force": to_N,
    "time": to_s,
    "length": to_mm,
}
_OWN = {
    "angle": {"deg": 1.0, "rad": 180 / np.pi},
    "volume": {"mL": 1.0, "L": 1000.0, "uL": 1e-3, "mm3": 1e-3, "cm3": 1.0},
    "voltage": {"V": 1.0, "mV": 1e-3},
    "temperature": {"C": 1.0, "K": 1.0},
}
"""Factor to deg, mL, V and °C, of what `benchlab.units` does not have."""

_SPELLINGS = {
    **dict.fromkeys(("°", "degree", "degrees"), "deg"),
    **{"ml": "mL", "µL": "uL", "mm³": "mm3", "cm³": "cm3", "cc": "cm3", "°C": "C"},
}

PHYSICAL = {
    "time": ("time", "time_s"),
    "start": ("time", "start_s"),
    "pressure": ("pressure", "pressure_MPa"),
    "command": ("pressure", "command_MPa"),
    "angle": ("angle", "angle_deg"),
    "orientation": ("angle", "orientation_deg"),
    "force": ("force", "force_N"),
    "blocked_force": ("force", "blocked_force_N"),
    "volume": ("volume", "volume_mL"),
    "flex": ("voltage", "flex_V"),
    "temperature": ("temperature", "temperature_C"),
    **{name.removesuffix("_mm"): ("length", name) for name in DIMENSIONS},
}
"""Kind and name inside benchlab of each quantity that has a unit, by its word."""

WORDS = ("design", "sample", "run", "origin", "flag")
NUMBERS = ("cycle", "run_index", "n")
"""Columns of texts, and of numbers without unit."""

_SAME = {"samples": "n", "count": "n", "std": "sd"}
_ROLES = ("mean", "sd")
_MEASURED = ("angle", "force", "volume", "flex")
"""Whose mean or standard deviation a column is that says its unit alone."""


@dataclass(frozen=True)
class Meaning:
    """name: inside benchlab, "" for a plain `mean` or `sd`. kind: of its unit, "" for texts and counts. unit: "" where none is
    written. role: "", "mean" or "sd"."""

    name: str
    kind: str = ""
    unit: str = ""
    role: str = ""

    @property
    def key(self) -> str:
        """The same for one thing, whatever the unit: `angle_deg`, `angle_deg sd`, `sd`."""
        return f"{self.name} {self.role}".strip()

    @property
    def is_word(self) -> bool:
        return self.name in WORDS


def meaning_of(text: str, passed_over: tuple[str, ...] = ("measured",)) -> Meaning | None:
    """What a column called `text` holds, None where it is nothing of ours. passed_over: words in a name that say nothing new.

    >>> meaning_of("Pressure (kPa)"), meaning_of("Theta6")
    (Meaning(name='pressure_MPa', kind='pressure', unit='kPa', role=''), None)
    >>> meaning_of("angle_sd_rad") == meaning_of("sd_rad") == Meaning("angle_deg", "angle", "rad", "sd")
    True
    """
    bare, bracketed = parse_column(text) if text.rstrip().endswith((")", "]", "}")) else (text, None)
    words = [_SAME.get(word.lower(), word) for word in re.split(r"[\s_]+", bare.strip()) if word]
    role = next((word.lower() for word in words if word.lower() in _ROLES), "")
    words = [word for word in words if word.lower() not in (*_ROLES, *passed_over)]
    if not words:
        return Meaning("", role=role) if role else None
    if (whole := "_".join(words).lower()) in PHYSICAL:
        kind, name = PHYSICAL[whole]
        return Meaning(name, kind, unit_named(bracketed) or bracketed or "", role)
    if not role and not bracketed and whole in (*WORDS, *NUMBERS):
        return Meaning(whole)
    front, unit = "_".join(words[:-1]).lower(), unit_named(words[-1])
    if role and not front and not bracketed:
        front = next((word for word in _MEASURED if unit in units_of(PHYSICAL[word][0])), "")
    if front in PHYSICAL and unit and not bracketed:
        kind, name = PHYSICAL[front]
        return Meaning(name, kind, unit, role)
    return None


def unit_named(text: str | None) -> str:
    """A unit as it is written here, "" for what is none.

    >>> unit_named("KPA"), unit_named("degrees"), unit_named("MHz")
    ('kPa', 'deg', '')
    """
    text = (text or "").strip().replace("μ", "µ")
    if found := known_unit(text):
        return found[1]
    text = _SPELLINGS.get(text, text)
    return next((unit for units in _OWN.values() for unit in units if text in (unit, unit.lower())), "")


def units_of(kind: str) -> tuple[str, ...]:
    """The units that a kind of quantity may be written in."""
    return tuple(UNITS[kind] if kind in _SHARED else _OWN[kind])


def converted(values: FloatArray, meaning: Meaning) -> FloatArray:
    """The values in the unit of benchlab, same shape.

    >>> converted(np.array([0.0, np.pi]), Meaning("angle_deg", "angle", "rad")).tolist()
    [0.0, 180.0]
    """
    if not meaning.kind:
        return values
    if meaning.kind in _SHARED:
        return _SHARED[meaning.kind](values, meaning.unit)
    scaled = values * _OWN[meaning.kind][meaning.unit]
    return scaled - 273.15 if meaning.unit == "K" else scaled
