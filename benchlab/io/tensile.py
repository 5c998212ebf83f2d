"""Tensile tests from Instron exports and plain tables: which columns, in which units, and what they become.

Columns are found by unit and name: stretch, strain (%, mm/mm, none), extension; stress, force. `--columns` names them by place
where the file does not. The size of the specimen is taken from the options, else from a preamble in English.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchlab.errors import InputError, UsageError, printable
from benchlab.io.export_columns import NO_NAMES
from benchlab.io.export_table import Export, ExportTable, read_export
from benchlab.units import FloatArray, known_unit, parse_column, to_mm, to_MPa, to_N

RATIOS = {"%": 0.01, "mm/mm": 1.0, "m/m": 1.0, "in/in": 1.0, "": 1.0}
"""Factor of each unit of strain."""

MIN_ROWS = 5
"""Fewest rows of numbers that are read as a test."""

_STRESSES = {"n/mm^2": "MPa", "n/mm²": "MPa", "n/mm2": "MPa"}
_TO_STRAIN, _TO_STRESS = ("stretch", "strain", "extension"), ("stress", "force")


@dataclass(frozen=True)
class SpecimenSize:
    """Thickness, width and gauge length in mm; None where it is not known."""

    thickness_mm: float | None = None
    width_mm: float | None = None
    gauge_mm: float | None = None

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None and not (np.isfinite(value) and value > 0):
                raise UsageError(f"--{name.replace('_', '-')} is {value}", hint="give a positive length in mm")


@dataclass(frozen=True)
class TensileTest:
    """Stretch and nominal stress (MPa) as recorded, shape (n,); the size that was used; what was done, in words."""

    path: Path
    stretch: FloatArray
    stress_MPa: FloatArray
    size: SpecimenSize
    notes: tuple[str, ...]


@dataclass(frozen=True)
class _Column:
    index: int
    quantity: str
    unit: str
    label: str
    true: bool


def read_tensile(
    path: Path,
    size: SpecimenSize | None = None,
    columns: str | None = None,
    true_stress: bool = False,
    decimal: str | None = None,
    encoding: str | None = None,
) -> TensileTest:
    """Read one test. columns: names by place with commas between, as `force_N,extension_mm`; `-` for one that is not used.

    true_stress: stresses (and strains that say so) are true ones; they are turned into nominal stress and stretch.
    decimal, encoding: see `read_export`.
    Raises UsageError where an option is missing or wrong, InputError for a file that is no tensile test.
    """
    size = size or SpecimenSize()
    export = read_export(path, encoding, decimal)
    notes = list(export.notes)
    table = _only_table(export, notes)
    found = _named(table, columns) if columns else _recognised(table)
    x = _chosen(path, found, _TO_STRAIN, true_stress, given=size.gauge_mm is not None)
    y = _chosen(path, found, _TO_STRESS, true_stress, given=None not in (size.thickness_mm, size.width_mm))
    needed = ("gauge_mm",) * (x.quantity == "extension") + ("thickness_mm", "width_mm") * (y.quantity == "force")
    size = _size(export, size, needed, notes)
    values_x, values_y = _numbers(table, x, y, notes)
    stretch = _stretch(path, x, values_x, size)
    stress = _stress(path, y, values_y, size)
    if y.quantity == "stress":
        if true_stress:
            stress = stress / stretch
        kind = "true stress, divided by the stretch" if true_stress else "taken as nominal (engineering) stress"
        notes.append(f"{x.label!r} against {y.label!r}, {kind}")
    else:
        notes.append(f"{x.label!r} against {y.label!r} over {size.thickness_mm:g} x {size.width_mm:g} mm")
    return TensileTest(path, stretch, stress, size, tuple(notes))


def _only_table(export: Export, notes: list[str]) -> ExportTable:
    """The one table of the test; much smaller ones, as results, are left out. Raises InputError for several, or for few rows."""
    path, table = export.path, max(export.tables, key=lambda t: len(t.lines))
    large = [t for t in export.tables if len(t.lines) * 5 > len(table.lines)]
    if len(large) > 1:
        at = ", ".join(str(t.lines[0]) for t in large)
        hint = "save each specimen as a file of its own, and give them all"
        raise InputError(f"{len(large)} tables of numbers (from lines {at})", file=path, hint=hint)
    if len(table.lines) < MIN_ROWS:
        what = f"{len(table.lines)} rows of numbers, a test has at least {MIN_ROWS}"
        raise InputError(what, file=path, where=f"line {table.lines[0]}")
    notes += [f"the small table of numbers in line {t.lines[0]} was left out" for t in export.tables if t is not table]
    return table


def _quantity(name: str, unit: str | None) -> tuple[str, str] | None:
    """What a column holds and its unit in our spelling; None for what a tensile test does not need."""
    low, unit = name.lower(), (unit or "").strip()
    unit = _STRESSES.get(unit.lower(), unit)
    kind = known_unit(unit)
    if kind is not None:
        quantity = {"pressure": "stress", "length": "extension", "force": "force"}.get(kind[0])
        return (quantity, kind[1]) if quantity else None
    if unit not in RATIOS:
        return None
    if re.search(r"stretch|lambda|λ", low) and not unit:
        return "stretch", ""
    if unit or re.search(r"strain|dehnung|deform|ε", low):
        return "strain", unit
    return None


def _recognised(table: ExportTable) -> list[_Column]:
    """Columns by what their header says. Raises InputError for a flexure or compression test, UsageError for no header."""
    hint = "say what the columns are, as --columns force_N,extension_mm (or stretch, strain, strain_%, stress_MPa; - for others)"
    if not table.has_header:
        raise UsageError(f"{table.width} {NO_NAMES}", file=table.path, hint=hint)
    found = []
    for index, name in enumerate(table.names):
        inline = _parsed(name)
        unit = table.units[index] or inline[1]
        if re.search(r"flex|bend|compress", name.lower()):
            hint = "a law is fitted to tensile tests; name the columns with --columns if this is one"
            raise InputError(f"column {printable(name)!r}: not a tensile test", file=table.path, hint=hint)
        if (what := _quantity(name, unit)) is not None:
            label = (
                printable(f"{name} ({unit})" if unit and name == inline[0] else name) or f"column {index + 1} ({unit})"
            )
            found.append(_Column(index, *what, label, "true" in name.lower()))
    if not any(c.quantity in _TO_STRAIN for c in found) or not any(c.quantity in _TO_STRESS for c in found):
        seen = printable(", ".join(f"{n} {u}".strip() for n, u in zip(table.names, table.units)))
        wanted = f"no columns of stretch, strain or extension with stress or force and their units: it has {seen}"
        raise UsageError(wanted, file=table.path, hint=hint)
    return found


def _named(table: ExportTable, columns: str) -> list[_Column]:
    """Columns by the words of --columns."""
    words = [word.strip() for word in columns.split(",")]
    if len(words) != (width := table.width):
        hint = "name each one, with - for those that are not used"
        raise UsageError(f"--columns names {len(words)} columns, the table has {width}", file=table.path, hint=hint)
    found = []
    for index, word in enumerate(words):
        if word in ("-", ""):
            continue
        what = _quantity(*_parsed(word))
        if what is None or what[0] not in word.lower():
            hint = "use stretch, strain, strain_%, extension_mm, stress_MPa, force_N (or other units), or -"
            raise UsageError(f"--columns: {printable(word)!r} is not a column of a tensile test", hint=hint)
        found.append(_Column(index, *what, word, "true" in word.lower()))
    return found


def _parsed(name: str) -> tuple[str, str | None]:
    """Name and unit of a header cell; as `parse_column`, with the units of strain and N/mm²."""
    if match := re.fullmatch(r"(.*?)[\s_]*[(\[]?(%|mm/mm|m/m|in/in|N/mm(?:\^2|²|2))[)\]]?\s*", name):
        return match[1].strip(), match[2]
    return parse_column(name)


def _chosen(path: Path, found: Sequence[_Column], wanted: tuple[str, ...], true: bool, given: bool) -> _Column:
    """The column of the first of `wanted` that is there; of the last (extension, force) where its length was `given` as an option."""
    order = (wanted[-1], *wanted[:-1]) if given else wanted
    for quantity in order:
        fitting = [c for c in found if c.quantity == quantity]
        if fitting and not true and all(c.true for c in fitting):
            hint = "say --stress true"
            raise UsageError(f"{fitting[0].label!r} is not nominal", file=path, hint=hint)
        fitting = [c for c in fitting if c.true == true] or [c for c in fitting if true or not c.true]
        if len(fitting) > 1:
            names = " and ".join(repr(c.label) for c in fitting)
            hint = "choose with --columns, naming one and writing - for the other"
            raise UsageError(f"{len(fitting)} columns of {quantity}: {names}", file=path, hint=hint)
        if fitting:
            return fitting[0]
    raise UsageError(
        f"--columns names no {', '.join(wanted)}", file=path, hint="name one of them, as force_N,extension_mm"
    )


def _numbers(table: ExportTable, x: _Column, y: _Column, notes: list[str]) -> tuple[FloatArray, FloatArray]:
    """The values of two columns; rows in which one of them is empty are left out and counted."""
    values = []
    for chosen in (x, y):
        column, said = table.column(chosen.index, chosen.label)
        notes += said
        if column.unreadable:
            row, text = column.unreadable[0]
            hint = f"{len(column.unreadable)} such cells; remove these rows"
            where = f"line {table.lines[row]}"
            raise InputError(f"{printable(text)!r} is not a number", file=table.path, where=where, hint=hint)
        values.append(column.values)
    whole = np.isfinite(values).all(axis=0)
    if not whole.all():
        notes.append(f"{int((~whole).sum())} rows with an empty cell are left out")
    return values[0][whole], values[1][whole]


def _stretch(path: Path, x: _Column, values: FloatArray, size: SpecimenSize) -> FloatArray:
    if x.quantity == "stretch":
        return values
    if x.quantity == "strain":
        strain = values * RATIOS[x.unit]
        return np.exp(strain) if x.true else 1 + strain
    if size.gauge_mm is None:
        what = f"{x.label!r} is an extension, and the gauge length is not known"
        raise UsageError(what, file=path, hint="give --gauge-mm, the length that extends")
    return 1 + to_mm(values, x.unit) / size.gauge_mm


def _stress(path: Path, y: _Column, values: FloatArray, size: SpecimenSize) -> FloatArray:
    if y.quantity == "stress":
        return to_MPa(values, y.unit)
    if size.thickness_mm is None or size.width_mm is None:
        what = f"{y.label!r} is a force, and the cross-section is not known"
        raise UsageError(what, file=path, hint="give --thickness-mm and --width-mm")
    return to_N(values, y.unit) / (size.thickness_mm * size.width_mm)


def _size(export: Export, size: SpecimenSize, needed: tuple[str, ...], notes: list[str]) -> SpecimenSize:
    """The size from the options, and what of it is needed and left open from the preamble."""
    patterns = {"thickness_mm": r"thickness$", "width_mm": r"width$", "gauge_mm": r"(gauge|specimen) length$|^length$"}
    taken: dict[str, float] = {}
    for key in needed:
        if getattr(size, key) is None:
            values = {value for name, value in _lengths(export) if re.search(patterns[key], name)}
            if len(values) == 1 and (value := values.pop()) > 0:
                taken[key] = value
    if taken:
        words = (f"{key.removesuffix('_mm')} {value:g} mm" for key, value in taken.items())
        notes.append("from the file: " + ", ".join(words))
    return replace(size, **taken)


def _lengths(export: Export) -> Iterator[tuple[str, float]]:
    """(name in lower case, mm) of every length in the preamble."""
    for _, cells in export.preamble:
        name, unit = parse_column(cells[0])
        unit = unit or (cells[2].strip("() ") if len(cells) > 2 else "")
        if len(cells) > 1 and re.fullmatch(r"\d+([.,]\d+)?", cells[1]) and (known_unit(unit) or ("",))[0] == "length":
            yield name.lower(), float(to_mm(float(cells[1].replace(",", ".")), unit))
