"""Cells of an export as numbers: which sign marks decimals, which one thousands, and what could be read in two ways."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError, printable
from benchlab.io.numbers import MAX_NUMBER

FloatArray = NDArray[np.float64]
Lines = NDArray[np.int64] | range
"""Numbers of the lines of a table's rows, (n,)."""

NUMBER = r"[+\-−]?(?:\d+(?:[ '’\u00a0\u202f]\d{3}(?!\d))*(?:[.,][\d.,]*)?|[.,]\d+)(?:[eE][+-]?\d+)?"
"""What is meant as a number, also where it is a damaged one."""

NO_NUMBER, EXPONENT, PADDED, BARE = -1, -2, -3, -4
"""In place of a count of decimals: a cell without a number, with an exponent, a whole number that begins with a zero, one that ends
in its decimal sign."""

_NUMBER = re.compile(NUMBER)
_WITH_UNIT = re.compile(rf"({NUMBER})\s*[A-Za-zµμ°%²³]+[/A-Za-z0-9²³^]*")
_GROUP = r"[+\-−]?[1-9]\d{0,2}"
_ONE_GROUP = re.compile(rf"{_GROUP}[.,]\d{{3}}")
_GROUPS = re.compile(rf"{_GROUP}([.,])\d{{3}}(?:\1\d{{3}})+")
_BOTH = re.compile(rf"{_GROUP}(?:([.,])\d{{3}})(?:\1\d{{3}})*(?!\1)[.,]\d*")
_SPACED = re.compile(r"(?<=\d)[ '’\u00a0\u202f](?=\d{3}(?!\d))")
_PADDED = re.compile(r"[+\-−]?0\d+")


@dataclass(frozen=True)
class Signs:
    """How numbers are written in a file. decimal: "." or ","; thousands: the other one where a number proves it, else "".

    stated: the decimal sign is from an option."""

    decimal: str
    thousands: str
    stated: bool = False


@dataclass(frozen=True)
class Column:
    """Numbers of a column (n,), read-only, NaN where there is none; decimals (n,) that each was written with, None where all have as many;
    unreadable: (row, cell) of what is neither empty nor a number."""

    values: FloatArray
    decimals: NDArray[np.int16] | None
    unreadable: tuple[tuple[int, str], ...] = ()
    complete: bool = False
    """Whether it is known that there is a number in every row."""


def is_number(cell: str) -> bool:
    """Whether a cell is meant as a number."""
    return bool(_NUMBER.fullmatch(cell))


def has_unit(cell: str) -> bool:
    """Whether a cell is a number with a unit behind it.

    >>> has_unit("2 kN"), has_unit("2"), has_unit("Strain 2")
    (True, False, False)
    """
    return bool(_WITH_UNIT.fullmatch(cell))


def find_signs(path: Path, cells: Iterable[tuple[int, str]], separator: str, stated: str | None = None) -> Signs:
    """The signs in (line, cell), with cells that are no numbers passed over. stated: the decimal sign, as an option gives it.

    Raises InputError where decimals are marked by both signs, or where all marks could be for decimals or for thousands.
    """
    lines: dict[str, tuple[int, str]] = {}
    vague: dict[str, tuple[int, str]] = {}
    grouped = ""
    for line, cell in cells:
        points, commas = cell.count("."), cell.count(",")
        if points + commas == 0 or (points + commas == 1 and ("." if points else ",") in lines):
            continue  # says nothing, or nothing new
        if not is_number(cell):
            continue
        decimal, thousands = _told(cell)
        grouped = grouped or thousands
        if decimal:
            lines.setdefault(decimal, (line, cell))
        elif not thousands:
            vague.setdefault("," if commas else ".", (line, cell))
    if stated:
        return Signs(stated, "," if stated == "." else ".", stated=True)
    if len(lines) == 2:
        (point, _), (comma, text) = lines["."], lines[","]
        what = f"decimal points (line {point}) and decimal commas (line {comma}, {printable(text)!r})"
        hint = "use one; --decimal says which it is where the other marks thousands"
        raise InputError(what, file=path, where=f"line {max(point, comma)}", hint=hint)
    if grouped in lines:
        grouped = ""  # two decimal signs in a cell
    sign = next(iter(lines), "") or {"": "", ".": ",", ",": "."}[grouped]
    if not sign and "." in vague and "," not in vague and separator == ",":
        sign = "."
    if sign in lines or not vague or (sign and not set(vague) - {sign}) or (sign and grouped):
        return Signs(sign or ".", grouped)
    raise _two_readings(path, *next(iter(vague.values())))


def tells_decimal(cell: str) -> bool:
    """Whether a number proves by itself which sign marks its decimals.

    >>> tells_decimal("0.25"), tells_decimal("1.250"), tells_decimal("3")
    (True, False, False)
    """
    return bool(_told(cell)[0])


