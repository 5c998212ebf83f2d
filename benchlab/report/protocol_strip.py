"""What stands above the panels of a plan: a strip with a block for each segment, and the words of marks and triggers."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Any

from benchlab.errors import counted
from benchlab.protocol.plan import Plan, PlanEvent, Step
from benchlab.report.panels import GREY
from benchlab.report.wording import drawable, width_in

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STRIP_IN, ROW_IN, RIGHT_IN = 0.24, 0.17, 0.25
"""Heights of the strip and of a row of words, and the page's margin on the right that words may use, in inches."""

LETTERS = 7.5
MAX_BLOCKS, MAX_LINES, MAX_NAMED = 400, 100, 15
"""Segments up to which each gets a block, marks and triggers up to which each gets a line, and those that get their words."""

_TRIGGER, _MOVING = "#009E73", "#cfe2f0"
_SHADES = {"hold": "#e3e3e3", "vent": "#f6f6f6", "curvature": "#d5ece3"}
_MEANT = {"curvature": "angle controlled"}
"""Of blocks, by kind of step; what moves the pressure has the other. What a kind is called in the key."""


def plot_segments(ax: Axes, plan: Plan, inches: float) -> None:
    """A block for each segment as it comes, with its words where there is room; none where they would be too narrow to be told apart.

    inches: width of the axes.
    """
    blocks = [list(group) for _, group in groupby(plan.steps, _segment)]
    for steps in blocks if len(blocks) <= MAX_BLOCKS else []:
        start, end = steps[0].start_s, steps[-1].end_s
        ax.axvspan(start, end, facecolor=_SHADES.get(steps[0].kind, _MOVING), edgecolor="white", linewidth=0.6)
        width = inches * (end - start) / plan.duration_s - 0.06
        for text in block_words(steps):
            if width_in(text, LETTERS) <= width:
                ax.text((start + end) / 2, 0.46, text, ha="center", va="center", fontsize=LETTERS, parse_math=False)
                break
    ax.set_ylim(0, 1)
    ax.set_axis_off()


def plot_key(figure: Figure, plan: Plan, right: float, height: float) -> float:
    """What the colours of blocks mean, up to `right` and about `height` of the figure; returns its width in inches."""
    from matplotlib.patches import Patch

    kinds = list(dict.fromkeys(step.kind for step in plan.steps))
    moving = [kind for kind in kinds if kind not in _SHADES]
    shades = {", ".join(moving): _MOVING} if moving else {}
    shades |= {_MEANT.get(kind, kind): shade for kind, shade in _SHADES.items() if kind in kinds}
    blocks = [Patch(facecolor=shade, edgecolor=GREY, linewidth=0.4, label=words) for words, shade in shades.items()]
    place: dict[str, Any] = {"loc": "center right", "bbox_to_anchor": (right, height), "ncols": len(blocks)}
    close: dict[str, Any] = {"borderpad": 0, "borderaxespad": 0, "handlelength": 1.2, "handleheight": 0.9}
    gaps: dict[str, Any] = {"handletextpad": 0.4, "columnspacing": 1.2, "frameon": False, "labelcolor": GREY}
    figure.legend(handles=blocks, fontsize=LETTERS, **place, **close, **gaps)
    return sum(width_in(words, LETTERS) + 0.3 for words in shades)


def block_words(steps: list[Step]) -> list[str]:
    """What a block may be called, the longest first.

    >>> hold, vent = Step("hold", 0, 1, "hold 0.1 MPa for 1 s", start_MPa=0.1), Step("vent", 1, 2, "vent for 1 s", start_MPa=0.0)
    >>> block_words([hold]), block_words([hold, vent, hold, vent])
    (['hold 0.1 MPa for 1 s', 'hold'], ['2 × hold 0.1 to 0.1 MPa, vented between', '2 × hold'])
    """
    first = steps[0]
    if len(steps) == 1:
        return [first.label, first.label.split()[0]]
    if len({step.label for step in steps}) == 1:
        return [f"{first.label}, {counted(len(steps), 'cycle')}", f"{len(steps)} × {first.label.split()[0]}"]
    levels = [step for step in steps if step.kind == first.kind]
    between = ", vented between" if sum(step.kind == "vent" for step in steps) > 1 else ""
    short = f"{len(levels)} × {first.kind}"
    return [f"{short} {levels[0].start_MPa or 0:g} to {levels[-1].start_MPa or 0:g} MPa{between}", short]


