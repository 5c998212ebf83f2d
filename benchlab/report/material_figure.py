"""The picture of a material fit: the tests, every law over them and beyond, what is left, and where each law is stable."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import GREY
from benchlab.report.wording import drawable
from benchlab.simulation.laws.homogeneous import MODES, nominal_stress_MPa
from benchlab.simulation.tensile.fit_law import LawFit, Specimen

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999933", "#882255")
"""Of the laws, in the order of the fits (Okabe and Ito's and Tol's, told apart without red and green)."""

_MARKS = ("o", "s", "^", "D", "v", "P")
_BEYOND = 0.25


def draw_material_figure(
    tests: Sequence[tuple[str, Specimen]], fits: Sequence[LawFit], chosen: str, title: str
) -> Figure:
    """Above: nominal stress over stretch, the laws solid over the data and dashed beyond. Below: residuals. Beside: stable ranges.

    tests: name and points of each; chosen: name of the law that is drawn heavily. Names are shown as plain text.
    """
    figure = figure_class()(figsize=(11.0, 6.6), dpi=DPI)
    upper = figure.add_axes((0.065, 0.40, 0.50, 0.48))
    lower = figure.add_axes((0.065, 0.09, 0.50, 0.23))
    bars = figure.add_axes((0.705, 0.09, 0.28, 0.79))
    _plot_curves(upper, tests, fits, chosen)
    _plot_residuals(lower, tests, fits, chosen)
    _plot_stability(bars, fits, chosen)
    big: dict[str, Any] = {"fontsize": 12, "fontweight": "bold", "parse_math": False}
    figure.text(0.065, 0.955, drawable(title, 95), **big)
    note = "Points: the uniaxial tests. Lines: fitted laws; dashed beyond the tests."
    figure.text(0.065, 0.917, note, fontsize=9.5, color=GREY, parse_math=False)
    return figure


def _plot_curves(ax: Axes, tests: Sequence[tuple[str, Specimen]], fits: Sequence[LawFit], chosen: str) -> None:
    low, high = fits[0].stretch_range
    room = _BEYOND * (high - low)
    within, beyond = np.linspace(low, high, 300), np.linspace(high, high + room, 60)
    for index, (name, test) in enumerate(tests):
        label = drawable(name, 32) if index < len(_MARKS) else f"and {len(tests) - len(_MARKS)} more"
        ax.plot(test.stretch, test.stress_MPa, _MARKS[index % len(_MARKS)], color="#333333", markersize=3, linestyle="none",
                alpha=0.7, label=label if index <= len(_MARKS) else None)  # fmt: skip
    for colour, fit in _coloured(fits):
        style = _style(fit, chosen)
        ax.plot(within, nominal_stress_MPa(fit.law, within), color=colour, **style)
        ax.plot(beyond, nominal_stress_MPa(fit.law, beyond), color=colour, **{**style, "linestyle": (0, (4, 2))})
    stresses = np.concatenate([test.stress_MPa for _, test in tests])
    top, bottom = float(stresses.max()), min(0.0, float(stresses.min()))
    ax.set_ylim(bottom - 0.05 * (top - bottom), top + 0.35 * (top - bottom))
    ax.axvline(high, color=GREY, linewidth=0.7, linestyle=":")
    ax.set_xlim(low - 0.02 * room, high + room)
    _dress(ax, "", "nominal stress (MPa)")
    legend = ax.legend(loc="upper left", fontsize=8, frameon=False)
    for text in legend.get_texts():
        text.set_parse_math(False)


def _plot_residuals(ax: Axes, tests: Sequence[tuple[str, Specimen]], fits: Sequence[LawFit], chosen: str) -> None:
    low, high = fits[0].stretch_range
    for colour, fit in _coloured(fits):
        for _, test in tests:
            ax.plot(
                test.stretch,
                nominal_stress_MPa(fit.law, test.stretch) - test.stress_MPa,
                color=colour,
                **_style(fit, chosen),
            )
    ax.axhline(0, color=GREY, linewidth=0.7)
    ax.set_xlim(low - 0.02 * _BEYOND * (high - low), high + _BEYOND * (high - low))
    _dress(ax, "stretch", "law − test (MPa)")


def _plot_stability(ax: Axes, fits: Sequence[LawFit], chosen: str) -> None:
    """A row a law: its name and RMSE, and a bar a test mode from the lowest to the highest stable stretch."""
    low, high = fits[0].stretch_range
    widest = max(high + _BEYOND * (high - low), 1.5)
    ax.axvspan(low, high, color="#eeeeee", linewidth=0)
    for row, (colour, fit) in enumerate(_coloured(fits)):
        for line, one in enumerate(fit.stable):
            y = row + 0.24 * (line - 1)
            left, right = max(one.low, min(low, 0.8)), min(one.high, widest)
            ax.plot(
                [left, right], [y, y], color=colour, linewidth=4, alpha=(1.0, 0.7, 0.4)[line], solid_capstyle="butt"
            )
            if one.high_found and one.high < widest:
                ax.plot([right], [y], "|", color="black", markersize=7)
        words = f"{fit.name}\nRMSE {fit.rmse_MPa:.2g} MPa" + ("" if fit.stable_over_data else "\nnot stable over data")
        weight = "bold" if fit.name == chosen else "normal"
        ax.text(-0.02, row, words, transform=ax.get_yaxis_transform(), ha="right", va="center", fontsize=8.5, color=colour,
                fontweight=weight, parse_math=False)  # fmt: skip
    ax.set_xlim(min(low, 0.8), widest)
    ax.set_ylim(len(fits) - 0.5, -0.5)
    ax.set_yticks([])
    ax.set_title(f"Drucker-stable stretches; rows: {', '.join(MODES)};\ngrey: stretches of the test; |: limit of stability",
                 fontsize=8.5, color=GREY, loc="right")  # fmt: skip
    _dress(ax, "driven stretch", "")
    ax.spines["left"].set_visible(False)


def _coloured(fits: Sequence[LawFit]) -> list[tuple[str, LawFit]]:
    return [(COLOURS[index % len(COLOURS)], fit) for index, fit in enumerate(fits)]


def _style(fit: LawFit, chosen: str) -> dict[str, Any]:
    heavy = fit.name == chosen
    return {"linewidth": 2.2 if heavy else 1.0, "zorder": 3 if heavy else 2}


def _dress(ax: Axes, x_label: str, y_label: str) -> None:
    ax.set_xlabel(x_label, fontsize=10)
    ax.set_ylabel(y_label, fontsize=10)
    ax.tick_params(labelsize=9, color=GREY)
    ax.spines[["top", "right"]].set_visible(False)
    ax.spines[["left", "bottom"]].set_color(GREY)
