"""The picture of a run on a pressure bench: pressure and angle over time, and angle over pressure where both were measured."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import counted
from benchlab.io.drive_file import cycles_of, origin, trigger_ticks
from benchlab.io.drive_gaps import Gap, broken, gaps_of
from benchlab.io.journal import Journal, vent_told
from benchlab.report.figures import DPI, figure_class
from benchlab.report.panels import BLUE, GREY, dress
from benchlab.report.wording import drawable, fitted, width_in

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ORANGE, GREEN = "#D55E00", "#009E73"
MEASURED: dict[str, Any] = {"color": BLUE, "linewidth": 1.1, "zorder": 2.2}
ASKED: dict[str, Any] = {"color": "#b4b4b4", "linewidth": 2.4, "zorder": 2}
"""A broad pale line, on which what was measured lies thin and dark: both are seen where they are one."""

MAX_DRAWN = 20_000
"""Samples up to which each is drawn; of longer runs, every second, third, … one."""

MAX_WORDS = 30
"""Characters of the words at a line; of longer ones, the middle is cut."""

MAX_MARKS = 30
"""Marks up to which each gets a line and its words."""

_WIDTH, _WIDTH_OF_TWO, _HEIGHT = 8.0, 12.0, 5.6
_LEFT, _RIGHT, _BETWEEN, _TOP, _FOOT, _GAP = 0.75, 0.25, 0.8, 0.79, 0.55, 0.28
_LINE, _MOST_LINES = 0.16, 3
"""Height of a line of the words under the title, and how many there may be."""

_MARK_IN = 0.15
"""Width of the words of a mark, which stand upright: nearer marks share theirs."""


def draw_drive_figure(journal: Journal) -> Figure:
    """The figure of a run: title, where it was made and how it ended, then panels."""
    samples, cycle = _drawn(journal)
    angle, pressure = (np.isfinite(samples[name]).any() for name in ("angle_deg", "pressure_MPa"))
    angle = bool(angle or np.isfinite(samples["reference_deg"]).any())
    loop = bool(pressure and np.isfinite(samples["angle_deg"]).any())
    width = _WIDTH_OF_TWO if loop else _WIDTH
    lines = _lines(end_words(journal), width - _LEFT - _RIGHT, 8.5)
    top = _TOP + _LINE * len(lines)
    height = (_HEIGHT if angle else 0.65 * _HEIGHT) + top - _TOP - _LINE
    figure = figure_class()(figsize=(width, height), dpi=DPI)
    panel = (width - _LEFT - _RIGHT - _BETWEEN * loop) / (1 + loop)
    rows = 1 + angle
    tall = (height - top - _FOOT - _GAP * (rows - 1)) / rows

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
        plot_pauses(ax, journal)
        plot_marks(ax, journal, near_s=_MARK_IN / panel * float(np.ptp(ax.get_xlim())), words=ax is upper)
    if loop:
        plot_loop(axes(_LEFT + panel + _BETWEEN, _FOOT, height - top - _FOOT), samples, cycle)
    _write_words(figure, journal, lines, width, height)
    return figure


def _drawn(journal: Journal) -> tuple[NDArray[np.void], NDArray[np.int64]]:
    """The samples that are drawn, with a row of no numbers in each hole, and the cycle of each."""
    every = 1 + len(journal.samples) // MAX_DRAWN
    gaps = [Gap(gap.after // every, gap.ticks, gap.begin_s, gap.end_s) for gap in gaps_of(journal)]
    cycle = np.insert(cycles_of(journal)[::every], [gap.after + 1 for gap in gaps], 0)
    return broken(journal.samples[::every], gaps), cycle


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


def plot_loop(ax: Axes, samples: NDArray[np.void], cycle: NDArray[np.int64]) -> None:
    """Angle over measured pressure, in the order of the samples, each a point: the first cycle, those after it, and what is in none."""
    x, y = samples["pressure_MPa"], samples["angle_deg"]
    last = int(cycle.max(initial=0))
    parts = [
        (cycle == 0, "in no cycle", "#aaaaaa", 0.9),
        (cycle > 1, "cycle 2" if last == 2 else f"cycles 2 to {last}", BLUE, 0.9),
        (cycle == 1, "cycle 1", ORANGE if last > 1 else BLUE, 1.2),
    ]
    for here, label, colour, width in parts:
        if here.any():
            ax.plot(x, np.where(here, y, np.nan), ".-", color=colour, linewidth=0.6 * width, markersize=3.8 * width,
                    markeredgewidth=0, label=label)  # fmt: skip
    dress(ax, "pressure measured (MPa)", "bending angle θ (°)")
    if len(ax.lines) > 1:
        _legend(ax)


def plot_pauses(ax: Axes, journal: Journal) -> None:
    """A grey ground under each pause, to its end or that of the run."""
    begin: float | None = None
    last = float(journal.samples["time_s"][-1]) if len(journal.samples) else 0.0
    ends = ({"kind": "resume", "time_s": (journal.stop or {}).get("time_s") or last},)
    for event in (*journal.events, *ends):
        if event.get("time_s") is None:
            continue
        if event["kind"] == "pause" and begin is None:
            begin = float(event["time_s"])
        elif event["kind"] == "resume" and begin is not None:
            ax.axvspan(begin, max(begin, float(event["time_s"])), color="#e4e4e4", linewidth=0, zorder=0.5)
            begin = None


def plot_marks(ax: Axes, journal: Journal, near_s: float, words: bool) -> None:
    """A line at each mark, pause and trigger of the camera, and at the end of a run that was not completed; nearer than near_s, they
    share their words."""
    for time_s, texts, stopped in _marks(journal, near_s):
        _line(ax, time_s, ", ".join(texts) if words else "", ORANGE if stopped else GREY)


def _marks(journal: Journal, near_s: float) -> list[tuple[float, list[str], bool]]:
    """Time, words, and whether it is a stop: up to MAX_MARKS and the stop. Two that share words stand at the first of them."""
    groups: list[tuple[float, list[str], bool]] = []
    for event in journal.events:
        stop = event["kind"] == "stop" and event.get("reason") != "completed"
        if not (stop or event["kind"] in ("mark", "trigger", "pause")) or event.get("time_s") is None:
            continue
        what = event.get("reason", "stopped") if stop else event.get("text") or event["kind"]
        text = "camera" if event["kind"] == "trigger" else str(what)
        time_s = float(event["time_s"])
        if groups and time_s - groups[-1][0] < near_s:
            first, texts, _ = groups.pop()
            groups.append((time_s if stop else first, [*texts, text], stop))
        elif stop or len(groups) < MAX_MARKS:
            groups.append((time_s, [text], stop))
    return groups


def _line(ax: Axes, time_s: float, words: str, colour: str) -> None:
    ax.axvline(time_s, color=colour, linewidth=0.8, linestyle=(0, (4, 3)), zorder=2.1)
    if words:
        place: dict[str, Any] = {"xy": (time_s, 1.0), "xycoords": ("data", "axes fraction"), "xytext": (2, -2)}
        ground = {"facecolor": "white", "alpha": 0.85, "linewidth": 0, "pad": 0.8}
        ax.annotate(drawable(words, MAX_WORDS), **place, textcoords="offset points", rotation=90, va="top", ha="left",
                    bbox=ground, zorder=5, fontsize=6.5, color=colour, parse_math=False)  # fmt: skip


def _legend(ax: Axes) -> None:
    """Above the panel, at its right, where nothing is drawn."""
    place: dict[str, Any] = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.1, "ncols": 3}
    ax.legend(fontsize=8, frameon=False, borderpad=0.1, **place)


def _lines(words: str, inches: float, size: float) -> list[str]:
    """Words on up to _MOST_LINES lines of so many inches; of longer ones, the middle of the last is cut."""
    whole = drawable(words, 10_000)
    letters = max(20, int(len(whole) * inches / max(width_in(whole, size), 1e-9) * 0.96))
    lines = textwrap.wrap(whole, letters, break_on_hyphens=False) or [""]
    kept = [*lines[: _MOST_LINES - 1], *([" ".join(lines[_MOST_LINES - 1 :])] if len(lines) >= _MOST_LINES else [])]
    return [fitted(line, inches, size) for line in kept]


def _write_words(figure: Figure, journal: Journal, lines: list[str], width: float, height: float) -> None:
    room = width - _LEFT - _RIGHT
    style: dict[str, Any] = {"parse_math": False, "va": "top"}
    title = str(journal.header.get("title", "run"))
    where = origin(journal.header)
    title = f"{title}: {where}" if where else title
    at = _LEFT / width
    figure.text(at, 1 - 0.14 / height, fitted(title, room, 12), fontsize=12, fontweight="bold", **style)
    ended = journal.stop is not None and journal.stop.get("reason") == "completed"
    whole = ended and not journal.losses and not gaps_of(journal)
    for index, line in enumerate(lines):
        below = 0.44 + _LINE * index
        figure.text(at, 1 - below / height, line, fontsize=8.5, color=GREY if whole else ORANGE, **style)


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
        words.append(vent_told(stop))
    gaps = gaps_of(journal)
    if len(gaps) == 1:
        words.append(gaps[0].words)
    elif gaps:
        words.append(f"{sum(gap.ticks for gap in gaps)} ticks without a sample, in {len(gaps)} gaps")
    return "; ".join([*words, *(f"lost {each}" for each in journal.losses_told)])
