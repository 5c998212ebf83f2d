"""The figure of a closed-loop run, after the paper's Fig 8: what was wanted and what was measured, the error, the pressure, the tip."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.actuator import tip_position_mm
from benchlab.control.tracking import Tracking, late_words
from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.wording import drawable
from benchlab.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

REFERENCE, TRUE, LIMIT, SETTLING = "#000000", "#009E73", "#D55E00", "#eeeeee"


@dataclass(frozen=True)
class TrackedRun:
    """The closed-loop part of a run, (T,) each over time_s: degrees, MPa. true_deg: of a simulated bench, else None.
    pressure_MPa: measured, NaN without a sensor."""

    time_s: FloatArray
    reference_deg: FloatArray
    angle_deg: FloatArray
    command_MPa: FloatArray
    pressure_MPa: FloatArray
    ceiling_MPa: float
    true_deg: FloatArray | None = None


def draw_tracking_figure(
    run: TrackedRun, found: Tracking, title: str, note: str, length_mm: float, true: Tracking | None = None
) -> Figure:
    """Left, over time: reference and angle, error, pressure with its ceiling. Right: the tip's path, and the figures in words.

    `title` and `note` are shown as plain text; the note says what bench it was.
    """
    figure = figure_class()(figsize=(11.0, 7.2), dpi=DPI)
    upper = figure.add_axes((0.07, 0.525, 0.60, 0.345))
    middle = figure.add_axes((0.07, 0.315, 0.60, 0.165), sharex=upper)
    lower = figure.add_axes((0.07, 0.085, 0.60, 0.185), sharex=upper)
    tip = figure.add_axes((0.755, 0.525, 0.225, 0.345))
    _plot_angles(upper, run, found.settle_s)
    _plot_error(middle, run, found.settle_s)
    _plot_pressure(lower, run, found.settle_s)
    _plot_tip(tip, run, length_mm)
    for above in (upper, middle):
        above.tick_params(labelbottom=False)
    plain: dict[str, Any] = {"parse_math": False}
    figure.text(0.07, 0.955, drawable(title, 90), fontsize=12, fontweight="bold", **plain)
    figure.text(0.07, 0.917, drawable(note, 130), fontsize=9.5, color=GREY, **plain)
    figure.text(0.755, 0.43, "\n".join(_words(found, true)), fontsize=8.7, va="top", linespacing=1.45, **plain)
    return figure


def _plot_angles(ax: Axes, run: TrackedRun, settle_s: float) -> None:
    _mark_settling(ax, run, settle_s)
    ax.plot(run.time_s, run.angle_deg, color=BLUE, linewidth=1.2, label="measured (flex sensor)")
    if run.true_deg is not None:
        ax.plot(run.time_s, run.true_deg, color=TRUE, linewidth=1.0, label="true (simulated bench)")
    ax.plot(run.time_s, run.reference_deg, color=REFERENCE, linewidth=1.1, linestyle=(0, (4, 2)), label="reference")
    dress(ax, None, "bending angle θ (°)")
    ax.margins(x=0.01)
    ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, fontsize=8.5, frameon=False, borderaxespad=0.1)


def _plot_error(ax: Axes, run: TrackedRun, settle_s: float) -> None:
    _mark_settling(ax, run, settle_s)
    ax.axhline(0, color=GREY, linewidth=0.7)
    ax.plot(run.time_s, run.reference_deg - run.angle_deg, color=BLUE, linewidth=0.9)
    if run.true_deg is not None:
        ax.plot(run.time_s, run.reference_deg - run.true_deg, color=TRUE, linewidth=0.9)
    dress(ax, None, "error (°)")


def _plot_pressure(ax: Axes, run: TrackedRun, settle_s: float) -> None:
    _mark_settling(ax, run, settle_s)
    ax.axhline(run.ceiling_MPa, color=LIMIT, linewidth=0.9, linestyle=(0, (1, 1.5)), label="ceiling")
    ax.plot(run.time_s, run.command_MPa, color=BLUE, linewidth=1.1, label="commanded")
    if np.isfinite(run.pressure_MPa).any():
        ax.plot(run.time_s, run.pressure_MPa, color=GREY, linewidth=0.8, label="measured at the regulator")
    limited = (run.command_MPa >= run.ceiling_MPa - 1e-6) | (run.command_MPa <= 1e-6)
    if limited.any():
        ax.plot(run.time_s[limited], run.command_MPa[limited], "|", color=LIMIT, markersize=7, label="at a limit")
    top = 1.08 * run.ceiling_MPa
    ax.set_ylim(-0.03 * top, top)
    dress(ax, "time (s)", "pressure (MPa)")
    ax.legend(loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=4, fontsize=8.5, frameon=False, borderaxespad=0.1)


def _plot_tip(ax: Axes, run: TrackedRun, length_mm: float) -> None:
    """The path of the tip of one arc, the base at the origin and the unbent actuator upwards."""
    for angle, colour, width, style in (
        (run.angle_deg, BLUE, 2.2, "-"),
        (run.reference_deg, REFERENCE, 1.1, (0, (4, 2))),
    ):
        path = tip_position_mm(np.radians(angle), length_mm)
        ax.plot(path[:, 0], path[:, 1], color=colour, linewidth=width, linestyle=style)
    largest = float(np.nanmax(run.reference_deg))
    along = np.linspace(0, 1, 60)
    body = tip_position_mm(np.radians(largest) * along, length_mm * along)
    ax.plot(body[:, 0], body[:, 1], color="#bbbbbb", linewidth=3, zorder=1, solid_capstyle="round")
    ax.plot(0, 0, "s", color=GREY, markersize=5)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.1)
    dress(ax, "towards the strip (mm)", "along (mm)")
    ax.set_title(f"tip of one arc of {length_mm:g} mm", fontsize=9.5, color=GREY)


def _mark_settling(ax: Axes, run: TrackedRun, settle_s: float) -> None:
    if settle_s > 0:
        ax.axvspan(run.time_s[0], run.time_s[0] + settle_s, color=SETTLING, linewidth=0)


def _words(found: Tracking, true: Tracking | None) -> list[str]:
    lines = [
        f"{_r_squared(found)}  (1 − Σe²/Σ(r − r̄)²)",
        f"RMSE {found.rmse_deg:.2f}°, mean |e| {found.mae_deg:.2f}°, max {found.max_deg:.1f}°",
        late_words(found.lag_s) if np.isfinite(found.lag_s) else "lag not told by this reference",
        f"tip RMSE {found.tip_rmse_mm:.2f} mm, max {found.tip_max_mm:.1f} mm",
        f"effort ∫|du| {found.variation_MPa:.3g} MPa, peak {found.peak_MPa:.3f} MPa",
        f"at the ceiling {100 * found.at_ceiling:.1f} %, at zero {100 * found.at_zero:.1f} %",
    ]
    if true is not None:
        lines.append(f"against the truth: {_r_squared(true)}, RMSE {true.rmse_deg:.2f}°")
    lines += [f"the first {found.settle_s:g} s (grey) are left out"] if found.settle_s else []
    return [*lines, f"{found.samples} samples, {found.missing} without an angle"]


def _r_squared(found: Tracking) -> str:
    return f"R² {found.r_squared:.4f}" if np.isfinite(found.r_squared) else "no R²"
