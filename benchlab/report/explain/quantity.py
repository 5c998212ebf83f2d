"""What is compared, as the report writes it: its noun, its unit, its decimals, and how a difference of it is told."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchlab.discrepancy.explanation import Curves
from benchlab.discrepancy.measured import QUANTITIES
from benchlab.errors import printable
from benchlab.report.document import NONE, cut
from benchlab.report.rounding import decimals_of, number
from benchlab.units import parse_column

_NOUNS = {
    "angle_deg": "bending angle θ",
    "force_N": "blocked force",
    "volume_mL": "volume",
    "flex_V": "flex sensor",
}
_VERBS = {"angle_deg": ("bends", "bend"), "force_N": ("pushes", "push"), "volume_mL": ("takes in", "take in")}


@dataclass(frozen=True)
class Quantity:
    """name: of its column. decimals: as many as give the usual scatter of samples two digits."""

    name: str
    decimals: int = 1

    @property
    def unit(self) -> str:
        """As printed; "" where a user's column does not say it."""
        return QUANTITIES[self.name] if self.name in QUANTITIES else cut(parse_column(self.name)[1] or "", 12)

    @property
    def noun(self) -> str:
        return _NOUNS.get(self.name) or cut(self.name, 40)

    @property
    def label(self) -> str:
        """For axes and heads of tables: `bending angle θ (°)`; a user's column as it is called."""
        return f"{self.noun} ({self.unit})" if self.name in QUANTITIES else self.noun

    def amount(self, value: float, signed: bool = False) -> str:
        """A value with its unit; signed: with a plus where it is above zero. A dash for NaN.

        >>> Quantity("angle_deg").amount(-4.52), Quantity("force_N", 2).amount(0.8, signed=True), Quantity("lift_mm").amount(3.0)
        ('−4.5°', '+0.80 N', '3.0 mm')
        """
        text = number(value, self.decimals).text
        if text == NONE:
            return text
        plus = "+" if signed and value > 0 and text.strip("0.") else ""
        return f"{plus}{text}{self._after}"

    def span(self, low: float, high: float) -> str:
        """A range of amounts, or one where both are written alike.

        >>> Quantity("angle_deg").span(3.1, 4.9), Quantity("angle_deg").span(3.1, 3.12)
        ('3.1 to 4.9°', '3.1°')
        """
        first, last = (number(end, self.decimals).text for end in (low, high))
        return self.amount(low) if first == last else f"{first} to {last}{self._after}"

    def differs(self, subject: str, amount: str, less: bool, plural: bool) -> str:
        """A sentence's head: who differs from the simulation by how much, and which way.

        >>> Quantity("angle_deg").differs("tw3_slw10", "4.5°", less=True, plural=False)
        'tw3_slw10 bends 4.5° less than simulated'
        >>> Quantity("lift_mm").differs("both", "2.0 mm", less=False, plural=True)
        'both have a lift_mm 2.0 mm higher than simulated'
        """
        if self.name in _VERBS:
            return f"{subject} {_VERBS[self.name][plural]} {amount} {'less' if less else 'more'} than simulated"
        return f"{subject} {'have' if plural else 'has'} a {self.noun} {amount} {'lower' if less else 'higher'} than simulated"

    @property
    def _after(self) -> str:
        return "" if not self.unit else self.unit if self.unit == "°" else f" {self.unit}"


def quantity_of(curves: Curves, name: str) -> Quantity:
    """A quantity with the decimals that its scatter deserves."""
    spreads = curves.sd[(curves.quantity == name) & np.isfinite(curves.sd) & (curves.sd > 0)]
    return Quantity(name, min(decimals_of(float(np.median(spreads))), 4) if len(spreads) else 1)


def quantities_of(curves: Curves) -> list[Quantity]:
    """All that are compared, in the order of the features."""
    return [quantity_of(curves, name) for name in dict.fromkeys(curves.quantity.tolist())]


def main_quantity(curves: Curves) -> Quantity:
    """The first: the one that the numbers of the gap belong to."""
    found = quantities_of(curves)
    return found[0] if found else Quantity("angle_deg")


def effect_words(name: str) -> str:
    """An effect as a sentence has it.

    >>> effect_words("seam_margin")
    'seam margin'
    """
    return cut(printable(name.replace("_", " ")), 40)
