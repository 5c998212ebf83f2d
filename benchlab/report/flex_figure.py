"""A flex sensor's calibration drawn: bending angle over volts with its line, a mark a hold, and what is left of each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchlab.control.flex import FlexCalibration
from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.wording import drawable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FALLING = "#D55E00"


def draw_flex_figure(found: FlexCalibration, title: str, note: str) -> Figure:
    """The holds and their line above, their distance from it below. title, note: plain text; the note says what bench it was."""
    figure = figure_class()(figsize=(6.4, 5.6), dpi=DPI)
    top = figure.add_axes((0.165, 0.37, 0.80, 0.52))
    below = figure.add_axes((0.165, 0.1, 0.80, 0.22), sharex=top)
    for ax, values in ((top, found.angle_deg), (below, found.residual_deg)):
        for way, mark, colour, label in (
            (True, "^", BLUE, "pressure rising"),
            (False, "v", FALLING, "pressure falling"),
        ):
            here = found.rising == way
            ax.plot(found.volts[here], values[here], mark, color=colour, markersize=5, label=label)
        dress(ax)
        ax.yaxis.set_label_coords(-0.125, 0.5)
    ends = np.array([found.volts.min(), found.volts.max()])
    gain, offset = found.line.gain.value, found.line.offset.value
    sign = "−" if offset < 0 else "+"
    words = f"{gain:.4g} °/V · U {sign} {abs(offset):.4g}°".replace("-", "−")
    top.plot(ends, found.line.of(ends), "-", color="black", linewidth=1.1, zorder=1, label=words)
    below.axhline(0, color=GREY, linewidth=0.8)
    below.axhspan(-found.line.sd, found.line.sd, color=GREY, alpha=0.15, linewidth=0, label="± 1 SD of a hold")
    below.legend(
        handles=[below.patches[-1]],
        loc="lower right",
        bbox_to_anchor=(1.0, 0.97),
        frameon=False,
        fontsize=8.5,
        borderaxespad=0,
    )
    top.set_ylabel("bending angle θ (°)")
    top.tick_params(labelbottom=False)
    top.legend(loc="best", frameon=False, fontsize=8.5)
    below.set_ylabel("angle − line (°)")
    below.set_xlabel("volts of the flex sensor's divider")
    figure.text(0.165, 0.95, drawable(title, 60), fontsize=12, fontweight="bold", parse_math=False)
    figure.text(0.165, 0.91, drawable(note, 95), fontsize=8.5, color=GREY, parse_math=False)
    return figure
