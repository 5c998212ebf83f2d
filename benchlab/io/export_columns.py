"""Which column of an export holds what: by its name, in the languages of the labs, and by its unit; never by its place."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from benchlab.errors import InputError, UsageError, printable
from benchlab.io.export_words import COLUMN_WORDS
from benchlab.units import UNITS, known_unit, parse_column

KEYS = {
    "time": "time_s",
    "extension": "extension_mm",
    "force": "force_N",
    "pressure": "pressure_MPa",
    "cycle": "cycle",
    "segment": "segment",
}
"""Name of each quantity's column in the normalised table."""

_PHYSICAL = {"time": "time", "extension": "length", "force": "force", "pressure": "pressure"}
_OTHER_UNITS = re.compile(
    r"%|-|°c?|[vajw]|[a-zµ]+/[a-zµ]+(\^?[23]|[²³])?|(mm|cm|m|in)(\^?[23]|[²³])|n·?m|hz|count|ratio", re.IGNORECASE
)
_ASSUMED = {"time": "s", "extension": "mm"}
_DERIVED = re.compile(r"(corrected|true|tensile|compressive|flexure|axial|(cycle )?elapsed)\b", re.IGNORECASE)
"""Where a file has a column of a plain name, as Displacement, those that are derived from it are called so."""

_BRACKETS = re.compile(r"(?<=\w)\s*\(.*\)$")
_WORDS = {word: quantity for quantity, words in COLUMN_WORDS.items() for word in words}
NO_NAMES = "columns without names or units"
REMEDY = "name the columns by place, as --columns time_s,extension_mm,force_N with - for those that are not used"


@dataclass(frozen=True)
class Chosen:
    """A column that holds a quantity, its unit as in UNITS ("" for counts), and what the file calls it."""

    index: int
    quantity: str
    unit: str
    label: str
    assumed: bool = False
    """Whether the unit is not from the file."""


def split_name(name: str, unit: str = "") -> tuple[str, str]:
    """Name and unit of a column from its header cell and the cell of a row of units.

    >>> split_name("Load (kN)"), split_name("Zeit", "sec"), split_name("Strain [%]")
    (('Load', 'kN'), ('Zeit', 'sec'), ('Strain', '%'))
    """
    if unit:
        return name, unit
    parsed, found = parse_column(name)
    return parsed, found or ""


def quantity_named(name: str) -> str | None:
    """The quantity that a name stands for, a number behind it put aside; None if it is not one of ours.

    >>> quantity_named("Load 1"), quantity_named("Obciążenie"), quantity_named("Maximum Force")
    ('force', 'force', None)
    """
    low = re.sub(r"[\s_]+", " ", _BRACKETS.sub("", name)).strip(" :.#%").lower()
    return _WORDS.get(low) or _WORDS.get(re.sub(r"\s*(ch\s*)?\d+$", "", low))


def known_words(cells: Sequence[str]) -> int:
    """How many cells of a header name a quantity, or give a unit of one."""
    parsed = [parse_column(cell) for cell in cells if cell]
    return sum(bool(quantity_named(name) or (unit and known_unit(unit))) for name, unit in parsed)


def column_unit(text: str) -> bool:
    """Whether a text is a unit that a column may have."""
    return bool(known_unit(text) or _OTHER_UNITS.fullmatch(text.strip()))


def find_columns(
    path: Path,
    line: int | None,
    names: Sequence[str],
    units: Sequence[str],
    empty: Sequence[bool],
    force_unit: str | None = None,
) -> tuple[Chosen, ...]:
    """The columns of a header. empty: columns without a cell, which are passed over.

    Raises UsageError where two could be the same quantity, where there is no force, or no unit of one; InputError for two units.
    """
    where = f"line {line}" if line else None
    named: dict[str, list[Chosen]] = {}
    measured: dict[str, list[Chosen]] = {}
    for index, (name, unit) in enumerate(map(split_name, names, units)):
        if (found := None if empty[index] else _meaning(name, unit)) is not None:
            quantity, known, by_name = found
            _check_one_unit(path, where, name, unit)
            column = Chosen(index, quantity, known, f"{name} ({unit})" if unit else name)
            (named if by_name else measured).setdefault(quantity, []).append(column)
    _check_there(path, where, {*named, *measured}, names, units, empty)
    chosen = []
    for quantity in sorted(named | measured, key="force".__ne__):
        columns = named.get(quantity) or measured[quantity]
        if quantity != "force" and quantity not in named and len(columns) > 1:
            continue  # several lengths or times without a name: none of them
        columns = [c for c in columns if not _DERIVED.match(c.label)] or columns
        if len(columns) > 1:
            listed = " and ".join(repr(printable(c.label)) for c in columns)
            what = f"{len(columns)} columns that could be the {quantity}: {listed}"
            raise UsageError(what, file=path, where=where, hint=REMEDY)
        chosen.append(_with_unit(path, where, columns[0], force_unit))
    return tuple(sorted(chosen, key=lambda c: list(COLUMN_WORDS).index(c.quantity)))


