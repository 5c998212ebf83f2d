"""Values of samples of groups, centred exactly: as decimals, before any of them is rounded to a float."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal, DecimalException

import numpy as np

from benchlab.errors import InputError, printable
from benchlab.units import FloatArray

Value = str | int | float | Decimal

FEW_DIGITS = 7.0
"""A warning is given where float64 would keep fewer digits of the values' differences."""

_FLOAT_DIGITS = 15.95


@dataclass(frozen=True)
class Measurements:
    """One entry a row: group, sample, and value − origin, shape (n,). Rows of one sample of one group are its cycles.

    A sample belongs to its group: the same name in two groups is two samples. warnings: what float64 would have lost.
    """

    groups: tuple[str, ...]
    samples: tuple[str, ...]
    deviations: FloatArray
    origin: Decimal
    warnings: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """The groups in the order in which they first stand."""
        return tuple(dict.fromkeys(self.groups))

    @property
    def nested(self) -> bool:
        """Whether any sample has more than one row, which then are its cycles."""
        return len(set(zip(self.groups, self.samples))) < len(self.groups)

    def cycles(self) -> dict[str, dict[str, FloatArray]]:
        """group -> sample -> deviations of its rows, in the order in which they first stand."""
        rows: dict[str, dict[str, list[float]]] = {name: {} for name in self.names}
        for group, sample, deviation in zip(self.groups, self.samples, self.deviations.tolist()):
            rows[group].setdefault(sample, []).append(deviation)
        return {group: {name: np.array(row) for name, row in samples.items()} for group, samples in rows.items()}


def measurements_of(
    groups: Sequence[str], values: Sequence[Value], samples: Sequence[str] | None = None
) -> Measurements:
    """Rows as Measurements. values: decimal texts, Decimals, ints, or floats (by their shortest text). Without `samples`, each
    row is a sample of its own.

    The value in the middle is subtracted from each as decimals, exactly; only then are they floats. So 1000000000000.4 and
    1000000000000.3 differ by 0.1, not by 0.0999755859375 (Simon & Lesage 1989 made NIST's SmLs sets to find out who loses it).
    Raises InputError for no rows, for lists unlike in length, and for a value that is no finite number.

    >>> rows = measurements_of(["a", "a", "b"], ["1000000000000.4", "1000000000000.3", "1000000000000.5"])
    >>> rows.origin, rows.deviations.tolist(), rows.nested
    (Decimal('1000000000000.4'), [0.0, -0.1, 0.1], False)
    """
    if samples is None:
        samples = [str(row) for row in range(1, len(groups) + 1)]
    if not len(groups) == len(values) == len(samples):
        raise InputError(f"{len(groups)} groups, {len(values)} values and {len(samples)} samples: not as many of each")
    if not values:
        raise InputError("no values")
    exact = [_decimal(value, row) for row, value in enumerate(values, start=1)]
    floats = np.array([float(value) for value in exact])
    if not np.isfinite(floats).all():
        row = int(np.flatnonzero(~np.isfinite(floats))[0])
        raise InputError(f"{printable(values[row])!r} is not a finite number", where=f"value {row + 1}")
    origin = exact[int(np.argpartition(floats, (len(floats) - 1) // 2)[(len(floats) - 1) // 2])]
    deviations = np.array([float(value - origin) for value in exact])
    if not np.isfinite(deviations).all():
        raise InputError("the values differ by more than a float can hold")
    as_text = not any(isinstance(value, float) for value in values)
    return Measurements(tuple(groups), tuple(samples), deviations, origin, _lost(origin, deviations, as_text))


def digits_in_float64(origin: Decimal, deviations: FloatArray) -> float:
    """Decimal digits that float64 keeps of differences as large as these of values as large as the origin; 15.95 at the best."""
    spread = float(np.ptp(deviations))
    if spread == 0 or origin == 0:
        return _FLOAT_DIGITS
    return min(_FLOAT_DIGITS, _FLOAT_DIGITS - float(abs(origin).log10()) + math.log10(spread))


def _decimal(value: Value, row: int) -> Decimal:
    try:
        number = Decimal(repr(float(value)) if isinstance(value, float) else value)
    except (DecimalException, ValueError, TypeError):
        number = Decimal("NaN")
    if not number.is_finite():
        raise InputError(f"{printable(value)!r} is not a finite number", where=f"value {row}")
    return number


def _lost(origin: Decimal, deviations: FloatArray, as_text: bool) -> tuple[str, ...]:
    digits = digits_in_float64(origin, deviations)
    if digits >= FEW_DIGITS:
        return ()
    kept = f"only {max(0, math.floor(digits))} digits of the values' differences are left by float64"
    spread = f"values near {float(origin):.3g} that differ by {np.ptp(deviations):.3g}"
    if as_text:
        return (f"{kept} ({spread}); they were read as decimals, so that nothing is lost here",)
    return (f"{kept} ({spread}): give the values as text, as they were written, not as floats",)
