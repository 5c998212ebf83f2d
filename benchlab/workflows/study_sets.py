"""Sets of designs that may be compared: those that differ in one dimension and are alike in all others."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from benchlab.actuator import DIMENSIONS, SYMBOLS, ShellDesign
from benchlab.io.study_values import StudySet

TITLES = {
    "tw_mm": "Window width",
    "slw_mm": "Strip width",
    "fw_mm": "Rib width",
    "perimeter_mm": "Perimeter",
    "length_mm": "Length",
}


def proposed_sets(shells: Mapping[str, ShellDesign]) -> tuple[StudySet, ...]:
    """A set for each dimension that varies while all others stay, in order of that dimension; none of fewer than two sizes.

    >>> shells = {"a": ShellDesign(5, 3), "b": ShellDesign(10, 3), "c": ShellDesign(10, 9)}
    >>> [(s.name, s.title, s.designs) for s in proposed_sets(shells)]
    [('tw', 'Window width, slw 10 mm', ('b', 'c')), ('slw', 'Strip width, tw 3 mm', ('a', 'b'))]
    """
    found = []
    for name, part in DIMENSIONS.items():
        alike: dict[tuple[float, ...], list[str]] = defaultdict(list)
        for design, shell in shells.items():
            alike[tuple(getattr(shell, other) for other in DIMENSIONS.values() if other != part)].append(design)
        groups = [group for group in alike.values() if len({getattr(shells[d], part) for d in group}) > 1]
        for group in groups:
            designs = sorted(group, key=lambda design: float(getattr(shells[design], part)))
            at = _others(name, shells[designs[0]], shells)
            short = name.removesuffix("_mm")
            called = short if len(groups) == 1 else "_".join([short, "at", *(word.replace(" ", "") for word in at)])
            title = ", ".join([TITLES[name], *(f"{word} mm" for word in at)])
            found.append(StudySet(called, title, tuple(designs), name))
    return tuple(found)


def _others(name: str, shell: ShellDesign, shells: Mapping[str, ShellDesign]) -> list[str]:
    """`tw 3`: the dimensions beside `name` that vary in the study, with their size here."""
    words = []
    for other, part in DIMENSIONS.items():
        varies = len({getattr(s, part) for s in shells.values()}) > 1
        if other != name and varies:
            symbol = SYMBOLS[part] if other in ("tw_mm", "slw_mm", "fw_mm") else other.removesuffix("_mm")
            words.append(f"{symbol} {getattr(shell, part):g}")
    return words
