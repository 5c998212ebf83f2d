"""Where significance brackets go: over bars, packed low, without touching each other or a bar."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Bracket:
    """From bar `left` to bar `right` (from 0), with a label over it, at a height."""

    left: int
    right: int
    label: str
    height: float


def stack_brackets(pairs: Sequence[tuple[int, int, str]], tops: Sequence[float], step: float) -> list[Bracket]:
    """Brackets (bar, bar, label) stacked over bars that reach up to `tops`, `step` apart, the shortest lowest.

    Each lies at least a step over every bar that it spans, and over every lower bracket that it overlaps. Brackets that only
    share a bar may lie side by side: draw them a little short of it.

    >>> [(b.left, b.right, b.height) for b in stack_brackets([(0, 2, ""), (0, 1, ""), (2, 1, "")], [5, 3, 4], 1)]
    [(0, 1, 6), (1, 2, 5), (0, 2, 7)]
    """
    placed: list[Bracket] = []
    ordered = sorted((min(a, b), max(a, b), label) for a, b, label in pairs)
    for left, right, label in sorted(ordered, key=lambda pair: pair[1] - pair[0]):
        under = [other.height for other in placed if other.left < right and left < other.right]
        height = max([*tops[left : right + 1], *under]) + step
        placed.append(Bracket(left, right, label, height))
    return placed
