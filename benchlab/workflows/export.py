"""`benchlab export`: a design and a layup in, a deck for Abaqus or CalculiX out."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.deck.abaqus import abaqus_deck, cut_in_four
from benchlab.deck.calculix import calculix_deck
from benchlab.deck.heading import heading
from benchlab.deck.sheets import sheets_of
from benchlab.deck.solid import Solid, solid_of
from benchlab.deck.tube import Extent, Tube, tube_of
from benchlab.errors import UsageError
from benchlab.io.files import check_new_file, written_whole
from benchlab.io.layup_file import read_layup
from benchlab.simulation.layup import Layup

ENGINES = ("calculix", "abaqus")
ELEMENTS = ("solid", "shell", "sheets")


@dataclass(frozen=True)
class ExportSettings:
    """cells: N from mid rib, None for half the actuator. elements: "solid", "shell" or "sheets" (None: as suits the engine).
    around_mm, along_mm: largest element sizes; edge_mm: beside the borders of windows. bulk_over_shear: of the film in CalculiX."""

    engine: str = "calculix"
    cells: int | None = 4
    elements: str | None = None
    pressure_MPa: float = 0.35
    steps: int = 10
    around_mm: float = 1.7
    along_mm: float = 0.75
    edge_mm: float | None = 0.2
    bulk_over_shear: float = 2000.0

    def check(self) -> None:
        """Raises UsageError for what makes no deck."""
        if self.engine not in ENGINES:
            raise UsageError(f"no engine is called {self.engine!r}", hint=f"use one of {', '.join(ENGINES)}")
        if self.elements not in (None, *ELEMENTS):
            raise UsageError(f"no elements are called {self.elements!r}", hint=f"use one of {', '.join(ELEMENTS)}")
        if self.engine == "abaqus" and self.elements in ("solid", "sheets"):
            raise UsageError(f"--elements {self.elements} is written for CalculiX alone", hint="use --elements shell")
        if not (math.isfinite(self.pressure_MPa) and self.pressure_MPa > 0):
            raise UsageError(f"--pressure-MPa is {self.pressure_MPa}", hint="give a positive pressure in MPa")
        if self.steps < 1:
            raise UsageError(f"--steps is {self.steps}", hint="give one pressure or more")
        if not (math.isfinite(self.bulk_over_shear) and self.bulk_over_shear > 1):
            raise UsageError(f"--bulk-over-shear is {self.bulk_over_shear}", hint="give a number far above 1, as 2000")

    @property
    def kind(self) -> str:
        """Of the elements: those asked for, or those that suit the engine."""
        return self.elements or ("sheets" if self.engine == "calculix" else "shell")

    @property
    def pressures_MPa(self) -> list[float]:
        return [float(p) for p in self.pressure_MPa * np.arange(1, self.steps + 1) / self.steps]


def deck_of(design: ShellDesign, layup: Layup, settings: ExportSettings) -> tuple[Tube | Solid, str]:
    """The model and the deck's text. Raises UsageError."""
    settings.check()
    tube = tube_of(
        design, layup, Extent.of(design, settings.cells), settings.around_mm, settings.along_mm, settings.edge_mm
    )
    if settings.engine == "abaqus":
        lines = heading(tube, settings.pressure_MPa, "abaqus", None)
        return cut_in_four(tube), abaqus_deck(tube, settings.pressures_MPa, lines)
    model = {"shell": lambda tube: tube, "sheets": sheets_of, "solid": solid_of}[settings.kind](tube)
    lines = heading(model, settings.pressure_MPa, "calculix", settings.bulk_over_shear)
    return model, calculix_deck(model, settings.pressures_MPa, lines, settings.bulk_over_shear)


def export(
    design: ShellDesign, material: str | Path, settings: ExportSettings, out: Path, overwrite: bool = False
) -> dict[str, Any]:
    """Write a deck; returns what is in it, as `--json` shows it. Raises UsageError and InputError; then nothing is written."""
    check_new_file(out, overwrite)
    layup = read_layup(material)
    model, text = deck_of(design, layup, settings)
    with written_whole(out) as stage:
        stage.write_text(text, encoding="ascii", newline="\n")
    tube = model if isinstance(model, Tube) else model.tube
    elements = (
        len(model.quads) + len(model.triangles) if isinstance(model, Tube) else len(model.bricks) + len(model.wedges)
    )
    return {
        "deck": str(out),
        "design": {"name": design.name, **asdict(design)},
        "layup": layup.name,
        "engine": settings.engine,
        "elements": settings.kind,
        "cells": tube.extent.cells,
        "length_mm": tube.length_mm,
        "node_count": len(model.nodes_mm),
        "element_count": elements,
        "rib_z_mm": tube.rib_z_mm.tolist(),
        "pressures_MPa": settings.pressures_MPa,
    }