def named(events: tuple[PlanEvent, ...]) -> tuple[PlanEvent, ...]:
    """The events that get their words: the first of each kind and text.

    >>> [event.time_s for event in named((PlanEvent(0.0, "mark", "a"), PlanEvent(1.0, "mark", "b"), PlanEvent(2.0, "mark", "a")))]
    [0.0, 1.0]
    """
    first: dict[tuple[str, str], PlanEvent] = {}
    for event in events:
        first.setdefault((event.kind, event.text), event)
    return tuple(first.values())[:MAX_NAMED]


def lined(events: tuple[PlanEvent, ...]) -> tuple[PlanEvent, ...]:
    """The events that get a line: all, or where that would be too many, those that get their words."""
    return events if len(events) <= MAX_LINES else named(events)


def plot_events(strip: Axes, panels: list[Axes], plan: Plan, inches: float) -> None:
    """A line through the panels for each event; the words of those that have them above the strip, in rows."""
    from matplotlib.transforms import offset_copy

    for time_s, kind in {(event.time_s, event.kind): None for event in lined(plan.events)}:
        for ax in panels:
            ax.axvline(time_s, color=_colour(kind), linewidth=0.8, linestyle=(0, (2, 2)), zorder=1.8)
    words, figure = named(plan.events), strip.get_figure(root=True)
    for event, row in zip(words, event_rows(words, plan.duration_s, inches)):
        left = runs_over(event, plan.duration_s, inches)
        shift_in, colour = -0.03 if left else 0.03, _colour(event.kind)
        lifted = offset_copy(strip.get_xaxis_transform(), figure, x=shift_in, y=0.05 + ROW_IN * row, units="inches")
        style: dict[str, Any] = {"fontsize": LETTERS, "color": colour, "ha": "right" if left else "left"}
        strip.text(event.time_s, 1.0, event_words(event), transform=lifted, parse_math=False, **style)
        head = (STRIP_IN + ROW_IN * row + 0.14) / STRIP_IN
        free: dict[str, Any] = {"clip_on": False, "scalex": False, "scaley": False}
        strip.plot([event.time_s] * 2, [1.0, head], color=colour, linewidth=0.8, **free)


def event_words(event: PlanEvent) -> str:
    """As a figure shows it."""
    return f"▼ {drawable(event.text, 20)}" if event.kind == "trigger" else drawable(event.text, 28)


def event_rows(events: tuple[PlanEvent, ...], duration_s: float, inches: float) -> list[int]:
    """The row of each event's words, from 0, so that no words meet those of another event or its line. events: in the order of time.

    >>> event_rows((PlanEvent(0.0, "mark", "first"), PlanEvent(0.1, "mark", "second"), PlanEvent(9.0, "mark", "x")), 10.0, 8.0)
    [1, 0, 0]
    """
    taken: list[tuple[float, float, int]] = []
    for event in reversed(events):
        x = inches * event.time_s / max(duration_s, 1e-9)
        width = width_in(event_words(event), LETTERS) + 0.1
        low, high = (x - width, x) if runs_over(event, duration_s, inches) else (x, x + width)
        row = max((row for start, end, row in taken if start < high and end >= low), default=-1) + 1
        taken.append((low, high, row))
    return [row for _, _, row in reversed(taken)]


def runs_over(event: PlanEvent, duration_s: float, inches: float) -> bool:
    """Whether an event's words would leave the page on the right, so that they stand on the left of its line."""
    room = inches * (1 - event.time_s / max(duration_s, 1e-9)) + RIGHT_IN
    return width_in(event_words(event), LETTERS) + 0.05 > room


def _segment(step: Step) -> tuple[float, bool]:
    """What steps of one block have in common: a line of the file, and whether they are levels."""
    return step.line or step.start_s, step.kind in ("hold", "vent")


def _colour(kind: str) -> str:
    return _TRIGGER if kind == "trigger" else GREY
