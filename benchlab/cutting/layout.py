"""Parts laid out on one sheet, without overlap, inner contours before outer ones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from benchlab.actuator import ShellDesign
from benchlab.cutting.lettering import letters, width_of
from benchlab.cutting.outline import Circle, Outline, Stroke
from benchlab.cutting.parts import LETTER_MM, Part, cut_parts
from benchlab.cutting.settings import CutSettings

SPACING_MM = 5.0
SHEETS = {"all": ("fabric", "film", "strip"), "fabric": ("fabric", "strip"), "film": ("film",)}
"""What is cut together: everything, or what comes from one material."""

LAYERS = ("ENGRAVE", "HOLES", "FABRIC_CUT", "FILM_CUT", "STRIP_CUT")
"""In the order in which they are to be cut: marks while the material lies fixed, holes before the contours around them."""

Path = Outline | Circle | Stroke


@dataclass(frozen=True)
class CutSheet:
    """Placed parts; the sheet's lower left corner is at 0, 0."""

    parts: tuple[Part, ...]
    width_mm: float
    height_mm: float
    beside: tuple[Stroke, ...] = ()

    def paths(self) -> Iterator[tuple[str, Path]]:
        """(layer, path) in the order of cutting."""
        for stroke in self.beside:
            yield "ENGRAVE", stroke
        for part in self.parts:
            for mark in part.marks:
                yield "ENGRAVE", mark
        for part in self.parts:
            for hole in part.holes:
                yield "HOLES", hole
        for part in self.parts:
            for window in part.windows:
                yield f"{part.name.upper()}_CUT", window
            yield f"{part.name.upper()}_CUT", part.outer

    def cut_length_mm(self) -> dict[str, float]:
        """Way of the beam on each layer that is cut."""
        lengths: dict[str, float] = {}
        for layer, path in self.paths():
            if isinstance(path, Outline | Circle):
                lengths[layer] = lengths.get(layer, 0.0) + path.length_mm
        return lengths


def lay_out(design: ShellDesign, settings: CutSettings, sheet: str = "all") -> CutSheet:
    """The parts of `sheet` (a key of SHEETS), one above the other, the first on top.

    Raises UsageError where the design cannot be cut with these settings.
    """
    parts = [part for part in cut_parts(design, settings) if part.name in SHEETS[sheet]]
    width = max(_drawn(part)[0] for part in parts) + 2 * SPACING_MM
    placed: list[Part] = []
    beside: list[Stroke] = []
    y = 0.0
    for part in reversed(parts):
        y += SPACING_MM
        if part.beside:
            beside += letters(part.beside, (SPACING_MM + _label_mm(part) / 2, y + LETTER_MM / 2), LETTER_MM)
            y += LETTER_MM + SPACING_MM / 2
        height = _drawn(part)[1]
        placed.insert(0, part.moved(width / 2, y + height / 2))
        y += height
    width = max([width, *(_label_mm(part) + 2 * SPACING_MM for part in parts if part.beside)])
    return CutSheet(tuple(placed), width, y + SPACING_MM, tuple(beside))


def _drawn(part: Part) -> tuple[float, float]:
    """Size of a part as drawn, half a kerf larger all round than it comes out."""
    left, bottom, right, top = part.outer.box_mm
    return right - left, top - bottom


def _label_mm(part: Part) -> float:
    return LETTER_MM * width_of(part.beside)
