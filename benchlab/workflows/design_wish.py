"""What an inverse design looks for, and the angles that it has seen."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError
from benchlab.simulation import inverse

TW, SLW = "window_width_mm", "strip_width_mm"
LINES, NODES = 11, 8
"""Lines of fixed tw (or slw) that are searched, and places on each where the first simulations are."""

Span = tuple[tuple[float, ...], bool]


@dataclass(frozen=True)
class Wish:
    """What is looked for. tw_mm, slw_mm: (low, high) and True, or values and False. base: the other dimensions."""

    angle_deg: float
    force_N: float | None
    tw_mm: Span
    slw_mm: Span
    base: ShellDesign

    def __post_init__(self) -> None:
        for name, value in (("--angle-deg", self.angle_deg), ("--force-N", self.force_N)):
            if value is not None and not 0 < value < math.inf:
                raise UsageError(f"{name} is {value:g}", hint="give a positive number")
        if not (self.tw_mm[1] or self.slw_mm[1]):
            raise UsageError("--tw-mm and --slw-mm are both fixed", hint="give one of them as a range, START:END")

    @property
    def along(self) -> str:
        """The dimension that is solved for on each line."""
        return SLW if self.slw_mm[1] else TW

    @property
    def across(self) -> str:
        return TW if self.along == SLW else SLW

    def lines(self) -> tuple[float, ...]:
        """Values of the dimension that is fixed on each line."""
        values, between = self.tw_mm if self.across == TW else self.slw_mm
        if not between:
            return values
        low, high = values
        found = inverse.whole_window_widths(low, high, self.base.length_mm, self.base.rib_width_mm, LINES)
        if not found:
            hint = "widen the range, or give --tw-mm as a list"
            raise UsageError(f"no whole number of windows fits with tw between {low:g} and {high:g} mm", hint=hint)
        return found

    def nodes(self) -> np.ndarray:
        (low, high), _ = self.slw_mm if self.along == SLW else self.tw_mm
        for value in (low, high):
            self.design(self.lines()[0], value)  # raises for what cannot be made
        return inverse.nodes_between(low, high, NODES)

    def design(self, across: float, along: float) -> ShellDesign:
        return replace(self.base, **{self.across: across, self.along: along})


@dataclass(frozen=True)
class AngleMap:
    """True angles at the last pressure: on lines (L,) at nodes (N,), angle_deg (L, N), NaN where there is none; and on each line
    with what was added near its peak, sorted: places and angles."""

    lines: np.ndarray
    nodes: np.ndarray
    angle_deg: np.ndarray
    refined: tuple[tuple[np.ndarray, np.ndarray], ...]
