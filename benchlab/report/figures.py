"""The picture of one recording: bending angle over time and pressure with its band, and how well the circle fits.

Drawn with matplotlib's objects alone (no pyplot, no global state), so that several may be drawn at once.
"""

from __future__ import annotations

import logging
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from benchlab.report.panels import (
    FLAG_STYLES,
    GREY,
    plot_angle_over_pressure,
    plot_angle_over_time,
    plot_flags,
    plot_residual,
    time_axis,
)
from benchlab.report.wording import drawable, flag_groups
from benchlab.vision.series import CurvatureSeries

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DPI = 150

# The page, in inches: a column of panels, or two; title above, legend below.
_WIDTH, _WIDTH_OF_TWO = 8.0, 11.5
_LEFT, _RIGHT, _BETWEEN = 0.72, 0.2, 0.8
_TITLE, _GAP, _FOOT = 0.74, 0.12, 0.55
_ANGLE, _RESIDUAL, _FLAG_ROW, _LEGEND_ROW = 3.2, 0.9, 0.15, 0.19
_TITLE_LETTER, _NOTE_LETTER, _LEGEND_LETTER = 0.122, 0.083, 0.066  # widths of a letter, on the average


@dataclass(frozen=True)
class _Page:
    """Heights from the bottom and widths, in inches, of a figure with n flag rows and legend rows."""

    two: bool
    flag_rows: int
    legend_rows: int

    @property
    def width(self) -> float:
        return _WIDTH_OF_TWO if self.two else _WIDTH

    @property
    def panel(self) -> float:
        return (self.width - _LEFT - _RIGHT - _BETWEEN * self.two) / (1 + self.two)

    @property
    def residual(self) -> float:
        return _GAP + self.legend_rows * _LEGEND_ROW + _FOOT

    @property
    def flags(self) -> float:
        return self.residual + _RESIDUAL + _GAP

    @property
    def angle(self) -> float:
        return self.flags + (self.flag_rows * _FLAG_ROW + _GAP if self.flag_rows else 0)

    @property
    def height(self) -> float:
        return self.angle + _ANGLE + _TITLE

    def axes(self, figure: Figure, column: int, bottom: float, top: float, beside: Axes | None = None) -> Axes:
        left = _LEFT + column * (self.panel + _BETWEEN)
        box = (left / self.width, bottom / self.height, self.panel / self.width, (top - bottom) / self.height)
        return figure.add_axes(box, sharex=beside)


def draw_curvature_figure(series: CurvatureSeries, title: str, note: str = "") -> Figure:
    """The figure of a series: θ over time, or over the picture number for stills, and θ over pressure where it is known;
    below them the flagged frames, with why and how many, and the residual of the circle.

    `title` and `note` are shown as plain text, cut where they are too long for the page.
    """
    pressure = (
        series.pressure_MPa if series.pressure_MPa is not None and np.isfinite(series.pressure_MPa).any() else None
    )
    new_figure = figure_class()
    groups = flag_groups(series, len(FLAG_STYLES))
    labels = ["bending angle θ", "± 2 standard deviations", *(label for label, _ in groups)]
    letters = max(map(len, labels)) * _LEGEND_LETTER + 0.5
    columns = max(1, int(((_WIDTH if pressure is None else _WIDTH_OF_TWO) - _LEFT) / letters))
    page = _Page(pressure is not None, len(groups), math.ceil(len(labels) / columns))
    figure = new_figure(figsize=(page.width, page.height), dpi=DPI)

    upper = page.axes(figure, 0, page.angle, page.angle + _ANGLE)
    plot_angle_over_time(upper, series)
    plot_residual(page.axes(figure, 0, page.residual, page.residual + _RESIDUAL, upper), series, *time_axis(series))
    shown = [*upper.get_legend_handles_labels()[0][:2]]
    if groups:
        rows = page.axes(figure, 0, page.flags, page.angle - _GAP, upper)
        shown += plot_flags(rows, time_axis(series)[0], groups)
    if pressure is not None:
        second = page.axes(figure, 1, page.flags, page.angle + _ANGLE)
        plot_angle_over_pressure(second, series)
        lower = page.axes(figure, 1, page.residual, page.residual + _RESIDUAL, second)
        plot_residual(lower, series, pressure, "pressure (MPa)")
    _write_words(figure, page, title, note)
    _write_legend(figure, page, shown, labels, columns)
    return figure


def save_png(figure: Figure, path: Path | BinaryIO) -> None:
    """Write a figure as PNG at 150 dpi. OSError where the disk refuses."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(figure)
    figure.savefig(path, format="png", dpi=DPI, metadata={"Software": "benchlab"}, pil_kwargs={"compress_level": 2})


def figure_class() -> type[Figure]:
    """matplotlib's Figure. A home folder that cannot be written is no news: it costs some tenths of a second."""
    logger = logging.getLogger("matplotlib")
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        from matplotlib.figure import Figure
    finally:
        logger.setLevel(level)
    return Figure


def _write_words(figure: Figure, page: _Page, title: str, note: str) -> None:
    room = page.width - _LEFT - _RIGHT
    left = _LEFT / page.width
    big: dict[str, Any] = {"fontsize": 12, "fontweight": "bold", "parse_math": False}
    small: dict[str, Any] = {"fontsize": 9.5, "color": GREY, "parse_math": False}
    figure.text(left, 1 - 0.34 / page.height, drawable(title, int(room / _TITLE_LETTER)), **big)
    figure.text(left, 1 - 0.59 / page.height, drawable(note, int(room / _NOTE_LETTER)), **small)


def _write_legend(figure: Figure, page: _Page, shown: list[Any], labels: list[str], columns: int) -> None:
    legend = figure.legend(
        shown, labels, loc="lower left", bbox_to_anchor=((_LEFT - 0.06) / page.width, 0.6 * _GAP / page.height),
        ncols=columns, fontsize=9, frameon=False, borderpad=0, borderaxespad=0, columnspacing=1.5, labelspacing=0.45,
    )  # fmt: skip
    for text in legend.get_texts():
        text.set_parse_math(False)
