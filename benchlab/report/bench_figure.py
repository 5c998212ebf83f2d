"""A calibration drawn: gauge pressure over volts with its line up to the limit, and what is left of each reading."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from benchlab.bench import Bench
from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.wording import drawable
from benchlab.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FALLING = "#D55E00"


def draw_bench_figure(
    bench: Bench, volts: FloatArray, pressure_MPa: FloatArray, rising: Sequence[bool], simulated: bool = False
) -> Figure:
    """The readings (n,) of the regulator, its line, and the residuals. simulated: the title says that nothing was measured."""
    figure = figure_class()(figsize=(6.4, 5.6), dpi=DPI)
    top = figure.add_axes((0.115, 0.37, 0.85, 0.52))
    below = figure.add_axes((0.115, 0.1, 0.85, 0.22), sharex=top)
    up = np.asarray(rising, dtype=bool)
    left = 1000 * (pressure_MPa - (bench.regulator.gain * volts + bench.regulator.offset))
    for ax, values in ((top, 1000 * pressure_MPa), (below, left)):
        ax.plot(volts[up], values[up], "^", color=BLUE, markersize=5.5, label="rising")
        ax.plot(volts[~up], values[~up], "v", color=FALLING, markersize=5.5, label="falling")
        dress(ax)
    _plot_line(top, bench, volts)
    below.axhline(0, color=GREY, linewidth=0.8)
    sd = 1000 * bench.regulator.sd
    if np.isfinite(sd):
        below.axhspan(-sd, sd, color=GREY, alpha=0.15, linewidth=0)
        below.annotate("± 1 SD", (1, sd), xycoords=("axes fraction", "data"), xytext=(-3, -2), textcoords="offset points",
                       ha="right", va="top", fontsize=8.5, color=GREY)  # fmt: skip
    top.set_ylabel("gauge, kPa")
    top.tick_params(labelbottom=False)
    top.legend(loc="lower right", frameon=False, fontsize=8.5)
    below.set_ylabel("reading − line, kPa")
    below.set_xlabel("volts at the regulator's input")
    title = f"Calibration of {bench.name}, {bench.date}" + (": simulated, not measured" if simulated else "")
    figure.text(0.115, 0.95, drawable(title, 60), fontsize=12, fontweight="bold", parse_math=False)
    says = f"{bench.gauge}; supply {bench.supply_V:g} V"
    figure.text(0.115, 0.91, drawable(says, 95), fontsize=8.5, color=GREY, parse_math=False)
    return figure


def _plot_line(ax: Axes, bench: Bench, volts: FloatArray) -> None:
    """The line over the readings, dashed from there to the limit."""
    line, limit_V = bench.regulator, bench.regulator.inverse(bench.limit_MPa)
    within = np.array([volts.min(), volts.max()])
    ax.plot(within, 1000 * (line.gain * within + line.offset), "-", color="black", linewidth=1.1, zorder=1,
            label=f"{1000 * line.gain:.2f} kPa/V · U {'−' if line.offset < 0 else '+'} {abs(1000 * line.offset):.2f} kPa")  # fmt: skip
    if limit_V > volts.max():
        beyond = np.array([volts.max(), limit_V])
        ax.plot(beyond, 1000 * (line.gain * beyond + line.offset), "--", color="black", linewidth=1.1, zorder=1)
    ax.axhline(1000 * bench.limit_MPa, color=GREY, linewidth=0.9, linestyle=":")
    ax.annotate(
        f"limit {1000 * bench.limit_MPa:g} kPa: {bench.volts(bench.ceiling_code):.3f} V, code {bench.ceiling_code}",
        (0.01, 1000 * bench.limit_MPa), xycoords=("axes fraction", "data"), xytext=(0, -4), textcoords="offset points",
        ha="left", va="top", fontsize=8.5, color=GREY,
    )  # fmt: skip
    ax.set_xlim(left=0)
    ax.set_ylim(bottom=0)
