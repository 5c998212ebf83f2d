"""Blocked force against pressure, as the paper's Fig. 3b: mean ± SD over actuators, each actuator as points, the line with its band."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.errors import counted
from benchlab.force.curve import BlockedForce
from benchlab.force.line import Estimate, ForceLine
from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BAND, BLUE, GREY, dress
from benchlab.report.rounding import decimals_of, digits, number
from benchlab.report.wording import drawable
from benchlab.stats.wording import p_equals

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

OTHER = "#D55E00"
_MARKS = ("o", "s", "^", "D", "v", "P")
_POINT = "#333333"


def draw_force_figure(found: BlockedForce, drawn: bool = False) -> Figure:
    """A figure with a title, the panel, and what was found as words below it. drawn: the title says that nothing was measured."""
    lines = line_words(found)
    foot = 0.6 + 0.2 * len(lines)
    height = 4.25 + foot
    figure = figure_class()(figsize=(6.4, height), dpi=DPI)
    ax = figure.add_axes((0.72 / 6.4, (foot + 0.12) / height, 5.5 / 6.4, 3.75 / height))
    plot_blocked_force(ax, found)
    many = counted(len(found.actuators), "actuator")
    title = f"Blocked force of {many}" + (": drawn, not measured" if drawn else "")
    figure.text(0.72 / 6.4, 1 - 0.27 / height, title, fontsize=12, fontweight="bold", parse_math=False)
    for row, text in enumerate(lines):
        y = (0.14 + 0.2 * (len(lines) - 1 - row)) / height
        figure.text(0.72 / 6.4, y, text, fontsize=8.5, color=GREY, parse_math=False)
    return figure


def draw_force_panel(found: BlockedForce, title: str, paper: tuple[float, float, float] | None = None) -> Figure:
    """The figure as a panel of a report. paper: pressure, mean and SD that were published."""
    width, height = 4.7, 3.3
    figure = figure_class()(figsize=(width, height), dpi=DPI)
    ax = figure.add_axes((0.62 / width, 0.46 / height, (width - 0.72) / width, (height - 0.76) / height))
    plot_blocked_force(ax, found, paper, letters=8)
    style: dict[str, Any] = {"va": "top", "fontsize": 9.5, "fontweight": "bold", "parse_math": False}
    figure.text(0.06 / width, 1 - 0.06 / height, drawable(title, 46), **style)
    return figure


def plot_blocked_force(
    ax: Axes, found: BlockedForce, paper: tuple[float, float, float] | None = None, letters: float = 8.5
) -> None:
    """The panel. paper: pressure, mean and SD that were published."""
    pressure, mean, sd = found.pressure_MPa, found.over_actuators_N, found.sd_N
    step = float(np.diff(pressure).min()) if len(pressure) > 1 else 0.1 * float(pressure.max())
    _plot_actuators(ax, found, step)
    black: dict[str, Any] = {"color": "black", "zorder": 5}
    several = np.isfinite(sd)
    label = None if several.any() else "mean"
    ax.plot(pressure, mean, "_", markersize=11, markeredgewidth=1.4, label=label, **black)
    if several.any():
        ax.errorbar(pressure[several], mean[several], yerr=sd[several], fmt="none", elinewidth=1.1, capsize=3.5,
                    label="mean ± 1 SD of actuators", ecolor="black", zorder=5)  # fmt: skip
    bound = found.lower_bound.any(axis=0)
    if bound.any():
        ax.plot(pressure[bound], mean[bound], "^", color=OTHER, markersize=7, zorder=6, label="≥: lower bound")
    if found.line is not None:
        _plot_line(ax, found.line, float(pressure.max()))
    if paper is not None:
        at, published, spread = paper
        ax.errorbar([at + 0.32 * step], [published], yerr=[spread], fmt="D", color=OTHER, markerfacecolor="white", markersize=4.5,
                    capsize=3, zorder=6, label=f"paper: {published:g} ± {spread:g} N")  # fmt: skip
    ax.set_xlim(0, float(pressure.max()) + 0.7 * step)
    ax.set_ylim(bottom=None if float(np.nanmin(found.mean_N)) < 0 else 0)
    dress(ax, "pressure (MPa)", "blocked force (N)")
    for text in ax.legend(loc="upper left", fontsize=letters, frameon=False).get_texts():
        text.set_parse_math(False)


def _plot_actuators(ax: Axes, found: BlockedForce, step: float) -> None:
    """Points of each actuator, side by side within a step of pressure."""
    few = len(found.actuators) <= len(_MARKS)
    aside = np.linspace(-0.16, 0.16, len(found.actuators)) * step if len(found.actuators) > 1 else np.zeros(1)
    for i, name in enumerate(found.actuators):
        label = drawable(name, 28) if few else "actuators" if i == 0 else None
        ax.plot(found.pressure_MPa + aside[i], found.mean_N[i], _MARKS[i] if few else "o", color=_POINT, markerfacecolor="white",
                markersize=3.6, markeredgewidth=0.8, linestyle="none", zorder=3, label=label)  # fmt: skip


def line_words(found: BlockedForce) -> list[str]:
    """The line, its linearity and what is not known of the fixture, in words."""
    lever = (
        "lever arm of the fixture: not stated"
        if found.lever_arm_mm is None
        else f"lever arm of the fixture: {found.lever_arm_mm:g} mm"
    )
    if found.line is None:
        return [f"No line: {found.line_reason}.", lever]
    line = found.line
    slope = line.slope_N_per_MPa.value
    force_N = slope * float(line.pressure_MPa.max())
    of = f"; {100 * line.confidence:g} % intervals" if np.isfinite(line.slope_N_per_MPa.low) else ""
    return [
        f"F = a + b·p: a = {_ends(line.intercept_N, 'N', force_N)}, b = {_ends(line.slope_N_per_MPa, 'N/MPa', slope)}",
        f"F = b·p: b = {_ends(line.through_origin_N_per_MPa, 'N/MPa', slope)}{of}",
        _quality(line),
        *linearity_words(line),
        lever,
    ]


def linearity_words(line: ForceLine) -> list[str]:
    """The tests of linearity, one each."""
    straight = line.linearity
    if straight is None:
        return ["linearity: not tested, which needs two actuators and three pressures"]
    a, b = straight.df
    words = [f"lack of fit F({a}, {b}) = {straight.F:.2f}, {p_equals(straight.p)}"]
    if np.isfinite(straight.bow_p):
        bow = _ends(straight.bow_N, "N", line.slope_N_per_MPa.value * float(line.pressure_MPa.max()))
        words.append(f"bow in the middle {bow}, {p_equals(straight.bow_p)}")
    return words


def places_of(largest_N: float, sd_N: float) -> int:
    """Decimals of forces: two at least, and enough for two digits of their standard deviation, or of a hundredth of the largest.

    >>> places_of(37.07, 1.08), places_of(0.0421, 0.0011), places_of(0.5, math.nan)
    (2, 4, 4)
    """
    return max(2, decimals_of(sd_N if math.isfinite(sd_N) and sd_N > 0 else abs(largest_N) / 100))


def _quality(line: ForceLine) -> str:
    sd = f", residual SD {line.residual_sd_N:.2g} N about each actuator's own line"
    return f"R² {line.r_squared:.4f}{sd if np.isfinite(line.residual_sd_N) else ''}"


def _ends(one: Estimate, unit: str, scale: float) -> str:
    """A value with its interval, to two digits of its half width, and no finer than 1e-5 of the scale."""
    if not np.isfinite(one.low):
        return f"{digits(one.value, 4).text} {unit}"
    places = min(decimals_of((one.high - one.low) / 2), decimals_of(abs(scale) / 1e4))
    return (
        f"{number(one.value, places).text} {unit} ({number(one.low, places).text} to {number(one.high, places).text})"
    )


def _plot_line(ax: Axes, line: ForceLine, largest: float) -> None:
    at = np.linspace(0, largest * 1.04, 80)
    mean, low, high = line.at(at)
    style: dict[str, Any] = {"color": BLUE, "linewidth": 1.5, "zorder": 2}
    inside = at >= line.pressure_MPa.min()
    ax.plot(at[inside], mean[inside], label="line", **style)
    ax.plot(at[~inside], mean[~inside], linestyle=(0, (3, 2)), **style)
    if np.isfinite(low).all():
        ax.fill_between(at, low, high, color=BAND, linewidth=0, zorder=1, label=f"{100 * line.confidence:g} % band")
