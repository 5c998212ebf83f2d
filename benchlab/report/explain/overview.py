"""One picture for those who look at one: the verdict, the map of the gap, the curves of the largest gaps, before and after."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from benchlab.discrepancy.explanation import Explanation
from benchlab.report.explain.change_figure import Change, plot_changes
from benchlab.report.explain.curves_figure import Kind, is_point, kinds, plot_gap, plot_kind
from benchlab.report.explain.map_figure import colour_limit, gap_map, plot_colours, plot_gap_map
from benchlab.report.explain.names import mark_of, names_of
from benchlab.report.explain.quantity import Quantity, main_quantity
from benchlab.report.explain.tables import by_design, rms
from benchlab.report.explain.words import verdict_title, verdict_words
from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import GREY
from benchlab.report.study.figures import TEXT
from benchlab.report.study.origins import BOLD, write_mark
from benchlab.report.wording import drawable, fitted

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDTH, _LEFT, _MAP, _RIGHT, _GAP = 13.4, 2.9, 3.6, 5.3, 0.75
_HEAD, _FOOT, _TALL_CURVES, _MOST_ROWS = 1.6, 0.55, 4.6, 30
_KEY = 1.0
"""Of the legend's upper end from the top: under the words, over the titles of the panels."""
_BOLD: dict[str, Any] = {**TEXT, "fontweight": "bold"}


def draw_overview(explanation: Explanation) -> Figure:
    """Left: the map of measured − simulated. Right: the designs with the largest gaps, or all as rows, before and after."""
    curves, quantity = explanation.curves, main_quantity(explanation.curves)
    found = gap_map(curves, quantity.name, most=_MOST_ROWS)
    lines = sorted(
        (one for one in kinds(curves, quantity.name) if not is_point(curves, one)), key=lambda one: (one.held, -one.gap)
    )
    rows = [] if lines else _changes(explanation, quantity)
    tall = max(0.26 * len(found.designs), 0.3 + 0.28 * len(rows), _TALL_CURVES if lines else 1.2)
    page = _Page(figure_class()(figsize=(_WIDTH, _HEAD + tall + _FOOT), dpi=DPI), tall)
    _write_words(page.figure, explanation)
    map_tall = min(tall, max(0.3 * len(found.designs), 1.2))
    left = page.axes(_LEFT, _FOOT + tall - map_tall, _MAP, map_tall)
    drawn = plot_gap_map(left, found, colour_limit(curves, quantity.name), True, _LEFT - 0.35)
    left.set_title(f"measured − simulated {quantity.noun}", loc="left", **_BOLD)
    plot_colours(page.figure, left, drawn, quantity)
    if lines:
        heads = _two(lines)
        each = (_RIGHT - _GAP * (len(heads) - 1)) / len(heads)
        for place, one in enumerate(heads):
            _plot_one(page, explanation, one, _WIDTH - 0.2 - _RIGHT + place * (each + _GAP), each)
        _legend(page, page.figure.axes[-1])
    else:
        ax = page.axes(_WIDTH - 0.2 - _RIGHT + 1.2, _FOOT + tall - map_tall, _RIGHT - 1.2, map_tall)
        plot_changes(ax, rows, names_of(explanation)[1], 1.7)
        ax.set_xlabel(f"gap ({quantity.unit})" if quantity.unit else "gap", fontsize=10, parse_math=False)
        _legend(page, ax)
    return page.figure


def _two(lines: Sequence[Kind]) -> list[Kind]:
    """The largest gap, and the largest of another design, or the second largest."""
    others = [one for one in lines[1:] if one.design != lines[0].design] or lines[1:]
    return [*lines[:1], *others[:1]]


def _changes(explanation: Explanation, quantity: Quantity) -> list[Change]:
    curves = explanation.curves
    return [
        Change(design, rms((curves.measured - curves.simulated)[kept]), rms((curves.measured - curves.explained)[kept]))
        for name, design, kept in by_design(curves)
        if name == quantity.name
    ][:_MOST_ROWS]


def _write_words(figure: Figure, explanation: Explanation) -> None:
    height = figure.get_size_inches()[1]
    style: dict[str, Any] = {"parse_math": False, "va": "top"}
    title = verdict_title(explanation)
    figure.text(0.15 / _WIDTH, 1 - 0.12 / height, fitted(title[:1].upper() + title[1:], _WIDTH - 2, 14), fontsize=14,
                fontweight="bold", **style)  # fmt: skip
    write_mark(figure, mark_of(explanation))
    words = textwrap.wrap(drawable(verdict_words(explanation), 420), 165)[:3]
    figure.text(0.15 / _WIDTH, 1 - 0.42 / height, "\n".join(words), fontsize=9.5, color=GREY, **style)


def _plot_one(page: _Page, explanation: Explanation, one: Kind, left: float, width: float) -> None:
    lower = page.axes(left, _FOOT, width, 0.36 * page.tall)
    upper = page.axes(left, _FOOT + 0.41 * page.tall, width, 0.59 * page.tall, lower)
    plot_kind(upper, explanation.curves, one, names_of(explanation))
    plot_gap(lower, explanation.curves, one)
    upper.tick_params(labelbottom=False)
    upper.set_xlabel("")
    lines = [fitted(part, width, 8.5 * BOLD) for part in (one.design, one.kind)]
    upper.set_title("\n".join(filter(None, lines)), loc="left", **_BOLD)


def _legend(page: _Page, ax: Axes) -> None:
    """Above the panels on the right, where there is nothing else."""
    lines, names = ax.get_legend_handles_labels()
    place = (1 - 0.2 / _WIDTH, 1 - _KEY / page.figure.get_size_inches()[1])
    key = page.figure.legend(lines, names, loc="upper right", bbox_to_anchor=place, ncols=3, fontsize=8, frameon=False,
                             borderaxespad=0, borderpad=0)  # fmt: skip
    for text in key.get_texts():
        text.set_parse_math(False)


@dataclass(frozen=True)
class _Page:
    """tall: height over the foot and under the words, in inches."""

    figure: Figure
    tall: float

    def axes(self, left: float, bottom: float, width: float, height: float, above: Axes | None = None) -> Axes:
        whole = self.figure.get_size_inches()[1]
        return self.figure.add_axes((left / _WIDTH, bottom / whole, width / _WIDTH, height / whole), sharex=above)
