"""The picture of a plan: pressure against time, its segments named, its limit, marks and triggers; in closed loop the angle below it."""

from __future__ import annotations

from itertools import groupby, pairwise
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from benchlab.protocol.plan import Plan
from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.protocol_strip import (
    LETTERS,
    RIGHT_IN,
    ROW_IN,
    STRIP_IN,
    event_rows,
    lined,
    named,
    plot_events,
    plot_key,
    plot_segments,
)
from benchlab.report.wording import fitted, width_in
from benchlab.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LIMIT = "#D55E00"
_CONTROLLED = "the controller decides, from 0 to the limit"
MAX_DRAWN = 20_000
"""Ticks up to which each is drawn; of longer plans, the lowest and the highest of each short stretch."""

_WIDTH, _LEFT = 9.0, 0.75
_ROOM = _WIDTH - _LEFT - RIGHT_IN
_TITLE, _GAP, _FOOT, _PRESSURE, _ANGLE = 0.72, 0.1, 0.55, 2.7, 2.0


def draw_protocol_figure(plan: Plan, note: str = "", ceiling_MPa: float | None = None) -> Figure:
    """The figure of a plan. note: a line below the title. ceiling_MPa: of the bench it is shown for, drawn beside the protocol's limit."""
    words = ROW_IN * (max(event_rows(named(plan.events), plan.duration_s, _ROOM), default=-1) + 1)
    panels = _FOOT + (_ANGLE + 2 * _GAP) * plan.closed_loop
    height = panels + _PRESSURE + _GAP + STRIP_IN + words + _TITLE
    figure = figure_class()(figsize=(_WIDTH, height), dpi=DPI)

    def axes(bottom: float, tall: float, above: Axes | None = None) -> Axes:
        box = (_LEFT / _WIDTH, bottom / height, _ROOM / _WIDTH, tall / height)
        return figure.add_axes(box, sharex=above)

    upper = axes(panels, _PRESSURE)
    plot_pressure(upper, plan, ceiling_MPa)
    lines = [upper]
    if plan.closed_loop:
        lower = axes(_FOOT, _ANGLE, upper)
        plot_reference(lower, plan)
        upper.tick_params(labelbottom=False)
        upper.set_xlabel("")
        lines.append(lower)
    strip = axes(panels + _PRESSURE + _GAP, STRIP_IN, upper)
    plot_segments(strip, plan, _ROOM)
    plot_events(strip, lines, plan, _ROOM)
    big: dict[str, Any] = {"fontsize": 12, "fontweight": "bold", "parse_math": False}
    figure.text(_LEFT / _WIDTH, 1 - 0.3 / height, fitted(plan.title, 0.9 * _ROOM, 12), **big)
    small: dict[str, Any] = {"fontsize": 9, "color": GREY, "parse_math": False}
    hidden = len(plan.events) - len(lined(plan.events))
    more = f"; {hidden} marks and triggers are not drawn" if hidden else ""
    line = 1 - 0.53 / height
    key_in = plot_key(figure, plan, (_LEFT + _ROOM) / _WIDTH, line + 0.04 / height)
    figure.text(_LEFT / _WIDTH, line, fitted(note + more, _ROOM - key_in - 0.1, 9), **small)
    return figure


def plot_pressure(ax: Axes, plan: Plan, ceiling_MPa: float | None = None) -> None:
    """Pressure asked for in MPa over s; where a controller decides, the range that it may use."""
    kept = drawn_ticks(plan.pressure_MPa, plan.step)
    ax.plot(plan.time_s[kept], plan.pressure_MPa[kept], color=BLUE, linewidth=1.4, drawstyle="steps-post", zorder=2.3)
    top = plan.limit_MPa if ceiling_MPa is None else min(plan.limit_MPa, ceiling_MPa)
    for first, last in closed_spans(plan):
        ax.fill_between([first, last], 0, top, color="#eeeeee", linewidth=0, zorder=1)
        if width_in(_CONTROLLED, LETTERS) < _ROOM * (last - first) / plan.duration_s:
            style: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": LETTERS, "color": GREY}
            ax.text((first + last) / 2, top / 2, _CONTROLLED, **style)
    _limit_line(ax, plan.limit_MPa, f"limit of the protocol {plan.limit_MPa:g} MPa", "right")
    if ceiling_MPa is not None:
        _limit_line(ax, ceiling_MPa, f"ceiling of the bench {ceiling_MPa:.4g} MPa", "left")
    highest = max(plan.limit_MPa, ceiling_MPa or 0.0)
    ax.set_ylim(-0.03 * highest, 1.12 * highest)
    ax.set_xlim(0, max(plan.duration_s, 1 / plan.rate_Hz))
    dress(ax, "time (s)", "pressure (MPa)")


def plot_reference(ax: Axes, plan: Plan) -> None:
    """The angle that a controller follows, in degrees over s."""
    kept = drawn_ticks(plan.reference_deg, plan.step)
    ax.plot(plan.time_s[kept], plan.reference_deg[kept], color=BLUE, linewidth=1.4, drawstyle="steps-post")
    ax.set_ylim(0, 1.08 * max(float(np.nanmax(plan.reference_deg)), 1.0))
    dress(ax, "time (s)", "reference angle θ (°)")


def drawn_ticks(values: FloatArray, step: NDArray[np.int64]) -> NDArray[np.int64]:
    """Indices of the ticks that are drawn: all, or the lowest and highest of each stretch, and the first and last of each step."""
    if len(values) <= MAX_DRAWN:
        return np.arange(len(values))
    edges = np.linspace(0, len(values), MAX_DRAWN // 2 + 1).astype(int)
    borders = np.flatnonzero(np.diff(step))
    low = [first + int(np.argmin(values[first:last])) for first, last in pairwise(edges)]
    high = [first + int(np.argmax(values[first:last])) for first, last in pairwise(edges)]
    some = borders[:: 1 + len(borders) // MAX_DRAWN]
    return np.unique(np.concatenate([low, high, some, some + 1, [0, len(values) - 1]]).astype(np.int64))


def closed_spans(plan: Plan) -> list[tuple[float, float]]:
    """Start and end (s) of each stretch in which a controller decides."""
    groups = groupby(plan.steps, lambda step: step.kind == "curvature")
    spans = [(closed, list(steps)) for closed, steps in groups]
    return [(steps[0].start_s, steps[-1].end_s) for closed, steps in spans if closed]


def _limit_line(ax: Axes, pressure_MPa: float, text: str, side: Literal["left", "right"]) -> None:
    """A line across the axes, its words above it at one end."""
    ax.axhline(pressure_MPa, color=LIMIT, linewidth=0.9, linestyle=(0, (5, 3)), zorder=2)
    at, points = (1, -2) if side == "right" else (0, 4)
    where: dict[str, Any] = {
        "xycoords": ax.get_yaxis_transform(),
        "textcoords": "offset points",
        "ha": side,
        "va": "bottom",
    }
    paper = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}
    ax.annotate(text, (at, pressure_MPa), (points, 2), fontsize=LETTERS, color=LIMIT, bbox=paper, **where)
