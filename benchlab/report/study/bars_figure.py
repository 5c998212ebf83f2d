"""Means of designs as bars with every sample as a point, in the manner of the paper's Figs 6c and 7c; many of them as rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.report.panels import BAND, BLUE, dress
from benchlab.report.study.brackets import Bracket, stack_brackets
from benchlab.report.study.figures import MOST_ROWS, OTHER, TEXT, TITLE_IN, WIDE_IN, finish, name_rows, new_panel
from benchlab.report.wording import drawable, fitted, fitted_apart, width_in
from benchlab.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_BRACKETED = 6
"""Groups up to which bars stand with brackets."""

_POINT = "#333333"
_BARS_IN, _STEP_IN, _ROW_IN = 2.55, 0.21, 0.22


@dataclass(frozen=True)
class Bar:
    """A group of samples: their values, mean and standard deviation, and what was simulated for it."""

    name: str
    values: FloatArray
    mean: float
    sd: float | None
    simulated: float | None = None


def draw_bars(
    bars: Sequence[Bar], pairs: Sequence[tuple[int, int, str]], label: str, title: str, bar_in: float = 0.64
) -> Figure:
    """Means as bars with ± SD and every sample as a point; brackets with the labels of `pairs` (bar, bar, stars) over them.
    bar_in: inches of width for each.

    More than MOST_BRACKETED groups lie as rows without brackets, of which the first MOST_ROWS are drawn.
    """
    if len(bars) > MOST_BRACKETED:
        shown = bars[:MOST_ROWS]
        figure, ax = new_panel(WIDE_IN, 1.3 + _ROW_IN * len(shown), bottom=0.9, top=TITLE_IN)
        plot_rows(ax, shown, label)
    else:
        height = _BARS_IN + _STEP_IN * (_levels(pairs) + 1)
        figure, ax = new_panel(0.72 + bar_in * max(len(bars), 3), height + 0.82 + TITLE_IN, bottom=0.82, top=TITLE_IN)
        plot_bars(ax, bars, pairs, label, 0.88 * bar_in * max(len(bars), 3) / (len(bars) + 0.2))
    finish(figure, ax, title, columns=2)
    return figure


def plot_bars(
    ax: Axes,
    bars: Sequence[Bar],
    pairs: Sequence[tuple[int, int, str]],
    label: str,
    name_in: float,
) -> None:
    """Bars, points and brackets in the manner of the paper's Figs 6c and 7c. name_in: inches of width for a name under its bar."""
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
    per_in = max(max(reach) - bottom, 1e-9) / _BARS_IN
    brackets = stack_brackets(pairs, reach, _STEP_IN * per_in)
    for bracket in brackets:
        _plot_bracket(ax, bracket, 0.07 * per_in)
    top = max([*reach, *(bracket.height for bracket in brackets)])
    ax.set_ylim(bottom * 1.06, top + 1.1 * _STEP_IN * per_in)
    ax.set_xlim(-0.6, len(bars) - 0.4)
    ax.set_xticks(at, _two_lines([bar.name for bar in bars], name_in), **TEXT)
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
    name_rows(ax, [bar.name for bar in bars], 0.4 * WIDE_IN)
    dress(ax, label, None)
    ax.grid(False, axis="y")


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


def _two_lines(names: Sequence[str], inches: float) -> list[str]:
    """Names for under bars: if one is too long for a line, all are broken after a sign between words; what is still too long is cut."""
    size = TEXT["fontsize"]
    whole = [drawable(name, 10_000) for name in names]
    if all(width_in(name, size) <= inches for name in whole):
        return whole
    broken = [_broken(name, inches, size) for name in whole]
    return broken if len(set(broken)) == len(set(names)) else fitted_apart(names, inches, size)


def _broken(name: str, inches: float, size: float) -> str:
    """A name on two lines where both fit, else cut."""
    for middle in sorted(
        (i + 1 for i, sign in enumerate(name) if sign in " _-,;/"), key=lambda i: abs(2 * i - len(name))
    ):
        lines = name[:middle].rstrip(), name[middle:]
        if len(name) < 200 and all(lines) and max(width_in(line, size) for line in lines) <= inches:
            return "\n".join(lines)
    return fitted(name, inches, size)


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
