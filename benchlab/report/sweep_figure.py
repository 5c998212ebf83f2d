"""The picture of a sweep, in the manner of the paper's Figs 5, 6 and 7: angle against what varies, with the published
points; volume against pressure and against TPU area."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.io.published import PublishedAngle
from benchlab.io.sweep_file import Sweep
from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.wording import drawable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SYMBOLS = {"tw_mm": "tw", "slw_mm": "slw", "fw_mm": "fw", "perimeter_mm": "perimeter", "length_mm": "al"}
_MEASURED, _FEM = "#D55E00", "#000000"
_MOST_NAMED = 8
_SAME_PRESSURE = 1e-6
_PAPER = {
    "fw_mm": ShellDesign.rib_width_mm,
    "perimeter_mm": ShellDesign.perimeter_mm,
    "length_mm": ShellDesign.length_mm,
}


def draw_sweep_figure(sweep: Sweep, published: Sequence[PublishedAngle], title: str) -> Figure:
    """Four panels: angle at the last pressure against each of the first two dimensions that vary (against pressure where there
    are fewer), volume against pressure, volume at the last pressure against TPU area.

    `published` is drawn where dimensions and pressure are the paper's.
    """
    figure = figure_class()(figsize=(11.5, 8.6), dpi=DPI)
    grid = figure.add_gridspec(2, 2, left=0.07, right=0.985, top=0.885, bottom=0.07, wspace=0.2, hspace=0.27)
    angle, second, volume, area = (figure.add_subplot(grid[i, j]) for i in (0, 1) for j in (0, 1))
    varied = sweep.varied
    if varied:
        plot_angle_over_field(angle, sweep, varied[-1], published)
    else:
        plot_over_pressure(angle, sweep, "angle_deg", "bending angle θ (°)")
    if len(varied) > 1:
        plot_angle_over_field(second, sweep, varied[-2], published)
    elif varied:
        plot_over_pressure(second, sweep, "angle_deg", "bending angle θ (°)")
    else:
        plot_over_pressure(second, sweep, "blocked_force_N", "blocked force (N)")
    plot_over_pressure(volume, sweep, "volume_mL", "volume, from the round tube on (mL)")
    plot_volume_over_area(area, sweep)
    _write_words(figure, sweep, title)
    return figure


def plot_angle_over_field(ax: Axes, sweep: Sweep, name: str, published: Sequence[PublishedAngle]) -> None:
    """θ at the last pressure against one dimension, a line for each combination of the others."""
    position = list(sweep.axes).index(name)
    values = np.array(sweep.axes[name])
    lines: dict[tuple[float, ...], list[float]] = {}
    for combination, theta in zip(sweep.combinations(), sweep.curves["angle_deg"][:, -1]):
        others = combination[:position] + combination[position + 1 :]
        lines.setdefault(others, []).append(float(theta))
    rest = _rest(sweep, name)
    colours = {others: _colour(index, len(lines)) for index, others in enumerate(lines)}
    for index, (others, theta) in enumerate(lines.items()):
        ax.plot(values, theta, color=colours[others], linewidth=1.4, marker="o" if len(values) <= 40 else "",
                markersize=3, label=_label(rest, others, sweep, index, len(lines)))  # fmt: skip
    _plot_published(ax, sweep, name, published, colours)
    dress(ax, f"{SYMBOLS[name]} (mm)", f"bending angle θ at {sweep.pressure_MPa[-1]:g} MPa (°)")
    _add_legend(ax)


def plot_over_pressure(ax: Axes, sweep: Sweep, curve: str, label: str) -> None:
    """A curve of every design against pressure."""
    count = len(sweep.key)
    for index, combination in enumerate(sweep.combinations()):
        name = _label(list(sweep.axes), combination, sweep, index, count)
        ax.plot(sweep.pressure_MPa, sweep.curves[curve][index], color=_colour(index, count), linewidth=1.1, label=name,
                marker="o" if len(sweep.pressure_MPa) < 3 else "")  # fmt: skip
    dress(ax, "pressure (MPa)", label)
    if not np.isfinite(sweep.curves[curve]).any():
        ax.text(0.5, 0.5, "not simulated", transform=ax.transAxes, ha="center", color=GREY)
    elif count > 1:
        _add_legend(ax)


def plot_volume_over_area(ax: Axes, sweep: Sweep) -> None:
    """Volume at the last pressure against TPU area (Eq 6), a point a design."""
    volume, area = sweep.curves["volume_mL"][:, -1], sweep.designs["tpu_area_mm2"]
    count = len(volume)
    for index in range(count):
        ax.plot(area[index] / 100, volume[index], "o", color=_colour(index, count), markersize=5)
    dress(ax, "TPU area wl·tw·n (cm²)", f"volume at {sweep.pressure_MPa[-1]:g} MPa (mL)")


def _plot_published(
    ax: Axes, sweep: Sweep, name: str, published: Sequence[PublishedAngle], colours: Mapping[tuple[float, ...], Any]
) -> None:
    """Points of designs of which only `name` need not be in the sweep, in the colour of the line that they belong to."""
    fem_label: str | None = "published FEM"
    made_label: str | None = "measured, mean ± SD"
    for point in (point for point in published if _belongs(point, sweep, name)):
        colour = colours[_others(point, sweep, name)] if len(colours) > 1 else None
        x = getattr(point, name)
        style: dict[str, Any] = {"linestyle": "none", "zorder": 4}
        if point.fem_angle_deg is not None:
            ax.plot([x], [point.fem_angle_deg], "D", color=colour or _FEM, markerfacecolor="white", markeredgewidth=1.4,
                    markersize=6.5, label=fem_label, **style)  # fmt: skip
            fem_label = None
        if point.measured_angle_deg is not None:
            ax.errorbar([x], [point.measured_angle_deg], yerr=[point.measured_sd_deg or 0.0], fmt="s", capsize=3, markersize=5,
                        color=colour or _MEASURED, label=made_label, **style)  # fmt: skip
            made_label = None


def _belongs(point: PublishedAngle, sweep: Sweep, name: str) -> bool:
    """Whether a published point lies on a line of the sweep: at its last pressure, with the paper's other dimensions."""
    if name not in ("tw_mm", "slw_mm") or abs(point.pressure_MPa - sweep.pressure_MPa[-1]) > _SAME_PRESSURE:
        return False
    low, high = min(sweep.axes[name]), max(sweep.axes[name])
    return low <= getattr(point, name) <= high and all(
        value in sweep.axes[field] for field, value in zip(_rest(sweep, name), _others(point, sweep, name))
    )


