"""The panels of a repeatability report, each a small figure of its own: on a page they stand side by side or one below another.

Names are drawn as plain text, cut where they are long. Colours are those of `report.panels`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BAND, BLUE, GREY, dress
from benchlab.report.wording import fitted, fitted_apart
from benchlab.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDE_IN, HALF_IN, THIRD_IN = 7.0, 4.7, 3.1
"""Widths of panels, one, two and three abreast on a page of 9.8 in."""

TITLE_IN = 0.32
"""Height over the axes for a title."""

MOST_ROWS = 40
"""Rows up to which groups or pairs are drawn at all."""

OTHER = "#D55E00"
"""Colour of what stands beside the first: simulated, the other method, beyond a limit."""

TEXT: dict[str, Any] = {"parse_math": False, "fontsize": 8.5}


@dataclass(frozen=True)
class Interval:
    """Confidence intervals of one difference of means by two methods, each (difference, low, high)."""

    name: str
    tukey: tuple[float, float, float] | None
    games_howell: tuple[float, float, float] | None


@dataclass(frozen=True)
class AngleBand:
    """θ against pressure of one design: mean over samples and their standard deviation, at (P,) pressures; curves of single samples
    (pressure, angle); the simulated curve (pressure, angle) where there is one."""

    name: str
    pressure_MPa: FloatArray
    mean_deg: FloatArray
    sd_deg: FloatArray
    curves: tuple[tuple[FloatArray, FloatArray], ...] = ()
    simulated: tuple[FloatArray, FloatArray] | None = field(default=None)


def draw_intervals(
    intervals: Sequence[Interval], label: str, confidence: float, title: str, width_in: float = HALF_IN
) -> Figure:
    """Differences of means with simultaneous intervals, a row a pair; the first MOST_ROWS of them."""
    shown = intervals[:MOST_ROWS]
    figure, ax = new_panel(width_in, 0.83 + TITLE_IN + 0.27 * len(shown), bottom=0.73, top=TITLE_IN)
    plot_intervals(ax, shown, label, confidence, 0.4 * width_in)
    finish(figure, ax, title, columns=2)
    return figure


def plot_intervals(ax: Axes, intervals: Sequence[Interval], label: str, confidence: float, name_in: float) -> None:
    """name_in: inches for a name. Tukey's interval over that of Games and Howell for each pair, against a line at no difference."""
    ax.axvline(0, color=GREY, linewidth=0.9, zorder=1)
    for index, (name, colour, marker, offset) in enumerate(
        (("Tukey HSD", BLUE, "o", -0.17), ("Games–Howell", OTHER, "s", 0.17))
    ):
        found = [(y, one.games_howell if index else one.tukey) for y, one in enumerate(intervals)]
        rows = [(y + offset, *values) for y, values in found if values is not None]
        if rows:
            y, middle, low, high = np.array(rows).T
            ax.hlines(y, low, high, color=colour, linewidth=1.5)
            ax.plot(middle, y, marker, color=colour, markersize=3.8, label=f"{name}, {100 * confidence:g} %")
    name_rows(ax, [one.name for one in intervals], name_in)
    ax.margins(x=0.06)
    dress(ax, label, None)
    ax.grid(False, axis="y")


def draw_angle_band(band: AngleBand, y_limits: tuple[float, float] | None = None, width_in: float = THIRD_IN) -> Figure:
    """θ against pressure of one design; y_limits: those that it shares with the other designs."""
    figure, ax = new_panel(width_in, 2.5 if width_in == THIRD_IN else 3.2, bottom=0.46, top=TITLE_IN)
    plot_angle_band(ax, band)
    if y_limits is not None:
        ax.set_ylim(*y_limits)
    write_title(figure, band.name)
    make_room(figure, ax)
    return figure


def plot_angle_band(ax: Axes, band: AngleBand) -> None:
    """Thin lines: samples. Band: mean ± SD between them. Dashed: simulated."""
    for pressure, angle in band.curves:
        ax.plot(pressure, angle, color=GREY, linewidth=0.5, alpha=0.7, zorder=2)
    low, high = band.mean_deg - band.sd_deg, band.mean_deg + band.sd_deg
    ax.fill_between(band.pressure_MPa, low, high, color=BAND, linewidth=0, zorder=1)
    ax.plot(band.pressure_MPa, band.mean_deg, color=BLUE, linewidth=1.5, zorder=3)
    if band.simulated is not None:
        ax.plot(*band.simulated, color=OTHER, linewidth=1.3, linestyle=(0, (4, 2)), zorder=4)
    ax.margins(x=0)
    dress(ax, "pressure (MPa)", "bending angle θ (°)")


def new_panel(width: float, height: float, bottom: float, top: float = 0.12, left: float = 0.62) -> tuple[Figure, Axes]:
    """A figure of one axes; all in inches."""
    figure = figure_class()(figsize=(width, height), dpi=DPI)
    box = (left / width, bottom / height, (width - left - 0.18) / width, (height - bottom - top) / height)
    return figure, figure.add_axes(box)


def write_title(figure: Figure, title: str) -> None:
    """What a panel is of, over its left end, cut to its width."""
    width, height = figure.get_size_inches()
    figure.text(0.06 / width, 1 - 0.06 / height, fitted(title, 0.8 * width, 9.5), va="top", fontsize=9.5, fontweight="bold",
                parse_math=False)  # fmt: skip


def finish(figure: Figure, ax: Axes, title: str, columns: int) -> None:
    """The title, room on the left for what stands there, and the legend at the foot."""
    write_title(figure, title)
    legend = figure.legend(*ax.get_legend_handles_labels(), loc="lower center", bbox_to_anchor=(0.5, 0.0), ncols=columns, fontsize=8.5,
                           frameon=False, borderaxespad=0.3, columnspacing=1.6, handletextpad=0.5)  # fmt: skip
    legend.set_in_layout(False)
    for text in legend.get_texts():
        text.set_parse_math(False)
    make_room(figure, ax)


def make_room(figure: Figure, ax: Axes) -> None:
    """Let the axes begin where what stands on their left has room."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    box, width = ax.get_position(), figure.bbox.width
    drawn = ax.yaxis.get_tightbbox(canvas.get_renderer())
    left = 0.08 * DPI / width + (box.x0 - drawn.x0 / width if drawn else 0.0)
    ax.set_position((left, box.y0, box.x1 - left, box.height))


def name_rows(ax: Axes, names: Sequence[str], inches: float) -> None:
    """Names on the left of rows, the first on top, each up to so many inches wide."""
    ax.set_yticks(range(len(names)), fitted_apart(names, inches, TEXT["fontsize"]), **TEXT)
    ax.set_ylim(len(names) - 0.4, -0.6)
    ax.tick_params(axis="y", length=0)
