"""What a report says first where not all of its samples were measured: simulated, emulated, or a mixture."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from benchlab.errors import counted
from benchlab.io.study_values import StudyValues
from benchlab.report.study.figures import OTHER, TITLE_IN
from benchlab.report.wording import width_in

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WHOLE = {
    "twin": "Simulated on the digital twin, nothing was measured.",
    "emulated": "Made on the emulated bench, nothing was measured.",
}
_PARTS = {"": "measured", "twin": "simulated on the digital twin", "emulated": "of the emulated bench"}
_MARKS = {"twin": "simulated", "emulated": "emulated"}
MIXED = "mixed origins"
SIZE, BOLD = 7.5, 1.15
"""Size of the mark, and how much wider bold letters are."""


def origins_of(values: StudyValues) -> dict[str, int]:
    """How many samples have their value from where: "" measured, `twin`, `emulated`. One of several counts in each."""
    found = Counter(origin for design in values.designs for sample in design.counted for origin in sample.origins)
    return dict(sorted(found.items()))


def origins_words(values: StudyValues) -> str:
    """In a sentence or two; "" where all was measured."""
    found = origins_of(values)
    if not set(found) - {""}:
        return ""
    if len(found) == 1:
        return _WHOLE[next(iter(found))]
    parts = ", ".join(f"{counted(n, 'sample')} {_PARTS[origin]}" for origin, n in found.items())
    nothing = ", and nothing was measured" * ("" not in found)
    return f"MIXED ORIGINS{nothing}: {parts}, compared as if they were alike; a difference may be that of the benches."


def origins_mark(values: StudyValues) -> str:
    """In a word or two, for titles and figures; "" where all was measured."""
    found = origins_of(values)
    if not set(found) - {""}:
        return ""
    return _MARKS[next(iter(found))] if len(found) == 1 else MIXED


def write_mark(figure: Figure, mark: str) -> None:
    """A mark in the upper right corner of a figure, or upright at its right edge where the title needs the corner; nothing for ""."""
    if not mark:
        return
    width, height = figure.get_size_inches()
    taken = sum(width_in(text.get_text(), float(text.get_fontsize()) * BOLD) for text in figure.texts)
    upright = taken + width_in(mark, SIZE * BOLD) > width - 0.25
    figure.text(1 - 0.04 / width, 1 - (TITLE_IN if upright else 0.05) / height, mark, va="top", ha="right", fontsize=SIZE,
                fontweight="bold", color=OTHER, rotation=90 if upright else 0)  # fmt: skip
