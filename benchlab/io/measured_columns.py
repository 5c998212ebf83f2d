"""Which column of a table of measurements holds what: by its name, or as the user names it; the rest is told and not read."""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from benchlab.errors import InputError, UsageError, printable
from benchlab.io.measured_units import NUMBERS, PHYSICAL, WORDS, Meaning, meaning_of, unit_named, units_of

EXAMPLES = {"pressure": "pressure_kPa", "angle": "angle_deg", "force": "force_N", "time": "time_s"}


@dataclass(frozen=True)
class Column:
    """A column that is read. key: of its meaning, or its name where it is one of `against`, which have no meaning."""

    key: str
    index: int
    label: str
    meaning: Meaning | None


@dataclass(frozen=True)
class Columns:
    """The columns of a table by their keys. left: labels of those that are not read. headless: whether the first row is one of data."""

    read: Mapping[str, Column]
    left: tuple[str, ...]
    headless: bool = False

    @property
    def of_means(self) -> bool:
        """Whether the table holds means: it has a column of means, or of the number of samples."""
        roles = [column.meaning.role for column in self.read.values() if column.meaning]
        return "mean" in roles or "n" in self.read


def columns_of(text: str) -> dict[str, str]:
    """The mapping that `--columns` writes: `design=Configuration,pressure_kPa=Pressure`, or names in the order of the columns as
    `benchlab force` has them, with - for one that is not used.

    >>> columns_of("design=Configuration, pressure_kPa=Pressure"), columns_of("force_N,pressure_kPa,time_s,-")
    ({'design': 'Configuration', 'pressure_kPa': 'Pressure'}, {'force_N': '1', 'pressure_kPa': '2', 'time_s': '3'})

    Raises UsageError for a text that is neither, or that names one thing twice.
    """
    parts = [part.strip() for part in text.split(",")]
    pairs: list[tuple[str, ...]]
    if any("=" in part for part in parts):
        pairs = [tuple(side.strip() for side in part.split("=", 1)) for part in parts]
    else:
        pairs = [(part, str(place)) for place, part in enumerate(parts, start=1) if part not in ("-", "")]
    hint = "write it as --columns 'design=Configuration,pressure_kPa=Pressure'"
    if wrong := next((pair for pair in pairs if len(pair) < 2 or not all(pair)), None):
        raise UsageError(f"--columns: {printable('='.join(wrong))!r} does not say which column is what", hint=hint)
    names = [pair[0] for pair in pairs]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise UsageError(f"--columns names {printable(twice)!r} twice", hint="name each once")
    return {pair[0]: pair[1] for pair in pairs}


def find_columns(
    header: Sequence[str],
    source: str,
    columns: Mapping[str, str] | None = None,
    against: Sequence[str] = (),
    passed_over: tuple[str, ...] = ("measured",),
    may_be_data: bool = True,
) -> Columns:
    """The columns of a header, or of a first row of data. columns: names of ours with their unit, and the column or its place from 1.

    Raises UsageError for a column that is not there, or that is not one of ours; InputError for a unit that is missing or of another
    quantity, and for two columns of one quantity.
    """
    if headless := may_be_data and any(header) and all(_is_number(cell) for cell in header if cell):
        if not columns:
            hint = "name the columns by their places, as --columns force_N=1,pressure_kPa=2,time_s=3"
            raise InputError("no header: the first row holds numbers", file=source, hint=hint)
        header = [f"column {place}" for place in range(1, len(header) + 1)]
    chosen = {column.key: column for column in _named(header, source, columns or {}, against)}
    taken = {column.index for column in chosen.values()}
    for name in against:
        if (meaning := meaning_of(name)) is not None and (meaning.unit or not meaning.kind):
            raise UsageError(f"--against: {printable(name)!r} is read anyway", hint="leave it out of --against")
        if name not in chosen:
            index = _index(header, source, name, "--against")
            chosen[name] = Column(name, index, header[index], None)
            taken.add(index)
    found: dict[str, list[Column]] = {}
    for index, label in enumerate(header):
        meaning = None if index in taken else meaning_of(label, passed_over)
        if meaning is not None and meaning.key not in chosen:
            found.setdefault(meaning.key, []).append(Column(meaning.key, index, label, meaning))
    for key, candidates in found.items():
        chosen[key] = _only(candidates, source)
    read = {key: _with_unit(column, source) for key, column in chosen.items()}
    used = {column.index for column in read.values()}
    return Columns(read, tuple(label for i, label in enumerate(header) if i not in used and label), headless)


def _is_number(text: str) -> bool:
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return True


def _named(header: Sequence[str], source: str, columns: Mapping[str, str], against: Sequence[str]) -> list[Column]:
    found = []
    for name, place in columns.items():
        meaning = None if name in against else meaning_of(name)
        if meaning is None and name not in against:
            words = ", ".join([*WORDS[:3], *NUMBERS, *(f"{word} with its unit" for word in list(PHYSICAL)[:10])])
            raise UsageError(f"--columns: {printable(name)!r} is not a column with its unit", hint=f"use {words}")
        index = _index(header, source, place, f"--columns {name}")
        found.append(Column(name if meaning is None else meaning.key, index, printable(name), meaning))
    return found


def _index(header: Sequence[str], source: str, place: str, option: str) -> int:
    """Where a column is: by its name, or else by its place from 1."""
    if place in header:
        if list(header).count(place) > 1:
            raise InputError(f"two columns are called {printable(place)!r}", file=source, hint="rename one of them")
        return list(header).index(place)
    if place.isascii() and place.isdigit() and 1 <= int(place) <= len(header):
        return int(place) - 1
    close = difflib.get_close_matches(place, list(header), n=1)
    hint = f"did you mean {printable(close[0])!r}?" if close else f"columns: {_listed(header)}"
    raise UsageError(f"{option}: no column {printable(place)!r}", file=source, hint=hint)


def _only(candidates: Sequence[Column], source: str) -> Column:
    if len(candidates) > 1:
        listed = " and ".join(repr(printable(column.label)) for column in candidates)
        key = candidates[0].key
        hint = f"keep one, or say which with --columns '{candidates[0].label}={candidates[0].label}'"
        raise InputError(f"{len(candidates)} columns of {key}: {listed}", file=source, hint=hint)
    return candidates[0]


def _with_unit(column: Column, source: str) -> Column:
    """The column, if its unit is written and one of its quantity. Nothing is assumed."""
    meaning = column.meaning
    if meaning is None or not meaning.kind:
        return column
    label = printable(column.label)
    if not meaning.unit:
        example = EXAMPLES.get(meaning.kind, meaning.name)
        hint = f"put it into the name, as {example}, or say --columns '{example}={label}'"
        raise InputError(f"no unit in the name of column {label!r}", file=source, hint=hint)
    if meaning.unit not in units_of(meaning.kind):
        what = f"unit {printable(meaning.unit)!r} of column {label!r} is not one of {meaning.kind}"
        raise InputError(what, file=source, hint=f"use one of {', '.join(units_of(meaning.kind))}")
    return column


def vague_column(header: Sequence[str], word: str) -> str:
    """A column that speaks of a quantity, but with no unit that is known, "" where there is none.

    >>> vague_column(["design", "pressure_bara"], "pressure")
    'pressure_bara'
    """
    return next((label for label in header if word in label.lower() and not unit_named(label)), "")


def _listed(header: Sequence[str]) -> str:
    return ", ".join(repr(printable(label)) for label in header[:8]) + (" …" if len(header) > 8 else "")
