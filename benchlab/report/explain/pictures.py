"""The figures of the report with their captions."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from benchlab.discrepancy.explanation import Explanation
from benchlab.protocol.plan import Plan
from benchlab.report.document import Panel, Pictures
from benchlab.report.explain.change_figure import Change, draw_changes
from benchlab.report.explain.curves_figure import (
    MOST_PANELS,
    Kind,
    chosen,
    draw_kind,
    draw_points,
    is_point,
    kinds,
    limits_of,
)
from benchlab.report.explain.map_figure import ALPHA, GapMap, Model, colour_limit, draw_gap_map, gap_map
from benchlab.report.explain.names import mark_of, names_of
from benchlab.report.explain.overview import draw_overview
from benchlab.report.explain.quantity import Quantity, main_quantity, quantities_of
from benchlab.report.figures import save_png
from benchlab.report.protocol_figure import draw_protocol_figure
from benchlab.report.study.figures import MOST_ROWS
from benchlab.report.study.origins import write_mark
from benchlab.report.study.pictures import file_names
from benchlab.report.svg import panel_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OVERVIEW = "explain.png"
"""The picture for those who look at one."""


def write_overview(explanation: Explanation, path: Path) -> None:
    save_png(draw_overview(explanation), path)


def map_pictures(explanation: Explanation, model: Model = "simulated") -> Pictures:
    """A map a quantity: of the gap to the simulation, or to the model with what was named."""
    before = model == "simulated"
    panels, hidden = [], 0
    curves = explanation.curves
    for quantity in quantities_of(curves):
        found: GapMap = gap_map(curves, quantity.name, model)
        hidden = max(hidden, found.hidden)
        title = f"{quantity.noun}: measured − {'simulated' if before else names_of(explanation)[1]}"
        figure = draw_gap_map(found, quantity, title, colour_limit(curves, quantity.name), dots=before)
        name = f"{'gap' if before else 'left'}_{file_names([quantity.name])[0]}"
        panels.append(_panel(explanation, figure, name, title))
    caption = "Red: measured is more; blue: less; colours end at the largest gap of the simulation, or two standard deviations of a sample."
    if before:
        dots = "" if explanation.only_described else f" Dots: p < {ALPHA:g} for all places looked at together."
        caption = f"Where measured and simulated differ. {caption}{dots}"
    else:
        caption = f"What is left {names_of(explanation)[1]}, in the colours of the first figure. {caption}"
    left_off = f" The designs with the largest gaps are drawn; {hidden} others are in curves.csv." if hidden else ""
    return Pictures(tuple(panels), caption + left_off)


def curves_pictures(explanation: Explanation) -> Iterator[Pictures]:
    """Of each quantity the curves, by design and kind of run; of tables of means a row a design."""
    curves, names = explanation.curves, names_of(explanation)
    for quantity in quantities_of(curves):
        found = kinds(curves, quantity.name)
        points = [one for one in found if is_point(curves, one)]
        lines = [one for one in found if not is_point(curves, one)]
        if lines:
            yield _lines(explanation, lines, quantity)
        if points:
            figure = draw_points(curves, points[:MOST_ROWS], names, quantity)
            panel = _panel(explanation, figure, f"means_{file_names([quantity.name])[0]}", f"Means of {quantity.noun}")
            yield Pictures(
                (panel,),
                f"Measured means with ± 1 standard deviation between samples, and models.{_off(points, MOST_ROWS)}",
            )


def _lines(explanation: Explanation, lines: list[Kind], quantity: Quantity) -> Pictures:
    shown, limits = chosen(lines), limits_of(explanation.curves, quantity.name)
    files = file_names([f"{quantity.name} {one.design} {one.kind}" for one in shown])
    panels = tuple(
        _panel(
            explanation,
            draw_kind(explanation.curves, one, names_of(explanation), limits, legend=place == 0),
            f"curve_{name}",
            f"{quantity.noun} of {one.title}",
        )
        for place, (one, name) in enumerate(zip(shown, files))
    )
    after = f" Green: {names_of(explanation)[1]}." * bool(explanation.effects)
    caption = (
        "Upper: blue line and band, mean of the samples ± 1 standard deviation between them (▴ loading, ▾ unloading; of several cycles the "
        f"first, pale, and the last). Dashed: simulated.{after} Lower: measured less model, ± 1 standard deviation of a sample about 0."
    )
    return Pictures(panels, caption + _off(lines, MOST_PANELS))


def changes_picture(explanation: Explanation, rows: Sequence[Change], name: str, title: str) -> Pictures:
    """Gaps before and after as rows."""
    figure = draw_changes(rows, main_quantity(explanation.curves), names_of(explanation)[1], title)
    caption = "Diamonds: root mean square gap of the simulation. Dots: after."
    if any(math.isfinite(row.noise_floor) for row in rows):
        caption += " Strokes: noise floor, as near as a faultless model is expected to come."
    return Pictures((_panel(explanation, figure, name, title),), caption + _off(rows, MOST_ROWS))


def protocol_pictures(plan: Plan) -> Pictures:
    """The protocol of the next experiment."""
    panel = panel_of(draw_protocol_figure(plan), "next_experiment", f"Pressure against time of {plan.title}")
    return Pictures((panel,), "The next experiment: the pressure that is asked for.")


def _off(rows: Sequence[object], most: int) -> str:
    return f" {most} of {len(rows)} are drawn." if len(rows) > most else ""


def _panel(explanation: Explanation, figure: Figure, name: str, words: str) -> Panel:
    """A panel that says so where its data are simulated."""
    write_mark(figure, mark_of(explanation))
    return panel_of(figure, name, words + _in_brackets(explanation))


def _in_brackets(explanation: Explanation) -> str:
    return f" ({mark_of(explanation)})" if explanation.simulated else ""