def _told(cell: str) -> tuple[str, str]:
    """(decimal sign, sign of thousands) that a cell proves, "" for what it leaves open."""
    text = _SPACED.sub("", cell)
    mantissa = re.split("[eE]", text)[0]
    points, commas = mantissa.count("."), mantissa.count(",")
    if points and commas:
        if _BOTH.fullmatch(mantissa):
            decimal = "." if mantissa.rfind(".") > mantissa.rfind(",") else ","
            return decimal, "," if decimal == "." else "."
        return "", ""
    if points + commas == 1:
        vague = mantissa == text == cell and _ONE_GROUP.fullmatch(mantissa)
        return ("", "") if vague else ("." if points else ",", "")
    groups = _GROUPS.fullmatch(mantissa)
    return "", groups[1] if groups else ""


def _two_readings(path: Path, line: int, cell: str) -> InputError:
    whole, broken = re.sub("[.,]", "", cell), cell.replace(",", ".")
    what = f"{printable(cell)!r} could be {printable(broken)} or {printable(whole)}"
    sign = "comma" if "," in cell else "point"
    hint = f"say --decimal , or --decimal . (is the {sign} for decimals or for thousands?)"
    return InputError(what, file=path, where=f"line {line}", hint=hint)


def numbers(path: Path, label: str, cells: Sequence[str], lines: Lines, signs: Signs) -> Column:
    """The numbers of a column. Raises InputError, with the line, for a cell with two decimal signs, with a unit, or of many digits."""
    reader = _Cells(path, label, signs)
    values, decimals = np.empty(len(cells)), np.empty(len(cells), np.int16)
    unreadable = []
    for row, cell in enumerate(cells):
        if (read := reader.read(cell)) is None:
            reader.refuse(cell, lines[row])
            unreadable.append((row, cell))
            read = np.nan, NO_NUMBER
        values[row], decimals[row] = read
    values.setflags(write=False)
    return Column(values, decimals, tuple(unreadable))


class _Cells:
    """Reads cells of one column under the signs of the file."""

    def __init__(self, path: Path, label: str, signs: Signs) -> None:
        self.path, self.label, self.signs = path, label, signs
        mark = re.escape(signs.decimal)
        self._plain = re.compile(rf"[+-]?(?:\d+(?:{mark}(\d*))?|{mark}(\d+))([eE][+-]?\d+)?")
        self._grouped = re.compile(rf"{_GROUP}(?:{re.escape(signs.thousands)}\d{{3}})+(?:{mark}\d*)?")

    def read(self, cell: str) -> tuple[float, int] | None:
        """Number and decimals of a cell; None for text that is no number."""
        match = self._plain.fullmatch(cell)
        if match is None and cell:
            cell = _SPACED.sub("", cell).replace("−", "-")
            if self.signs.thousands and self._grouped.fullmatch(cell):
                cell = cell.replace(self.signs.thousands, "")
            match = self._plain.fullmatch(cell)
        if not cell:
            return np.nan, NO_NUMBER
        if match is None or len(cell) > MAX_NUMBER:
            return None
        value = float(cell.replace(",", "."))
        if not np.isfinite(value):
            return None
        if match[3]:
            return value, EXPONENT
        if decimals := len(match[1] or match[2] or ""):
            return value, decimals
        return value, BARE if match[1] == "" else PADDED if _PADDED.fullmatch(cell) else 0

    def refuse(self, cell: str, line: int) -> None:
        """Raises InputError for text that may hide a number."""
        where, name = f"line {line}", f"column {printable(self.label)}: " if self.label else ""
        if len(cell) > MAX_NUMBER:
            what = f"{name}cell of {len(cell)} characters, a number has at most {MAX_NUMBER}"
            raise InputError(what, file=self.path, where=where, hint="export it again, or mend the cell")
        if not is_number(cell):
            if has_unit(cell):
                hint = "put the unit in the header, as in Load (N)"
                raise InputError(f"{name}unit in a cell: {printable(cell)!r}", file=self.path, where=where, hint=hint)
            return
        if _ONE_GROUP.fullmatch(cell) and not self.signs.thousands:
            raise _two_readings(self.path, line, cell)
        if cell.count(".") + cell.count(",") > 1:
            what, hint = f"{name}two decimal signs in {printable(cell)!r}", "export it again, or mend the cell"
            raise InputError(what, file=self.path, where=where, hint=hint)
        if "." in cell or "," in cell:
            what = f"{name}{printable(cell)!r}, where decimals are marked by {self.signs.decimal!r}"
            raise InputError(what, file=self.path, where=where, hint="export it again, or mend the cell")
