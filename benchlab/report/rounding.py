"""Numbers as a report shows them: an uncertainty with two digits, and what it belongs to as finely."""

from __future__ import annotations

import math

from benchlab.report.document import NONE, Cell, cut
from benchlab.stats.studentized_range import FLOOR
from benchlab.stats.wording import p_text


def decimals_of(uncertainty: float | None) -> int:
    """Decimals that show two digits of an uncertainty; 2 where there is none.

    >>> decimals_of(1.9), decimals_of(0.0123), decimals_of(37.0), decimals_of(None), decimals_of(0.0996)
    (1, 3, 0, 2, 2)
    """
    if uncertainty is None or not math.isfinite(uncertainty) or uncertainty <= 0:
        return 2
    return min(max(1 - math.floor(math.log10(float(f"{uncertainty:.1e}"))), 0), 12)


def number(value: float | None, decimals: int = 2) -> Cell:
    """A number with so many decimals; a dash where there is none. A true minus, and no minus before zero.

    >>> number(-3.14159, 1).text, number(-0.001, 1).text, number(None).text, number(float("nan")).value
    ('−3.1', '0.0', '–', None)
    """
    if value is None or not math.isfinite(value):
        return Cell(None, NONE)
    text = f"{value:.{decimals}f}"
    return Cell(float(value), text.lstrip("-") if not text.strip("-0.") else text.replace("-", "−"))


def digits(value: float | None, count: int = 3) -> Cell:
    """A number with so many significant digits.

    >>> digits(529.4567).text, digits(0.00012345).text, digits(0.0).text
    ('529', '0.000123', '0')
    """
    if value is None or not math.isfinite(value):
        return Cell(None, NONE)
    text = f"{value:.{count}g}"
    if "e" in text and 1e-4 <= abs(value) < 1e7:
        text = f"{float(text):.0f}"
    return Cell(float(value), text.replace("-", "−"))


def count(value: int | None) -> Cell:
    return Cell(value, NONE if value is None else str(value))


def words(text: str, length: int = 60) -> Cell:
    """A text, shown cut and with control characters escaped; whole in the CSV file."""
    return Cell(text, cut(text, length))


def probability(p: float | None, floor: float = FLOOR) -> Cell:
    """A probability as the page shows it; below the floor only that it is below (for pairs: 1e-13, noise from there on)."""
    return Cell(None, NONE) if p is None else Cell(p, p_text(p, floor))
