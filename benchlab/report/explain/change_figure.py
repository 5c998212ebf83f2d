"""Root mean square gaps before and after, a row each, against the noise floor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from benchlab.report.explain.curves_figure import EXPLAINED
from benchlab.report.explain.quantity import Quantity
from benchlab.report.panels import GREY, dress
from benchlab.report.study.figures import MOST_ROWS, OTHER, TITLE_IN, WIDE_IN, finish, name_rows, new_panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Change:
    """A gap of something, before and after; noise_floor: NaN where it is not known."""

    name: str
    before: float
    after: float
    noise_floor: float = float("nan")


def draw_changes(rows: Sequence[Change], quantity: Quantity, after: str, title: str, width: float = WIDE_IN) -> Figure:
    """The first MOST_ROWS. after: what the model with what was named is called."""
    shown = rows[:MOST_ROWS]
    figure, ax = new_panel(width, 1.05 + TITLE_IN + 0.24 * len(shown), bottom=0.85, top=TITLE_IN)
    plot_changes(ax, shown, after, 0.4 * width)
    unit = f" ({quantity.unit})" * bool(quantity.unit)
    ax.set_xlabel(f"root mean square gap{unit}", fontsize=10, parse_math=False)
    finish(figure, ax, title, columns=3)
    return figure


def plot_changes(ax: Axes, rows: Sequence[Change], after_name: str, name_in: float) -> None:
    """An arrow from before to after; a grey tick: the noise floor."""
    at = np.arange(len(rows), dtype=float)
    before, after, floor = (
        np.array([getattr(row, name) for row in rows]) for name in ("before", "after", "noise_floor")
    )
    ax.hlines(at, before, after, color=GREY, linewidth=1.1, zorder=1)
    ax.plot(
        before,
        at,
        "D",
        color=OTHER,
        markersize=4.5,
        markerfacecolor="white",
        markeredgewidth=1.2,
        label="before: simulated",
    )
    ax.plot(after, at, "o", color=EXPLAINED, markersize=5, zorder=3, label=f"after: {after_name}")
    if np.isfinite(floor).any():
        ax.plot(floor, at, "|", color="black", markersize=9, markeredgewidth=1.4, label="noise floor", zorder=2)
    name_rows(ax, [row.name for row in rows], name_in)
    ax.set_xlim(0, 1.06 * max([float(np.nanmax([*before, *after, *floor])) if len(rows) else 1.0, 1e-9]))
    dress(ax, None, None)
    ax.grid(False, axis="y")
