"""The panels of a repeatability report, each a small figure of its own: on a page they stand side by side or one below another.

Names are drawn as plain text, cut where they are long. Colours are those of `report.panels`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.report.document import cut_apart
from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BAND, BLUE, GREY, dress
from benchlab.report.study.brackets import Bracket, stack_brackets
from benchlab.report.wording import drawable
from benchlab.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HALF_IN, THIRD_IN = 4.7, 3.1
"""Widths of panels, two and three abreast on a page of 9.8 in."""

TITLE_IN = 0.32
"""Height over the axes for a title."""

MOST_BRACKETED, MOST_ROWS = 6, 40
"""Groups up to which bars stand with brackets; rows up to which groups or pairs are drawn at all."""

OTHER = "#D55E00"
"""Colour of what stands beside the first: simulated, the other method, beyond a limit."""

TEXT: dict[str, Any] = {"parse_math": False, "fontsize": 8.5}
_POINT = "#333333"
_BARS_IN, _STEP_IN, _ROW_IN = 2.55, 0.21, 0.22
_BAR_IN, _ROWS_IN = 0.64, 4.2  # width of a bar, and of a panel of rows
_TICK_LETTERS = 8  # that fit under a bar


@dataclass(frozen=True)
class Bar:
    """A group of samples: their values, mean and standard deviation, and what was simulated for it."""

    name: str
    values: FloatArray
    mean: float
    sd: float | None
    simulated: float | None = None


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


def draw_bars(bars: Sequence[Bar], pairs: Sequence[tuple[int, int, str]], label: str, title: str) -> Figure:
    """Means as bars with ± SD and every sample as a point; brackets with the labels of `pairs` (bar, bar, stars) over them.

    More than MOST_BRACKETED groups lie as rows without brackets, of which the first MOST_ROWS are drawn.
    """
    if len(bars) > MOST_BRACKETED:
        shown = bars[:MOST_ROWS]
        figure, ax = new_panel(_ROWS_IN, 1.3 + _ROW_IN * len(shown), bottom=0.9, top=TITLE_IN)
        plot_rows(ax, shown, label)
    else:
        height = _BARS_IN + _STEP_IN * (_levels(pairs) + 1)
        figure, ax = new_panel(0.72 + _BAR_IN * max(len(bars), 3), height + 0.82 + TITLE_IN, bottom=0.82, top=TITLE_IN)
        plot_bars(ax, bars, pairs, label, _BARS_IN, _STEP_IN)
    _finish(figure, ax, title, columns=2)
    return figure


def plot_bars(
    ax: Axes,
    bars: Sequence[Bar],
    pairs: Sequence[tuple[int, int, str]],
    label: str,
    bars_in: float = _BARS_IN,
    step_in: float = _STEP_IN,
) -> None:
    """Bars, points and brackets in the manner of the paper's Figs 6c and 7c. bars_in: inches of height for the bars themselves."""
    at = np.arange(len(bars), dtype=float)
    means = np.array([bar.mean for bar in bars])
    ax.bar(at, means, width=0.56, color=BAND, edgecolor=BLUE, linewidth=1, label="mean")
    for x, bar in zip(at, bars):
        ax.plot(x + 0.2 * spread(len(bar.values)), bar.values, "o", markersize=3.4, color=_POINT, markerfacecolor="white",
                markeredgewidth=0.8, zorder=3, label="one sample" if x == 0 else None)  # fmt: skip
    _error_bars(ax, at, bars, upright=True)
    _simulated(ax, at + 0.36, bars, upright=True)
    reach = [max(0.0, _highest(bar)) for bar in bars]
    bottom = min(0.0, *(_lowest(bar) for bar in bars))
    per_in = max(max(reach) - bottom, 1e-9) / bars_in
    brackets = stack_brackets(pairs, reach, step_in * per_in)
    for bracket in brackets:
        _plot_bracket(ax, bracket, 0.07 * per_in)
    top = max([*reach, *(bracket.height for bracket in brackets)])
    ax.set_ylim(bottom * 1.06, top + 1.1 * step_in * per_in)
    ax.set_xlim(-0.6, len(bars) - 0.4)
    ax.set_xticks(at, _two_lines([bar.name for bar in bars], _TICK_LETTERS * max(3 // len(bars), 1)), **TEXT)
    dress(ax, None, label)
    ax.grid(False, axis="x")
    ax.tick_params(axis="x", length=0, labelsize=8.5, labelcolor="black")


def plot_rows(ax: Axes, bars: Sequence[Bar], label: str) -> None:
    """Groups as rows, the first on top: mean, ± SD and points."""
    at = np.arange(len(bars), dtype=float)
    for y, bar in zip(at, bars):
        ax.plot(bar.values, y + 0.25 * spread(len(bar.values)), "o", markersize=2.6, color=_POINT, markerfacecolor="white",
                markeredgewidth=0.7, label="one sample" if y == 0 else None)  # fmt: skip
    means = np.array([bar.mean for bar in bars])
    ax.plot(means, at, "s", color=BLUE, markersize=4, label="mean", zorder=4)
    _error_bars(ax, at, bars, upright=False)
    _simulated(ax, at, bars, upright=False)
    _name_rows(ax, [bar.name for bar in bars])
    dress(ax, label, None)
    ax.grid(False, axis="y")


def draw_intervals(intervals: Sequence[Interval], label: str, confidence: float, title: str) -> Figure:
    """Differences of means with simultaneous intervals, a row a pair; the first MOST_ROWS of them."""
    shown = intervals[:MOST_ROWS]
    figure, ax = new_panel(HALF_IN, 0.83 + TITLE_IN + 0.27 * len(shown), bottom=0.73, top=TITLE_IN)
    plot_intervals(ax, shown, label, confidence)
    _finish(figure, ax, title, columns=2)
    return figure


def plot_intervals(ax: Axes, intervals: Sequence[Interval], label: str, confidence: float) -> None:
    """Tukey's interval over that of Games and Howell for each pair, against a line at no difference."""
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
    _name_rows(ax, [one.name for one in intervals], 26)
    ax.margins(x=0.06)
    dress(ax, label, None)
    ax.grid(False, axis="y")


def draw_angle_band(band: AngleBand, y_limits: tuple[float, float] | None = None) -> Figure:
    """θ against pressure of one design; y_limits: those that it shares with the other designs."""
    figure, ax = new_panel(THIRD_IN, 2.5, left=0.55, bottom=0.46, top=TITLE_IN)
    plot_angle_band(ax, band)
    if y_limits is not None:
        ax.set_ylim(*y_limits)
    write_title(figure, band.name)
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


def spread(count: int) -> FloatArray:
    """Where points of a group stand across it, from −1 to 1: van der Corput's sequence, so that neighbours are apart.

    >>> spread(3).tolist(), spread(1).tolist()
    ([0.0, -0.5, 0.5], [0.0])
    """
    found = np.zeros(count)
    for index in range(count):
        rest, share = index + 1, 0.5
        while rest:
            found[index] += share * (rest & 1)
            rest, share = rest >> 1, share / 2
    return 2 * found - 1


def new_panel(width: float, height: float, bottom: float, left: float = 0.62, top: float = 0.12) -> tuple[Figure, Axes]:
    """A figure of one axes; all in inches."""
    figure = figure_class()(figsize=(width, height), dpi=DPI)
    box = (left / width, bottom / height, (width - left - 0.1) / width, (height - bottom - top) / height)
    return figure, figure.add_axes(box)


def write_title(figure: Figure, title: str) -> None:
    """What a panel is of, over its left end, cut to its width."""
    width, height = figure.get_size_inches()
    figure.text(0.06 / width, 1 - 0.06 / height, drawable(title, int(width / 0.1)), va="top", fontsize=9.5, fontweight="bold",
                parse_math=False)  # fmt: skip


def _finish(figure: Figure, ax: Axes, title: str, columns: int) -> None:
    """The title, room on the left for what stands there, and the legend at the foot."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    write_title(figure, title)
    legend = figure.legend(*ax.get_legend_handles_labels(), loc="lower center", bbox_to_anchor=(0.5, 0.0), ncols=columns, fontsize=8.5,
                           frameon=False, borderaxespad=0.3, columnspacing=1.6, handletextpad=0.5)  # fmt: skip
    legend.set_in_layout(False)
    canvas = FigureCanvasAgg(figure)
    box, width = ax.get_position(), figure.bbox.width
    drawn = ax.yaxis.get_tightbbox(canvas.get_renderer())
    left = 0.08 * DPI / width + (box.x0 - drawn.x0 / width if drawn else 0.0)
    ax.set_position((left, box.y0, box.x1 - left, box.height))


def _two_lines(names: Sequence[str], length: int) -> list[str]:
    """Names for under bars: if one is too long for a line, all are broken after a sign between words; what is still too long is cut."""
    whole = [drawable(name, 10_000) for name in names]
    if all(len(name) <= length for name in whole):
        return whole
    broken = [_broken(name, length) for name in whole]
    return (
        broken if len(set(broken)) == len(set(names)) else [drawable(name, 10_000) for name in cut_apart(names, length)]
    )


def _broken(name: str, length: int) -> str:
    breaks = [i + 1 for i, c in enumerate(name[:length]) if c in " _-,;/" and len(name) - i - 1 <= length]
    middle = min(breaks, key=lambda i: abs(2 * i - len(name)), default=None)
    return drawable(name, length) if middle is None else f"{name[:middle].rstrip()}\n{name[middle:]}"


def _levels(pairs: Sequence[tuple[int, int, str]]) -> int:
    """Storeys that brackets need at most over bars of one height."""
    count = 1 + max((max(a, b) for a, b, _ in pairs), default=0)
    return round(max((b.height for b in stack_brackets(pairs, [0.0] * count, 1.0)), default=0.0))


def _plot_bracket(ax: Axes, bracket: Bracket, tick: float) -> None:
    left, right, y = bracket.left + 0.05, bracket.right - 0.05, bracket.height
    ax.plot([left, left, right, right], [y - tick, y, y, y - tick], color=_POINT, linewidth=0.8, zorder=4)
    stars = set(bracket.label) <= {"*"}
    ax.annotate(bracket.label, ((left + right) / 2, y), (0, -2.5 if stars else 0.8), textcoords="offset points", ha="center",
                va="bottom", parse_math=False, fontsize=9.5 if stars else 7.5)  # fmt: skip


def _error_bars(ax: Axes, at: FloatArray, bars: Sequence[Bar], upright: bool) -> None:
    known = [(x, bar.mean, bar.sd) for x, bar in zip(at, bars) if bar.sd is not None]
    if known:
        x, mean, sd = np.array(known, dtype=float).T
        style: dict[str, Any] = {"fmt": "none", "ecolor": "black", "elinewidth": 1.1, "capsize": 3.5, "zorder": 5}
        if upright:
            ax.errorbar(x, mean, yerr=sd, label="± 1 SD", **style)
        else:
            ax.errorbar(mean, x, xerr=sd, label="± 1 SD", **style)


def _simulated(ax: Axes, at: FloatArray, bars: Sequence[Bar], upright: bool) -> None:
    known = [(x, bar.simulated) for x, bar in zip(at, bars) if bar.simulated is not None]
    if known:
        x, angle = np.array(known, dtype=float).T
        across, along = (x, angle) if upright else (angle, x)
        ax.plot(across, along, "D", color=OTHER, markersize=4.5, markerfacecolor="white", markeredgewidth=1.2, zorder=6,
                label="simulated")  # fmt: skip


def _highest(bar: Bar) -> float:
    known = [bar.mean + (bar.sd or 0.0), *bar.values.tolist()]
    return max(known if bar.simulated is None else [*known, bar.simulated])


def _lowest(bar: Bar) -> float:
    known = [bar.mean - (bar.sd or 0.0), *bar.values.tolist()]
    return min(known if bar.simulated is None else [*known, bar.simulated])


def _name_rows(ax: Axes, names: Sequence[str], length: int = 22) -> None:
    ax.set_yticks(range(len(names)), [drawable(name, 10_000) for name in cut_apart(names, length)], **TEXT)
    ax.set_ylim(len(names) - 0.4, -0.6)
    ax.tick_params(axis="y", length=0)