def _check_one_unit(path: Path, where: str | None, name: str, unit: str) -> None:
    """Raises InputError for a name with another unit in brackets than that of the column."""
    bare, written = parse_column(name) if name.endswith((")", "]")) else (name, None)
    inside, outside = known_unit(written or ""), known_unit(unit)
    if inside and outside and inside != outside:
        what = f"column {printable(bare)!r} is in {inside[1]} by its name and in {outside[1]} by the row of units"
        raise InputError(what, file=path, where=where, hint="remove one of them, or name the columns with --columns")


def _meaning(name: str, unit: str) -> tuple[str, str, bool] | None:
    """(quantity, unit as in UNITS, whether the name says it) of a column; None if it is none of ours."""
    quantity, known = quantity_named(name), known_unit(unit) or known_unit(unit.lower())
    if quantity == "pressure" and known and known[0] == "force":
        quantity = "force"  # P is a load as well
    if quantity is None:
        by_unit = {"force": "force", "length": "extension", "time": "time"}.get(known[0]) if known else None
        return (by_unit, known[1], False) if known and by_unit else None
    if quantity not in _PHYSICAL:
        return None if known else (quantity, "", True)
    if not unit:
        return quantity, "", True
    return (quantity, known[1], True) if known and known[0] == _PHYSICAL[quantity] else None


def _check_there(
    path: Path, where: str | None, found: set[str], names: Sequence[str], units: Sequence[str], empty: Sequence[bool]
) -> None:
    """Raises UsageError where there is no force, or where a force or a time was not found because of its unit."""
    parsed = [split_name(*pair) for pair, is_empty in zip(zip(names, units), empty) if not is_empty]
    for quantity in ("force", "time"):
        odd = next(((name, unit) for name, unit in parsed if quantity_named(name) == quantity), None)
        if quantity not in found and odd:
            name, unit = map(printable, odd)
            what = f"unit {unit!r} of {name!r} is not one of {quantity} ({', '.join(UNITS[quantity])})"
            raise UsageError(what, file=path, where=where, hint=REMEDY)
    if "force" not in found:
        seen = ", ".join(repr(printable(name)) for name, unit in parsed if name or unit) or "no names"
        raise UsageError(f"no column of force among {seen}", file=path, where=where, hint=REMEDY)


def columns_by_place(path: Path, words: str, width: int, empty: Sequence[bool]) -> tuple[Chosen, ...]:
    """The columns that `--columns` names. Raises UsageError where it does not name each one, or names none of force."""
    given = [word.strip() for word in words.split(",")]
    places = list(range(width)) if len(given) == width else [i for i in range(width) if not empty[i]]
    if len(given) != len(places):
        hint = "name each one, with - for those that are not used"
        raise UsageError(f"--columns names {len(given)} columns, the table has {len(places)}", file=path, hint=hint)
    chosen: list[Chosen] = []
    for index, word in zip(places, given):
        if word in ("-", ""):
            continue
        name, unit = split_name(word)
        quantity, known = quantity_named(name), known_unit(unit)
        wanted = _PHYSICAL.get(quantity or "")
        if quantity is None or (wanted and (known is None or known[0] != wanted)) or (not wanted and unit):
            hint = "use time_s, extension_mm, force_N, pressure_MPa (or other units), cycle, segment, or -"
            raise UsageError(f"--columns: {printable(word)!r} is not a column with its unit", hint=hint)
        if any(c.quantity == quantity for c in chosen):
            raise UsageError(f"--columns names two columns of {quantity}", hint="write - for one of them")
        chosen.append(Chosen(index, quantity, known[1] if known else "", word))
    if not any(c.quantity == "force" for c in chosen):
        raise UsageError("--columns names no force", hint="name one, as force_N")
    return tuple(sorted(chosen, key=lambda c: list(COLUMN_WORDS).index(c.quantity)))


def is_raw_data(names: Sequence[str], units: Sequence[str]) -> bool:
    """Whether a header is one of raw data: it names a force, and time or extension."""
    named = {quantity_named(split_name(n, u)[0]) for n, u in zip(names, units)}
    measured = {(known_unit(split_name(n, u)[1]) or ("",))[0] for n, u in zip(names, units)}
    return ("force" in named | measured) and bool(named & {"time", "extension", "pressure"} or measured & {"time"})


def _with_unit(path: Path, where: str | None, column: Chosen, force_unit: str | None) -> Chosen:
    """The column with a unit. A force or pressure must have one; times without are taken to be in s, lengths in mm."""
    if column.quantity not in _PHYSICAL or column.unit:
        return column
    if column.quantity == "pressure" or (column.quantity == "force" and force_unit is None):
        hint = f"give --force-unit ({', '.join(UNITS['force'])}), or {REMEDY}" if column.quantity == "force" else REMEDY
        raise UsageError(f"no unit of {printable(column.label)!r}", file=path, where=where, hint=hint)
    unit = force_unit if column.quantity == "force" else _ASSUMED[column.quantity]
    known = known_unit(unit or "")
    if known is None or known[0] != _PHYSICAL[column.quantity]:
        hint = f"use one of {', '.join(UNITS['force'])}"
        raise UsageError(f"--force-unit: {printable(force_unit)!r} is none", hint=hint)
    return replace(column, unit=known[1], assumed=True)
