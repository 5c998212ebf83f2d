"""Mandel's h and k of every sample, as ASTM E691 draws them: a line a sample, grouped by design, with critical values."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.study.figures import HALF_IN, OTHER, TEXT, WIDE_IN, new_panel
from benchlab.report.wording import fitted, fitted_apart
from benchlab.stats.consistency import Cell

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_CELLS, MOST_DESIGNS = 80, 40
_MOST_LEVEL = 6  # names that lie side by side


def draw_consistency(cells: Sequence[Cell], statistic: str) -> Figure:
    """h or k (`statistic`) of up to MOST_CELLS cells; those beyond a critical value in another colour, with their names."""
    many = len({_of(cell) for cell in cells}) > _MOST_LEVEL
    figure, ax = new_panel(WIDE_IN if many else HALF_IN, 3.2 if many else 2.5, bottom=1.2 if many else 0.35)
    plot_consistency(ax, cells[:MOST_CELLS], statistic, upright=many)
    return figure


def plot_consistency(ax: Axes, cells: Sequence[Cell], statistic: str, upright: bool = False) -> None:
    """upright: names stand on end. A line from 0 to each value; dashed: critical values, which depend on how many replicates there are."""
    levels = [(level, list(group)) for level, group in groupby(cells, key=_of)]
    names = fitted_apart([level for level, _ in levels], 1.0 if upright else 3.6 / len(levels), TEXT["fontsize"])
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
                ax.annotate(fitted(cell.laboratory, 0.7, 7.5), (x, value), (0, 3 if value > 0 else -10), textcoords="offset points",
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
    ax.tick_params(axis="x", length=0, labelsize=8.5, labelcolor="black", labelrotation=90 if upright else 0)


def _of(cell: Cell) -> str:
    return cell.level or cell.laboratory


def what_of(cells: Sequence[Cell]) -> str:
    """What stands apart or not: samples by their cycles or, where there are none, designs by their samples."""
    return "sample" if any(cell.level for cell in cells) else "design"
