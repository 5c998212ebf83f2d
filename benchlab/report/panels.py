"""The panels that a figure of a recording is made of; each takes the axes it draws in.

Colours are Okabe and Ito's, which the colour-blind can tell apart; flags differ in shape as well.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from benchlab.vision.picture import FloatArray
from benchlab.vision.series import CurvatureSeries

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

MAX_DRAWN = 20_000
"""Frames up to which each is drawn; of longer recordings, the extremes of each short stretch."""

FEW = 60
"""Frames up to which each gets a point of its own."""

BLUE, BAND, GREY = "#0072B2", "#bcdcee", "#555555"
FLAG_STYLES = (("#D55E00", "|"), ("#009E73", "x"), ("#CC79A7", "^"), ("#E69F00", "v"), ("#000000", "."))


def plot_angle_over_time(ax: Axes, series: CurvatureSeries) -> None:
    """θ in degrees with its band of ± 2 standard deviations over time, or over the picture number where no time is
    known. The line is broken where frames were not measured.
    """
    x, label = time_axis(series)
    kept = _kept(series.angle_rad)
    theta, sd = np.degrees(series.angle_rad[kept]), np.degrees(series.angle_sd_rad[kept])
    points: dict[str, Any] = {"marker": "o", "markersize": 4} if len(x) <= FEW else {}
    ax.plot(x[kept], theta, color=BLUE, linewidth=1.3, label="bending angle θ", zorder=2.2, **points)
    ax.fill_between(x[kept], theta - 2 * sd, theta + 2 * sd, color=BAND, linewidth=0, label="± 2 standard deviations")
    _mark_lone_frames(ax, x[kept], theta, sd)
    if not np.isfinite(series.time_s).any():
        from matplotlib.ticker import MaxNLocator

        ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    _dress_along(ax, x, label, "bending angle θ (°)")
    _frame_angles(ax, theta, sd)


def plot_angle_over_pressure(ax: Axes, series: CurvatureSeries) -> None:
    """θ in degrees over the pressure in MPa, in the order of the frames, each with ± 2 standard deviations."""
    from matplotlib.collections import LineCollection

    kept = _kept(series.angle_rad)
    pressure = np.full(len(series.flag), np.nan) if series.pressure_MPa is None else series.pressure_MPa
    x, theta, sd = pressure[kept], np.degrees(series.angle_rad[kept]), np.degrees(series.angle_sd_rad[kept])
    known = np.isfinite(x) & np.isfinite(theta) & np.isfinite(sd)
    ends = np.stack([theta - 2 * sd, theta + 2 * sd], axis=1)
    bars = np.stack([np.stack([x, x], axis=1), ends], axis=2)[known]
    ax.add_collection(LineCollection(list(bars), colors=BAND, linewidths=2.5, zorder=1), autolim=False)
    points: dict[str, Any] = {"marker": "o", "markersize": 4} if len(x) <= FEW else {}
    ax.plot(x, theta, color=BLUE, linewidth=1.3, **points)
    _mark_lone_frames(ax, x, theta, sd)
    _dress_along(ax, pressure, "pressure (MPa)", "bending angle θ (°)")
    _frame_angles(ax, np.where(known, theta, np.nan), sd)


def plot_residual(ax: Axes, series: CurvatureSeries, x: FloatArray, label: str) -> None:
    """Root mean square distance of the markers from the circle, in pixels, over `x` (T,), below panels with the same x."""
    kept = _kept(series.fit_rms_px)
    points: dict[str, Any] = {"marker": "o", "markersize": 3} if len(x) <= FEW else {}
    ax.plot(x[kept], series.fit_rms_px[kept], color=GREY, linewidth=0.9, **points)
    _dress_along(ax, x, label, "residual (px)")
    if np.isfinite(series.fit_rms_px).any():
        ax.set_ylim(0, max(1.2 * float(np.nanmax(series.fit_rms_px)), 1e-3))
        ax.locator_params(axis="y", nbins=3)
    else:
        ax.set_yticks([])
    for above in ax.get_shared_x_axes().get_siblings(ax):
        if above is not ax:
            above.tick_params(labelbottom=False)
            above.set_xlabel("")


def plot_flags(ax: Axes, x: FloatArray, groups: list[tuple[str, NDArray[np.int64]]]) -> list[Line2D]:
    """A row of marks for each group of flagged frames (label, indices into `x`); returns the marks, for a legend."""
    span = float(np.ptp(x)) if x.size else 0.0
    marks = []
    for row, ((label, frames), (colour, marker)) in enumerate(zip(groups, FLAG_STYLES)):
        at = x[frames]
        if len(at) > MAX_DRAWN // 4 and span > 0:  # more than there are pixels
            at = np.unique(np.round(at / span * MAX_DRAWN / 4)) * span / MAX_DRAWN * 4
        style: dict[str, Any] = {"marker": marker, "markersize": {"|": 8, ".": 6}.get(marker, 4), "color": colour}
        marks += ax.plot(at, np.full(len(at), -row), linestyle="none", label=label, scalex=False, **style)
    ax.set_ylim(0.6 - len(groups), 0.6)
    ax.set_axis_off()
    return marks


def time_axis(series: CurvatureSeries) -> tuple[FloatArray, str]:
    """(T,) what the frames are drawn over, and its label: time, or the picture number where there is none."""
    if len(series.time_s) and np.isfinite(series.time_s).all():
        return series.time_s, "time (s)"
    return np.arange(len(series.time_s), dtype=float), "picture number (from 0)"


def _kept(values: FloatArray) -> NDArray[np.int64]:
    """Indices of the frames to draw: all of them, or the least and the greatest value of each stretch of a long one."""
    if len(values) <= MAX_DRAWN:
        return np.arange(len(values))
    edges = np.linspace(0, len(values), MAX_DRAWN // 2 + 1).astype(int)
    low = np.fmin.reduceat(values, edges[:-1])
    high = np.fmax.reduceat(values, edges[:-1])
    stretch = np.repeat(np.arange(len(low)), np.diff(edges))
    extreme = (values == low[stretch]) | (values == high[stretch])
    extreme[edges[:-1][np.isnan(low)]] = True
    return np.flatnonzero(extreme)


def _mark_lone_frames(ax: Axes, x: FloatArray, theta: FloatArray, sd: FloatArray) -> None:
    """A point with its bar for each frame between two that were not measured: no line and no band run there."""
    measured = np.isfinite(theta) & np.isfinite(x)
    beside = np.concatenate([[False], measured[:-1]]) | np.concatenate([measured[1:], [False]])
    lone = measured & ~beside
    if lone.any():
        bars: dict[str, Any] = {"yerr": 2 * sd[lone], "ecolor": BAND, "elinewidth": 2}
        ax.errorbar(x[lone], theta[lone], fmt="o", color=BLUE, markersize=2 if lone.sum() > 3 else 4, **bars)


def _frame_angles(ax: Axes, theta: FloatArray, sd: FloatArray) -> None:
    """Limits of the angle axis: the angles with their usual band, whatever the uncertainty of a single frame."""
    if not np.isfinite(theta).any():
        style: dict[str, Any] = {"ha": "center", "va": "center", "color": GREY, "fontsize": 11}
        ax.text(0.5, 0.5, "no frame could be measured", transform=ax.transAxes, **style)
        ax.set_yticks([])
        return
    usual = 2 * float(np.nanmedian(sd)) if np.isfinite(sd).any() else 0.0
    low, high = float(np.nanmin(theta)) - usual, float(np.nanmax(theta)) + usual
    margin = max(0.04 * (high - low), 0.5)
    ax.set_ylim(low - margin, high + margin)


def dress(ax: Axes, x_label: str | None = None, y_label: str | None = None) -> None:
    """A light grid, axes on the left and below only, and labels where they are given."""
    if x_label is not None:
        ax.set_xlabel(x_label, fontsize=10)
    if y_label is not None:
        ax.set_ylabel(y_label, fontsize=10)
    ax.tick_params(labelsize=9, color=GREY)
    ax.grid(True, linewidth=0.5, color="#dddddd")
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
    ax.spines[["left", "bottom"]].set_color(GREY)


def _dress_along(ax: Axes, x: FloatArray, x_label: str, y_label: str) -> None:
    known = x[np.isfinite(x)]
    if known.size and np.ptp(known) > 0:
        margin = (0.03 if len(x) <= FEW else 0.01) * np.ptp(known)
        ax.set_xlim(known.min() - margin, known.max() + margin)
    dress(ax, x_label, y_label)
