"""The picture of an inverse design: the angle over window and strip width with all that reach the target, and what each costs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import GREY, dress
from benchlab.report.wording import drawable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TRADE_OFFS = (
    ("volume_mL", "volume (mL)"),
    ("blocked_force_N", "blocked force (N)"),
    ("peak_film_strain", "peak strain of the film"),
    ("cut_error_deg", "angle change by 0.1 mm\nin tw and in slw (°)"),
)
BEST_MARKS = {
    "balanced": ("o", "#D55E00", "balanced"),
    "least_cut_error": ("s", "#0072B2", "least cutting error"),
    "least_volume": ("v", "#009E73", "least volume"),
    "most_force": ("^", "#CC79A7", "most force"),
    "least_film_strain": ("D", "#E69F00", "least film strain"),
}


def draw_design_figure(
    tw_mm: np.ndarray,
    slw_mm: np.ndarray,
    angle_deg: np.ndarray,
    target_deg: float,
    candidates: Sequence[Mapping[str, Any]],
    best: Mapping[str, int],
    title: str,
    note: str,
) -> Figure:
    """Left: angle_deg (T, S) over tw (T,) and slw (S,), candidates on the contour of the target. Right: the trade-offs over slw.

    candidates: rows with tw_mm, slw_mm, those of TRADE_OFFS and reaches_force. best: names of BEST_MARKS to row numbers.
    """
    figure = figure_class()(figsize=(12.5, 7.2), dpi=DPI)
    left = figure.add_axes((0.055, 0.16, 0.385, 0.70))
    plot_angle_map(left, tw_mm, slw_mm, angle_deg, target_deg)
    plot_candidates(left, candidates, best, "tw_mm")
    grid = figure.add_gridspec(2, 2, left=0.535, right=0.985, top=0.86, bottom=0.16, wspace=0.32, hspace=0.28)
    for index, (name, label) in enumerate(TRADE_OFFS):
        ax = figure.add_subplot(grid[index // 2, index % 2])
        plot_candidates(ax, candidates, best, name)
        ax.margins(0.13)
        dress(ax, "slw (mm)", label)
    figure.text(0.055, 0.945, drawable(title, 90), fontsize=12, fontweight="bold", parse_math=False)
    figure.text(0.055, 0.905, drawable(note, 140), fontsize=9.5, color=GREY, parse_math=False)
    figure.legend(
        *_handles(best, candidates), loc="lower left", bbox_to_anchor=(0.045, 0.01), ncols=7, fontsize=9, frameon=False
    )
    return figure


def plot_angle_map(ax: Axes, tw_mm: np.ndarray, slw_mm: np.ndarray, angle_deg: np.ndarray, target_deg: float) -> None:
    """Angle over slw (across) and tw (up), interpolated between the simulated places (dots); a line where it is the target."""
    if len(tw_mm) > 1 and len(slw_mm) > 1 and np.isfinite(angle_deg).sum() > 3:
        x, y, z = _finer(slw_mm, tw_mm, angle_deg)
        drawn = ax.contourf(x, y, z, levels=14, cmap="Greys", alpha=0.75)
        bar = ax.figure.colorbar(drawn, ax=ax, pad=0.02)
        bar.set_label("bending angle θ (°), interpolated", fontsize=9)
        bar.ax.tick_params(labelsize=8)
        if np.nanmin(z) < target_deg < np.nanmax(z):
            ax.contour(x, y, z, levels=[target_deg], colors="black", linewidths=1.6)
    grid_tw, grid_slw = np.meshgrid(tw_mm, slw_mm, indexing="ij")
    seen = np.isfinite(angle_deg)
    ax.plot(grid_slw[seen], grid_tw[seen], ".", color="#555555", markersize=2.5)
    ax.plot(grid_slw[~seen], grid_tw[~seen], "x", color="#555555", markersize=4)
    if len(tw_mm) > 1 and tw_mm.max() > 4 * tw_mm.min():
        from matplotlib.ticker import FixedLocator, FormatStrFormatter, NullLocator

        ax.set_yscale("log")
        ax.yaxis.set_major_locator(FixedLocator([0.5, 1, 2, 3, 5, 7, 10, 15, 20, 30, 50]))
        ax.yaxis.set_minor_locator(NullLocator())
        ax.yaxis.set_major_formatter(FormatStrFormatter("%g"))
    dress(ax, "slw (mm)", "tw (mm)")
    ax.grid(False)


def plot_candidates(ax: Axes, candidates: Sequence[Mapping[str, Any]], best: Mapping[str, int], name: str) -> None:
    """One value of every candidate over its slw; open where the force is not reached; the best with their marks."""
    for row in candidates:
        if row[name] is not None:
            full = row["reaches_force"]
            ax.plot(row["slw_mm"], row[name], "o", color="#222222", markersize=4.5, zorder=3,
                    markerfacecolor="#222222" if full else "white")  # fmt: skip
    shown: list[int] = []
    for kind, index in best.items():
        if (value := candidates[index][name]) is not None:
            # A design may be the best in several: the marks become smaller, so that all are seen.
            style = _mark(kind, 11 - 3 * shown.count(index))
            ax.plot(candidates[index]["slw_mm"], value, **style, zorder=4 + len(shown))
        if kind != "balanced":
            shown.append(index)


def _mark(kind: str, size: float) -> dict[str, Any]:
    """A ring for the balanced design, a full mark for the others."""
    mark, colour, _ = BEST_MARKS[kind]
    if kind == "balanced":
        ring: dict[str, Any] = {
            "markersize": 17,
            "markerfacecolor": "none",
            "markeredgecolor": colour,
            "markeredgewidth": 1.8,
        }
        return {"marker": mark, "linestyle": "none", **ring}
    edge: dict[str, Any] = {"markeredgecolor": "white", "markeredgewidth": 0.6}
    return {"marker": mark, "linestyle": "none", "color": colour, "markersize": max(size, 4), **edge}


def _finer(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x (X,), y (Y,), z (Y, X) interpolated by splines where all of z is finite and there are enough places, else as it is."""
    if not np.isfinite(z).all() or min(len(x), len(y)) < 4:
        return x, y, z
    from scipy.interpolate import RectBivariateSpline

    spline = RectBivariateSpline(np.log(y), x, z)
    fine_x, fine_y = np.linspace(x[0], x[-1], 120), np.geomspace(y[0], y[-1], 120)
    return fine_x, fine_y, spline(np.log(fine_y), fine_x)


def _handles(best: Mapping[str, int], candidates: Sequence[Mapping[str, Any]]) -> tuple[list[Any], list[str]]:
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], marker="o", color="#222222", linestyle="none", markersize=4.5)]
    labels = ["simulated design at the angle"]
    if not all(row["reaches_force"] for row in candidates):
        handles.append(
            Line2D([], [], marker="o", color="#222222", markerfacecolor="white", linestyle="none", markersize=4.5)
        )
        labels.append("force not reached")
    for name in best:
        handles.append(Line2D([], [], **{**_mark(name, 8), **({"markersize": 10} if name == "balanced" else {})}))
        labels.append(BEST_MARKS[name][2])
    return handles, labels
