"""Mandel's h and k of every sample, as ASTM E691 draws them: a line a sample, grouped by design, with critical values."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from benchlab.report.document import cut_apart
from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.study.figures import HALF_IN, OTHER, TEXT, new_panel
from benchlab.report.wording import drawable
from benchlab.stats.consistency import Cell

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_CELLS = 80


def draw_consistency(cells: Sequence[Cell], statistic: str) -> Figure:
    """h or k (`statistic`) of up to MOST_CELLS cells; those beyond a critical value in another colour, with their names."""
    figure, ax = new_panel(HALF_IN, 2.7, bottom=0.5)
    plot_consistency(ax, cells[:MOST_CELLS], statistic)
    return figure


def plot_consistency(ax: Axes, cells: Sequence[Cell], statistic: str) -> None:
    """A line from 0 to each value; dashed: critical values, which depend on how many replicates there are."""
    levels = [(level, list(group)) for level, group in groupby(cells, key=lambda cell: cell.level or cell.laboratory)]
    names = cut_apart([drawable(level, 200) for level, _ in levels], max(50 // max(len(levels), 1), 5))
    left, middles, top = 0.0, [], 1.0
    for _, group in levels:
        for place, cell in enumerate(group):
            value, critical = getattr(cell, statistic), getattr(cell, f"{statistic}_critical")
            if value is None:
                continue
            beyond = critical is not None and abs(value) > critical
            colour, x = OTHER if beyond else BLUE, left + place
            ax.vlines(x, 0, value, color=colour, linewidth=2)
            ax.plot(x, value, "o", color=colour, markersize=3)
            top = max(top, abs(value), critical or 0.0)
            if beyond:
                ax.annotate(drawable(cell.laboratory, 12), (x, value), (0, 3 if value > 0 else -10), textcoords="offset points",
                            ha="center", color=OTHER, **{**TEXT, "fontsize": 7.5})  # fmt: skip
            if critical is not None:
                for sign in (1, -1) if statistic == "h" else (1,):
                    ax.hlines(sign * critical, x - 0.5, x + 0.5, color=GREY, linewidth=0.9, linestyle=(0, (3, 2)))
        middles.append(left + (len(group) - 1) / 2)
        left += len(group) + 1
    ax.axhline(0, color=GREY, linewidth=0.8)
    ax.set_xticks(middles, names, **TEXT)
    ax.set_xlim(-1.2, left - 0.8)
    ax.set_ylim(-1.18 * top if statistic == "h" else 0, 1.18 * top)
    dress(ax, None, f"{statistic} of each {what_of(cells)}")
    ax.grid(False, axis="x")
    ax.tick_params(axis="x", length=0, labelsize=8.5 if len(levels) < 6 else 7.5, labelcolor="black")


def what_of(cells: Sequence[Cell]) -> str:
    """What stands apart or not: samples by their cycles or, where there are none, designs by their samples."""
    return "sample" if any(cell.level for cell in cells) else "design"
