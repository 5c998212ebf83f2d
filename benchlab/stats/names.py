"""Names of groups and samples in words: cut where they are long, listed, and looked at for being meant as one."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal, DecimalException
from itertools import pairwise

LONGEST = 40


def shown(name: str) -> str:
    """A name as a line of text holds it.

    >>> shown("slw5"), shown("x" * 5000) == "x" * 39 + "…"
    ('slw5', True)
    """
    return name if len(name) <= LONGEST else name[: LONGEST - 1] + "…"


def listed(names: Sequence[str], most: int = 5) -> str:
    """The first of some names, and how many more there are.

    >>> listed(["a", "b", "c"], most=2)
    'a, b and 1 more'
    """
    return ", ".join(map(shown, names[:most])) + (f" and {len(names) - most} more" if len(names) > most else "")


def lookalikes(names: Sequence[str]) -> list[tuple[str, str]]:
    """Pairs of different names that may be meant as one: unlike only in case, blanks, or in how a number is written.

    >>> lookalikes(["1", "1.0", "slw5", "SLW 5", "slw10"])
    [('1', '1.0'), ('slw5', 'SLW 5')]
    """
    alike: dict[str, list[str]] = {}
    for name in dict.fromkeys(names):
        alike.setdefault(_folded(name), []).append(name)
    return [pair for same in alike.values() for pair in pairwise(same)]


def _folded(name: str) -> str:
    text = "".join(name.split()).casefold()
    try:
        number = Decimal(text.replace(",", "."))
    except (DecimalException, ValueError):
        return text
    return str(number.normalize()) if number.is_finite() else text
