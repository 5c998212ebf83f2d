"""The picture of a run on a pressure bench: pressure and angle over time, and angle over pressure where both were measured."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import counted
from benchlab.io.drive_file import cycles_of, origin, trigger_ticks
from benchlab.io.journal import Journal
from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.wording import drawable, fitted

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ORANGE, GREEN = "#D55E00", "#009E73"
MEASURED: dict[str, Any] = {"color": BLUE, "linewidth": 1.6, "zorder": 2}
ASKED: dict[str, Any] = {"color": "#222222", "linewidth": 0.7, "zorder": 2.2}

MAX_DRAWN = 20_000
"""Samples up to which each is drawn; of longer runs, every second, third, … one."""

MAX_MARKS = 30
"""Marks up to which each gets a line and its words."""

_WIDTH, _WIDTH_OF_TWO, _HEIGHT = 8.0, 12.0, 5.6
_LEFT, _RIGHT, _BETWEEN, _TOP, _FOOT, _GAP = 0.75, 0.25, 0.8, 0.95, 0.55, 0.28


def draw_drive_figure(journal: Journal) -> Figure:
    """The figure of a run: title, where it was made and how it ended, then panels."""
    samples = journal.samples[:: 1 + len(journal.samples) // MAX_DRAWN]
    angle, pressure = (np.isfinite(samples[name]).any() for name in ("angle_deg", "pressure_MPa"))
    angle = bool(angle or np.isfinite(samples["reference_deg"]).any())
    loop = bool(pressure and np.isfinite(samples["angle_deg"]).any())
    width = _WIDTH_OF_TWO if loop else _WIDTH
    height = _HEIGHT if angle else 0.65 * _HEIGHT
    figure = figure_class()(figsize=(width, height), dpi=DPI)
    panel = (width - _LEFT - _RIGHT - _BETWEEN * loop) / (1 + loop)
    rows = 1 + angle
    tall = (height - _TOP - _FOOT - _GAP * (rows - 1)) / rows

    def axes(left: float, bottom: float, high: float, beside: Axes | None = None) -> Axes:
        return figure.add_axes((left / width, bottom / height, panel / width, high / height), sharex=beside)

    upper = axes(_LEFT, _FOOT + (rows - 1) * (tall + _GAP), tall)
    plot_pressure(upper, samples)
    if angle:
        lower = axes(_LEFT, _FOOT, tall, upper)
        plot_angle(lower, samples)
        upper.tick_params(labelbottom=False)
        upper.set_xlabel("")
    low, high = upper.get_ylim()
    upper.set_ylim(low, high + 0.3 * (high - low))  # room for the words of marks
    for ax in figure.axes:
        plot_marks(ax, journal, words=ax is upper)
    if loop:
        plot_loop(axes(_LEFT + panel + _BETWEEN, _FOOT, height - _TOP - _FOOT), samples, journal)
    _write_words(figure, journal, width, height)
    return figure


def plot_pressure(ax: Axes, samples: NDArray[np.void]) -> None:
    """What was asked for and what was measured, in MPa over s."""
    ax.plot(samples["time_s"], samples["command_MPa"], label="asked for", **ASKED)
    if np.isfinite(samples["pressure_MPa"]).any():
        ax.plot(samples["time_s"], samples["pressure_MPa"], label="measured", **MEASURED)
    else:
        ax.plot([], [], " ", label="not measured")
    dress(ax, "time (s)", "pressure (MPa)")
    _legend(ax)


def plot_angle(ax: Axes, samples: NDArray[np.void]) -> None:
    """The angle by the flex sensor, and the one asked for in closed loop, in degrees over s."""
    if np.isfinite(samples["reference_deg"]).any():
        ax.plot(samples["time_s"], samples["reference_deg"], label="asked for", **ASKED)
    ax.plot(samples["time_s"], samples["angle_deg"], label="by the flex sensor", **MEASURED)
    dress(ax, "time (s)", "bending angle θ (°)")
    _legend(ax)


def plot_loop(ax: Axes, samples: NDArray[np.void], journal: Journal) -> None:
    """Angle over measured pressure, in the order of the samples: the first cycle, those after it, and what is in none."""
    cycle = cycles_of(journal)[:: 1 + len(journal.samples) // MAX_DRAWN]
    x, y = samples["pressure_MPa"], samples["angle_deg"]
    last = int(cycle.max(initial=0))
    parts = [
        (cycle == 0, "in no cycle", "#aaaaaa", 0.9),
        (cycle > 1, "cycle 2" if last == 2 else f"cycles 2 to {last}", BLUE, 0.9),
        (cycle == 1, "cycle 1", ORANGE if last > 1 else BLUE, 1.2),
    ]
    for here, label, colour, width in parts:
        if here.any():
            ax.plot(x, np.where(here, y, np.nan), color=colour, linewidth=width, label=label)
    dress(ax, "pressure measured (MPa)", "bending angle θ (°)")
    if len(ax.lines) > 1:
        _legend(ax)


def plot_marks(ax: Axes, journal: Journal, words: bool) -> None:
    """A line at each mark, pause and trigger of the camera, and at the end of a run that was not completed."""
    near_s = 0.02 * float(np.ptp(journal.samples["time_s"])) if len(journal.samples) else 0.0
    groups: list[tuple[float, list[str]]] = []
    for event in journal.events:
        if event["kind"] not in ("mark", "trigger", "pause", "resume") or event.get("time_s") is None:
            continue
        text = "camera" if event["kind"] == "trigger" else str(event.get("text") or event["kind"])
        if groups and event["time_s"] - groups[-1][0] < near_s:
            groups[-1][1].append(text)
        else:
            groups.append((float(event["time_s"]), [text]))
    for time_s, texts in groups[:MAX_MARKS]:
        _line(ax, time_s, ", ".join(texts) if words else "", GREY)
    stop = journal.stop
    if stop is not None and stop.get("reason") != "completed" and stop.get("time_s") is not None:
        _line(ax, float(stop["time_s"]), str(stop.get("reason", "stopped")) if words else "", ORANGE)


def _line(ax: Axes, time_s: float, words: str, colour: str) -> None:
    ax.axvline(time_s, color=colour, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
    if words:
        place: dict[str, Any] = {"xy": (time_s, 1.0), "xycoords": ("data", "axes fraction"), "xytext": (2, -2)}
        ax.annotate(drawable(words, 24), **place, textcoords="offset points", rotation=90, va="top", ha="left",
                    fontsize=6.5, color=colour, parse_math=False)  # fmt: skip


def _legend(ax: Axes) -> None:
    """Above the panel, at its right, where nothing is drawn."""
    place: dict[str, Any] = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.1, "ncols": 3}
    ax.legend(fontsize=8, frameon=False, borderpad=0.1, **place)


def _write_words(figure: Figure, journal: Journal, width: float, height: float) -> None:
    room = width - _LEFT - _RIGHT
    style: dict[str, Any] = {"parse_math": False, "va": "top"}
    title = str(journal.header.get("title", "run"))
    where = origin(journal.header)
    title = f"{title}: {where}" if where else title
    at = _LEFT / width
    figure.text(at, 1 - 0.14 / height, fitted(title, room, 12), fontsize=12, fontweight="bold", **style)
    ended = journal.stop is not None and journal.stop.get("reason") == "completed"
    colour = GREY if ended and not journal.losses else ORANGE
    figure.text(at, 1 - 0.44 / height, fitted(end_words(journal), room, 8.5), fontsize=8.5, color=colour, **style)


def end_words(journal: Journal) -> str:
    """How a run ended and what is lost of it, in a line."""
    stop = journal.stop
    counts = counted(len(journal.samples), "sample")
    triggers = len(trigger_ticks(journal))
    words = [counts, *([f"{counted(triggers, 'trigger')} of the camera"] if triggers else [])]
    if stop is None:
        words.append("no record of its end: recovered up to here; whether it was vented is not known")
    else:
        reason, why = str(stop.get("reason", "")), str(stop.get("words", ""))
        words.append("completed" if reason == "completed" else f"{reason}: {why}" if why else reason)
        words.append("vented" if stop.get("vented") else "NOT CONFIRMED VENTED")
    return "; ".join([*words, *journal.losses_told])
