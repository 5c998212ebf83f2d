"""What a pressure, a length, a force or a time may be written in, and how a column's name says so.

Inside benchlab: MPa, mm, N, s. Everything else is converted at the edge, by the factors below.
"""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import ArrayLike, NDArray

from benchlab.errors import InputError

FloatArray = NDArray[np.float64]

UNITS: dict[str, dict[str, float]] = {
    "pressure": {
        "MPa": 1.0,
        "kPa": 1e-3,
        "hPa": 1e-4,
        "Pa": 1e-6,
        "bar": 0.1,
        "barg": 0.1,
        "mbar": 1e-4,
        "psi": 0.006894757293168361,  # 4.4482216152605 N on (25.4 mm)²
        "psig": 0.006894757293168361,
    },
    "length": {"mm": 1.0, "cm": 10.0, "m": 1000.0, "µm": 1e-3, "in": 25.4, "ft": 304.8},
    "force": {
        **{"N": 1.0, "kN": 1000.0, "daN": 10.0, "mN": 1e-3, "kgf": 9.80665, "gf": 9.80665e-3},
        **{"lbf": 4.4482216152605, "kip": 4448.2216152605, "ozf": 0.27801385095378125},
    },
    "time": {"s": 1.0, "sec": 1.0, "ms": 1e-3, "µs": 1e-6, "min": 60.0, "hr": 3600.0},
}
"""Factor of each unit to MPa, mm, N and s, by quantity. `g` marks a gauge pressure; absolute ones are not converted."""

SPELLINGS = {
    **dict.fromkeys(("newton", "newtons", "н", "牛", "牛顿"), "N"),
    **dict.fromkeys(("кн", "千牛", "kilonewton"), "kN"),
    **dict.fromkeys(("kp", "кгс"), "kgf"),
    **dict.fromkeys(("lb", "lbs", "pounds"), "lbf"),
    **dict.fromkeys(("kips", "klbf"), "kip"),
    **dict.fromkeys(("мм", "毫米", "millimeter", "millimeters"), "mm"),
    **dict.fromkeys(("um", "micron", "microns"), "µm"),
    **dict.fromkeys(("inch", "inches", "zoll", "pulg"), "in"),
    **dict.fromkeys(
        ("second", "seconds", "secs", "sec.", "sek", "sek.", "sekunden", "seg", "segundos", "с", "秒"), "s"
    ),
    **dict.fromkeys(("msec", "毫秒"), "ms"),
    **dict.fromkeys(("us", "usec"), "µs"),
    **dict.fromkeys(("minutes", "分"), "min"),
    **dict.fromkeys(("n/mm²", "n/mm^2", "n/mm2", "мпа", "兆帕"), "MPa"),
    **dict.fromkeys(("кпа", "千帕"), "kPa"),
}
"""Other spellings, in lower case, of the units that labs write out or write in their own language."""

_BRACKETED = re.compile(r"^(?P<name>.*?)\s*[(\[{](?P<unit>[^()\[\]{}]*)[)\]}]\s*$", re.DOTALL)
_SEPARATED = re.compile(r"^(?P<name>.*?)\s*(?:[_\s/,]|\bin\b)\s*(?P<unit>[A-Za-zµμ]+)\s*$", re.DOTALL)


def known_unit(text: str) -> tuple[str, str] | None:
    """(quantity, unit as in UNITS) of a written unit; None if it is none of them.

    Upper and lower case are exchanged only where nothing else is meant by it: mPa, a thousandth of a Pa, is not MPa.

    >>> known_unit("KPA"), known_unit("mPa"), known_unit("mpa")
    (('pressure', 'kPa'), None, ('pressure', 'MPa'))
    """
    text = text.strip().replace("μ", "µ")
    for quantity, table in UNITS.items():
        if text in table:
            return quantity, text
    if text in ("mPa", "Mbar", "MBar", "MN"):
        return None
    for quantity, table in UNITS.items():
        for unit in table:
            if len(unit) > 1 and text.lower() == unit.lower():
                return quantity, unit
    spelt = SPELLINGS.get(text.lower())
    return known_unit(spelt) if spelt else None


def to_MPa(value: ArrayLike, unit: str) -> FloatArray:
    """Pressure in MPa, same shape as `value`. InputError for a unit that is not a pressure.

    >>> float(to_MPa(350.0, "kPa"))
    0.35
    """
    return _converted(value, unit, "pressure")


def to_mm(value: ArrayLike, unit: str) -> FloatArray:
    """Length in mm, same shape as `value`. InputError for a unit that is not a length.

    >>> float(to_mm(2.0, "in"))
    50.8
    """
    return _converted(value, unit, "length")


def to_N(value: ArrayLike, unit: str) -> FloatArray:
    """Force in N, same shape as `value`. InputError for a unit that is not a force.

    >>> float(to_N(2.0, "kN"))
    2000.0
    """
    return _converted(value, unit, "force")


def to_s(value: ArrayLike, unit: str) -> FloatArray:
    """Time in s, same shape as `value`. InputError for a unit that is not a time.

    >>> float(to_s(1.5, "min"))
    90.0
    """
    return _converted(value, unit, "time")


def _converted(value: ArrayLike, unit: str, quantity: str) -> FloatArray:
    found = known_unit(unit)
    if found is None or found[0] != quantity:
        raise InputError(f"{unit!r} is not a unit of {quantity}", hint=f"use one of {', '.join(UNITS[quantity])}")
    # Powers of ten below 1 are divided by, so that 350 kPa is 0.35 MPa to the last bit.
    factor = UNITS[quantity][found[1]]
    inverse = round(1 / factor)
    array = np.asarray(value, dtype=float)
    if factor == 1:
        return array
    return array / inverse if factor < 1 and np.isclose(inverse * factor, 1, rtol=1e-14) else array * factor


def parse_column(text: str) -> tuple[str, str | None]:
    """Name and unit of a column as its header cell gives them; the unit as in UNITS, as written if it is not there,
    None if there is no unit.

    Bracketed (`Pressure (kPa)`, `p [bar]`), with a stroke (`t/s`), at the end of the name (`pressure_kPa`, `Time ms`),
    or alone (`psi`). Only units of UNITS are looked for outside brackets.

    >>> parse_column("Pressure (kPa)"), parse_column("time_s"), parse_column("psi"), parse_column("Force [N]")
    (('Pressure', 'kPa'), ('time', 's'), ('', 'psi'), ('Force', 'N'))
    """
    text = text.strip()
    if bracketed := _BRACKETED.match(text):
        written = bracketed["unit"].strip()
        found = known_unit(written)
        return bracketed["name"].strip(), found[1] if found else (written or None)
    if len(text) > 1 and (alone := known_unit(text)):
        return "", alone[1]
    if (separated := _SEPARATED.match(text)) and (found := known_unit(separated["unit"])):
        return separated["name"].strip(" _/,"), found[1]
    return text, None