def _rest(sweep: Sweep, name: str) -> list[str]:
    return [field for field in sweep.axes if field != name]


def _others(point: PublishedAngle, sweep: Sweep, name: str) -> tuple[float, ...]:
    """Dimensions of a published design but for `name`."""
    return tuple(_PAPER[field] if field in _PAPER else getattr(point, field) for field in _rest(sweep, name))


def _label(names: Sequence[str], values: Sequence[float], sweep: Sweep, index: int, count: int) -> str | None:
    """What varies of a line's dimensions; of many lines, only some are named."""
    if count > _MOST_NAMED and index not in np.linspace(0, count - 1, _MOST_NAMED - 2).round():
        return None
    told = [f"{SYMBOLS[n]} {v:g}" for n, v in zip(names, values) if n in sweep.varied]
    return ", ".join(told) or "simulated"


def _colour(index: int, count: int) -> Any:
    if count == 1:
        return BLUE
    from matplotlib import colormaps

    return colormaps["viridis"](0.92 * index / (count - 1))


def _add_legend(ax: Axes) -> None:
    legend = ax.legend(fontsize=8, framealpha=0.8, edgecolor="none")
    for text in legend.get_texts():
        text.set_parse_math(False)


def _write_words(figure: Figure, sweep: Sweep, title: str) -> None:
    fixed = [f"{SYMBOLS[n]} {v[0]:g}" for n, v in sweep.axes.items() if len(v) == 1]
    material = sweep.settings["material"]["name"]
    missing = sum(map(bool, sweep.reason))
    notes = [
        "simulated, not measured",
        f"{', '.join(fixed)} mm" if fixed else "",
        f"material {material}",
        f"{missing} of {len(sweep.key)} designs with missing values: see the table" if missing else "",
        "PARTIAL" if sweep.partial else "",
    ]
    figure.text(0.07, 0.957, drawable(title, 90), fontsize=12, fontweight="bold", parse_math=False)
    note = drawable(" · ".join(filter(None, notes)), 130)
    figure.text(0.07, 0.925, note, fontsize=9.5, color=GREY, parse_math=False)
