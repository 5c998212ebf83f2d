"""The figures of a simulated actuator: itself and its curves against pressure; its cell and the sections of it.

Drawn with matplotlib's objects alone, as `figures` is. Every figure says that it is simulated, of what and at which pressure.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.response_picture import (
    OBLIQUE,
    PIECES,
    SIDE,
    StretchScale,
    draw_scale_bar,
    draw_stretch_bar,
    nice_length_mm,
    paint_surface,
    show_painting,
)
from benchlab.report.wording import drawable
from benchlab.simulation.actuator_response import ActuatorResponse
from benchlab.simulation.laws.law import FloatArray
from benchlab.simulation.surface import Surface, sections_mm, whole_actuator, whole_cell

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDTH, _HEIGHT = 11.5, 6.3
_CELL_WIDTH, _CELL_HEIGHT = 10.0, 5.6
_NAMES = {"rib": "fabric rib", "weld": "fabric under the strip", "strip": "strip", "cap": "cap"}


def draw_response_figure(response: ActuatorResponse) -> Figure:
    """The whole actuator at the last pressure, and angle, volume and blocked force over pressure."""
    figure = figure_class()(figsize=(_WIDTH, _HEIGHT), dpi=DPI)
    last = response.free.points[-1]
    surface = whole_actuator(response.cell, last.state, response.design, response.cap_mm)
    scale = StretchScale.of(surface)
    room = int(0.44 * _WIDTH * DPI), int(0.76 * _HEIGHT * DPI)
    painting = paint_surface(surface, scale, SIDE, room, closed=True)
    show_painting(figure, painting, int(0.115 * _WIDTH * DPI), int(0.075 * _HEIGHT * DPI))
    draw_stretch_bar(figure, scale, (0.045, 0.13, 0.011, 0.30))
    draw_scale_bar(
        figure, painting, 0.045 * _WIDTH * DPI, 0.045 * _HEIGHT * DPI, nice_length_mm(response.design.length_mm)
    )
    _plot_curves(figure, response)
    _write_words(figure, response, f"{response.angle_deg[-1]:.1f}° at {last.pressure_MPa:g} MPa")
    _write_pieces(figure, surface, 0.24, 0.035)
    return figure


def draw_cell_figure(response: ActuatorResponse) -> Figure:
    """One cell at the last pressure, as one looks into it, and its sections mid rib and mid window against the round tube."""
    figure = figure_class()(figsize=(_CELL_WIDTH, _CELL_HEIGHT), dpi=DPI)
    last = response.free.points[-1]
    surface = whole_cell(response.cell, last.state, 8)
    scale = StretchScale.of(surface)
    room = int(0.50 * _CELL_WIDTH * DPI), int(0.76 * _CELL_HEIGHT * DPI)
    painting = paint_surface(surface, scale, OBLIQUE, room, closed=False)
    show_painting(figure, painting, int(0.09 * _CELL_WIDTH * DPI), int(0.09 * _CELL_HEIGHT * DPI))
    draw_stretch_bar(figure, scale, (0.045, 0.14, 0.013, 0.34))
    _plot_sections(figure.add_axes((0.655, 0.13, 0.33, 0.70)), response)
    _write_words(figure, response, f"one cell at {last.pressure_MPa:g} MPa")
    _write_pieces(figure, surface, 0.24, 0.045)
    return figure


def _plot_curves(figure: Figure, response: ActuatorResponse) -> None:
    curves = (
        (response.angle_deg, "bending angle θ (°)", 0.545, 0.30),
        (response.volume_mL, "volume (mL)", 0.325, 0.165),
        (response.blocked_force_N, "blocked force (N)", 0.105, 0.165),
    )
    for row, (values, label, bottom, height) in enumerate(curves):
        ax = figure.add_axes((0.62, bottom, 0.36, height))
        _plot(ax, response, values, label)
        if row < len(curves) - 1:
            ax.tick_params(labelbottom=False)
        else:
            ax.set_xlabel("pressure (MPa)", fontsize=10)
            words = f"held straight, {response.fixture}"
            ax.text(0.015, 0.96, words, transform=ax.transAxes, fontsize=8.5, color=GREY, va="top")


def _plot(ax: Axes, response: ActuatorResponse, values: FloatArray, label: str) -> None:
    pressure = response.pressure_MPa
    marker: dict[str, Any] = {"marker": "o", "markersize": 3.5} if len(pressure) <= 60 else {}
    ax.plot(pressure, values, color=BLUE, linewidth=1.4, **marker)
    if response.limit_pressure_MPa is not None:
        ax.axvline(response.limit_pressure_MPa, color="#D55E00", linewidth=1.2, linestyle="--")
        ax.annotate("no stable state beyond", (response.limit_pressure_MPa, 0.5), xycoords=("data", "axes fraction"),
                    xytext=(-4, 0), textcoords="offset points", rotation=90, ha="right", va="center", fontsize=8,
                    color="#D55E00")  # fmt: skip
    if not np.isfinite(values).any():
        ax.text(0.5, 0.5, "no value", transform=ax.transAxes, ha="center", color=GREY)
    ends = [0.0, float(pressure[-1]), response.limit_pressure_MPa or 0.0]
    ax.set_xlim(-0.02 * max(ends), 1.04 * max(ends) or 1.0)
    ax.margins(y=0.12)
    ax.set_ylabel(label, fontsize=9.5)
    ax.yaxis.set_label_coords(-0.1, 0.5)
    ax.locator_params(axis="y", nbins=5)
    dress(ax)


def _plot_sections(ax: Axes, response: ActuatorResponse) -> None:
    """Outlines mid rib and mid window at the last pressure, over that of the round tube."""
    from matplotlib.ticker import MultipleLocator

    turn = np.linspace(0, 2 * np.pi, 200)
    R = response.cell.radius_mm
    ax.plot(R * np.sin(turn), R * (1 - np.cos(turn)), color="#bbbbbb", linewidth=1, linestyle="--", label="round tube")
    sections = sections_mm(response.cell, response.free.points[-1].state)
    for (label, outline), colour in zip(sections.items(), ("#8a6d3b", "#21918c")):
        ax.plot(*outline.T, color=colour, linewidth=1.8, label=label)
    ax.set_aspect("equal", adjustable="datalim")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(MultipleLocator(nice_length_mm(5 * R / 3)))
    ax.set_xlabel("across (mm)", fontsize=10)
    ax.set_ylabel("from the strip (mm)", fontsize=10)
    ax.legend(loc="center", fontsize=9, frameon=False)
    dress(ax)


def _write_words(figure: Figure, response: ActuatorResponse, what: str) -> None:
    height = figure.get_size_inches()[1]
    design, layup = response.design, response.layup
    title = f"{design.name}, simulated: {what}"
    caps = f", caps {response.cap_mm:g} mm" if response.cap_mm else ""
    note = (
        f"tw {design.window_width_mm:g}, slw {design.strip_width_mm:g}, fw {design.rib_width_mm:g}, "
        f"perimeter {design.perimeter_mm:g}, al {design.length_mm:g} mm{caps}; material {layup.name}"
    )
    style: dict[str, Any] = {"parse_math": False}
    room = int(figure.get_size_inches()[0] / 0.083)
    figure.text(0.035, 1 - 0.34 / height, drawable(title, 90), fontsize=12, fontweight="bold", **style)
    figure.text(0.035, 1 - 0.59 / height, drawable(note, room), fontsize=9.5, color=GREY, **style)


def _write_pieces(figure: Figure, surface: Surface, left: float, bottom: float) -> None:
    """A legend of the pieces that are seen, in a row."""
    from matplotlib.patches import Patch

    seen = [name for name in PIECES if (surface.piece == name).any()]
    handles = [Patch(facecolor=PIECES[name], edgecolor=GREY, linewidth=0.5, label=_NAMES[name]) for name in seen]
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(left, bottom), ncols=len(handles), fontsize=9,
                  frameon=False, borderpad=0, borderaxespad=0, columnspacing=1.5, handlelength=1.2)  # fmt: skip
