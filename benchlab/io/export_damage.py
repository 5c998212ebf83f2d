"""Decimals that an export lost: a decimal sign that was dropped, or values that were cut to whole numbers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError, printable
from benchlab.io.export_numbers import NO_NUMBER, PADDED, Column, Lines

FloatArray = NDArray[np.float64]

JUMP = 5.0
"""A number without decimals that is more times its neighbours, and fits them with as many decimals as they have, has lost its sign."""

FIXED_ROWS, CUT_ROWS = 10, 5
"""So many rows with equally many decimals, and after them so many without any, are values that were cut."""

MANY_ROWS, MANY_SHARE = 100, 0.99
"""After so many rows, of which this share has equally many decimals, a single value without any is one that was cut."""


def lost_decimals(column: Column) -> tuple[int, str] | None:
    """(row, what is wrong) of the first number whose decimals are lost; None if there is none.

    >>> values = np.array([12.34, 12.35, 1236.0, 12.37])
    >>> lost_decimals(Column(values, np.array([2, 2, 0, 2], np.int16)))
    (2, "'1236' between 12.35 and 12.37: decimal sign lost, it would be 12.36")
    """
    if column.decimals is None or column.decimals.max(initial=0) <= 0:
        return None
    rows = np.flatnonzero(column.decimals != NO_NUMBER)
    values, decimals = column.values[rows], column.decimals[rows]
    found = [f for f in (_padded(values, decimals), _jump(values, decimals), _cut(values, decimals)) if f]
    if not found:
        return None
    at, what = min(found)
    return int(rows[at]), what


def check_decimals(path: Path, label: str, column: Column, lines: Lines, stated: bool) -> list[str]:
    """Raises InputError, with the line, where a column lost decimals; gives it as a warning where the decimal sign was `stated`."""
    if (lost := lost_decimals(column)) is None:
        return []
    row, what = lost
    said = f"column {printable(label)}: {what}" if label else what
    if stated:
        return [f"line {lines[row]}: {said}; taken as written, as --decimal was given"]
    hint = "export it again; where it is right as written, say so with --decimal"
    raise InputError(said, file=path, where=f"line {lines[row]}", hint=hint)


def _padded(values: FloatArray, decimals: NDArray[np.int16]) -> tuple[int, str] | None:
    at = np.flatnonzero(decimals == PADDED)
    if not at.size or np.mean(decimals > 0) < 0.5:
        return None
    return int(at[0]), f"a whole number {values[at[0]]:g} written with zeros before it: decimal sign lost"


def _jump(values: FloatArray, decimals: NDArray[np.int16]) -> tuple[int, str] | None:
    """A whole number beside one with decimals, that a power of ten away would lie by it."""
    broken = np.concatenate(([False], decimals > 0, [False]))
    whole = np.flatnonzero((decimals == 0) & (broken[:-2] | broken[2:]))
    before = np.where(broken[whole], whole - 1, whole + 1)
    after = np.where(broken[whole + 2], whole + 1, whole - 1)
    v, a, b = values[whole], values[before], values[after]
    size = np.maximum(abs(a), abs(b))
    found: tuple[int, str] | None = None
    for power in {int(k) for k in (*np.unique(decimals[before]), *np.unique(decimals[after]))}:
        would = v / 10.0**power
        fits = abs(would - (a + b) / 2) <= abs(a - b) + 0.2 * size
        as_many = (decimals[before] == power) | (decimals[after] == power)
        lost = as_many & fits & (abs(v) > JUMP * size) & (abs(v) >= 10.0**power)
        if lost.any() and (found is None or whole[np.argmax(lost)] < found[0]):
            i = int(np.argmax(lost))
            beside = f"between {a[i]:g} and {b[i]:g}" if before[i] != after[i] else f"beside {a[i]:g}"
            found = int(whole[i]), f"'{v[i]:.0f}' {beside}: decimal sign lost, it would be {would[i]:.{power}f}"
    return found


def _cut(values: FloatArray, decimals: NDArray[np.int16]) -> tuple[int, str] | None:
    """A whole number with fewer digits than those before it, all of which have decimals."""
    usual = int(decimals[0])
    same = np.cumsum(decimals == usual)
    count = np.arange(1, len(decimals) + 1)
    whole = (decimals == 0) & (values != 0)
    if usual <= 0 or not whole.any():
        return None
    digits = np.floor(np.log10(np.maximum(abs(values), 1))) + 1
    typical = np.median(digits[decimals == usual]) + usual
    whole &= digits < typical
    before, share = count - 1, (same - (decimals == usual)) / np.maximum(count - 1, 1)
    run = np.convolve(decimals == 0, np.ones(CUT_ROWS))[CUT_ROWS - 1 :][: len(decimals)] >= CUT_ROWS
    cut = whole & (((before >= FIXED_ROWS) & (share == 1) & run) | ((before >= MANY_ROWS) & (share >= MANY_SHARE)))
    if not cut.any():
        return None
    at = int(np.argmax(cut))
    return at, f"'{values[at]:.0f}' has no decimals, the {at} numbers before it have {usual}"
