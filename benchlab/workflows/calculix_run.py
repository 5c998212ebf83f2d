"""A deck of a design run in CalculiX: the angle of every cell against pressure."""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.deck.angles import plane_rotation_rad
from benchlab.deck.grid import FloatArray
from benchlab.deck.solid import Solid
from benchlab.deck.tube import Tube
from benchlab.errors import InputError, UsageError
from benchlab.io.calculix import read_displacements, run_calculix
from benchlab.io.layup_file import read_layup
from benchlab.simulation.layup import Layup
from benchlab.workflows.export import ExportSettings, deck_of


@dataclass(frozen=True)
class CalculixRun:
    """angle_deg (pressures, cells): bending angle of an actuator of which every cell bends like this one, cells from the
    mirror plane to the cap (half a cell first where the mirror plane is in a window); seconds that the engine took."""

    pressure_MPa: FloatArray
    angle_deg: FloatArray
    seconds: float


def run_design(
    design: ShellDesign, layup: Layup, settings: ExportSettings, folder: Path, timeout_s: float | None = None
) -> CalculixRun:
    """Write the deck into `folder`, run it on one thread, read the angles. Raises UsageError and InputError."""
    model, text = deck_of(design, layup, settings)
    deck = folder / f"{design.name}.inp"
    deck.write_text(text, encoding="ascii")
    started = time.monotonic()
    results = run_calculix(deck, timeout_s)
    seconds = time.monotonic() - started
    return CalculixRun(np.array(settings.pressures_MPa), read_angles_deg(results, model), seconds)


def run_and_read(design: ShellDesign, material: str | Path, settings: ExportSettings) -> dict[str, Any]:
    """A deck run out of sight, as `--json` shows it. Raises UsageError where the engine is not CalculiX or is not here."""
    if settings.engine != "calculix":
        raise UsageError(f"a deck for {settings.engine} cannot be run here", hint="leave --run out")
    with tempfile.TemporaryDirectory() as folder:
        done = run_design(design, read_layup(material), settings, Path(folder))
    return {
        "pressure_MPa": done.pressure_MPa.tolist(),
        "angle_deg": done.angle_deg.tolist(),
        "seconds": round(done.seconds, 1),
    }


def read_angles_deg(results: Path, model: Tube | Solid) -> FloatArray:
    """Angles (pressures, cells) from a .dat file, as in CalculixRun. Raises InputError where a set is missing."""
    tube = model if isinstance(model, Tube) else model.tube
    names = [f"RIB_{k:03d}" for k in range(1, len(tube.rib_z_mm) + 1)]
    turned = []
    for time_, sets in sorted(read_displacements(results).items()):
        missing = [name for name in names if name not in sets]
        if missing:
            raise InputError(f"no displacements of {missing[0]} at time {time_:g}", file=results)
        turned.append([plane_rotation_rad(model.nodes_mm[sets[n][0] - 1, 0], sets[n][1]) for n in names])
    rotation = np.unwrap(np.array(turned), axis=1)
    design, cell = tube.design, tube.design.window_width_mm + tube.design.rib_width_mm
    each = np.diff(rotation, axis=1)
    if tube.extent.from_window:
        each = np.column_stack([2 * rotation[:, 0], each])
    return np.degrees(each) * design.length_mm / cell
