"""A value in a unit that its key does not have: what to write in its place."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

from benchlab.units import UNITS, known_unit

_NUMBER = re.compile(r"\s*([-+]?(?:\d+[.,]?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2},\d{3}")
_MORE = {
    "angle": {"deg": 1.0, "°": 1.0, "degree": 1.0, "degrees": 1.0, "rad": 180 / math.pi, "mrad": 0.18 / math.pi},
    "frequency": {"Hz": 1.0, "kHz": 1e3, "mHz": 1e-3, "rpm": 1 / 60},
}
"""Quantities of settings that no column has, with factors to degrees and Hz."""

_PER = re.compile(r"\s*/\s*|_per_|\s+per\s+")


def in_unit_of_key(key: str, value: object, known: Iterable[str]) -> str | None:
    """`KEY: VALUE` as it has to be written, where key or value wears another unit than the known key of the same name; None where that
    is not what is wrong.

    >>> keys = ("to_MPa", "duration_s", "rate_MPa_per_s")
    >>> in_unit_of_key("to", "10 psi", keys), in_unit_of_key("to_MPa", "0,5 bar", keys)
    ('to_MPa: 0.0689', 'to_MPa: 0.05')
    >>> in_unit_of_key("to_kPa", 35, keys), in_unit_of_key("duration_s", "2 min", keys)
    ('to_MPa: 0.035', 'duration_s: 120')
    """
    parsed = _number(value)
    if parsed is None:
        return None
    number, written = parsed
    stem, own_unit = _split(key)
    for name in same_name(stem, known):
        unit = _split(name)[1]
        if name == key and not written:
            continue
        if unit is not None and (factor := _factor(written or own_unit or "", unit)) is not None:
            return f"{name}: {number * factor:.3g}" if factor != 1 else f"{name}: {number:g}"
    return None


def same_name(key: str, known: Iterable[str]) -> list[str]:
    """The known keys that are this one with another unit, or with a unit where it has none.

    >>> same_name("to", ("to_MPa", "to_deg", "times")), same_name("hold_ms", ("hold_s", "rest_s"))
    (['to_MPa', 'to_deg'], ['hold_s'])
    """
    stem = _split(key)[0].casefold()
    return [name for name in sorted(known) if (parts := _split(name))[1] is not None and parts[0].casefold() == stem]


def _number(value: object) -> tuple[float, str] | None:
    """The number and the unit behind it, if any."""
    if isinstance(value, bool):
        return None
    if isinstance(value, (int, float)):
        return float(value), ""
    if isinstance(value, str) and (found := _NUMBER.fullmatch(value)) and not _THOUSANDS.fullmatch(found[1]):
        return float(found[1].replace(",", ".")), found[2]
    return None


def _split(key: str) -> tuple[str, str | None]:
    """Stem and unit of a key: `rate_MPa_per_s` is (rate, MPa_per_s)."""
    parts = key.split("_")
    for first in range(1, len(parts)):
        if _quantity("_".join(parts[first:])) is not None:
            return "_".join(parts[:first]), "_".join(parts[first:])
    return key, None


def _factor(written: str, wanted: str) -> float | None:
    """From a unit to another of the same quantity."""
    one, other = _quantity(written), _quantity(wanted)
    return one[1] / other[1] if one and other and one[0] == other[0] else None


def _quantity(unit: str) -> tuple[tuple[str, ...], float] | None:
    """What a unit measures, and its factor to MPa, mm, N, s, degrees, Hz and their ratios."""
    found = [_simple(part) for part in _PER.split(unit)]
    if any(part is None for part in found) or len(found) > 2:
        return None
    parts = [part for part in found if part is not None]
    factor = parts[0][1] / parts[1][1] if len(parts) == 2 else parts[0][1]
    return tuple(name for name, _ in parts), factor


def _simple(unit: str) -> tuple[str, float] | None:
    for quantity, table in _MORE.items():
        if unit in table:
            return quantity, table[unit]
    if unit and (found := known_unit(unit)):
        return found[0], UNITS[found[0]][found[1]]
    return None
