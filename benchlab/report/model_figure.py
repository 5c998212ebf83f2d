"""The figure of `benchlab simulate --model`: what a model predicts, over what its base predicts alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.wording import drawable
from benchlab.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PANELS = (
    ("angle_deg", "angle_deg", "bending angle θ (°)"),
    ("volume_mL", "volume_mL", "volume (mL)"),
    ("blocked_force_N", "force_N", "blocked force (N)"),
)
"""Column with the model, name of the base's curve, label."""


def draw_model_figure(
    design: str, words: str, columns: Mapping[str, FloatArray], bare: Mapping[str, FloatArray]
) -> Figure:
    """Angle, volume and blocked force over pressure, (P,) each, with the model in blue and of its base alone in grey."""
    figure = figure_class()(figsize=(9.0, 4.0), dpi=DPI)
    shown = [panel for panel in _PANELS if np.isfinite(columns[panel[0]]).any()]
    style: dict[str, Any] = {"marker": "o", "markersize": 3.0} if len(columns["pressure_MPa"]) <= 60 else {}
    for place, (column, curve, label) in enumerate(shown):
        width = 0.92 / len(shown)
        ax = figure.add_axes((0.07 + place * width, 0.13, width - 0.08, 0.66))
        if curve in bare:
            ax.plot(columns["pressure_MPa"], bare[curve], color=GREY, linestyle="--", linewidth=1.3, label="base alone")
        ax.plot(columns["pressure_MPa"], columns[column], color=BLUE, linewidth=1.5, label="with the model", **style)
        dress(ax, "pressure (MPa)", label)
        if not place:
            ax.legend(fontsize=9, frameon=False)
    title = f"{design}, simulated, slow first loading: {columns['angle_deg'][-1]:.1f}° at {columns['pressure_MPa'][-1]:g} MPa"
    figure.text(0.02, 0.93, drawable(title, 90), fontsize=12, fontweight="bold", parse_math=False)
    figure.text(0.02, 0.86, drawable(words, 120), fontsize=9.5, color=GREY, parse_math=False)
    return figure
