"""Angles of inner cells by CalculiX, the numbers that the cell of `benchlab simulate` is judged by.

`python tests/benchmarks/predict_reference.py RUN... [--out FILE]` runs the named groups on one thread and adds their rows to
the table; rows of the same run are replaced. Groups: reference, mesh, cells, bulk, cost (four cells and the full length).
The angle is that of the cell at the mirror plane, times al / (tw + fw); rows of `cells` and `cost` give every cell.
"""

from __future__ import annotations

import argparse
import csv
import io
import itertools
import os
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import benchlab
from benchlab.actuator import ShellDesign
from benchlab.errors import InputError
from benchlab.io.calculix import find_calculix
from benchlab.io.files import written_whole
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup
from benchlab.workflows.calculix_run import run_design
from benchlab.workflows.export import ExportSettings

OUT = Path(__file__).resolve().parents[1] / "unit" / "simulation" / "calculix_reference.csv"
LAYUP = Layup("reference", "benchmark", film=Polynomial(C10=1.5, C20=3.0), moulded=True)
COLUMNS = (
    "run", "design", "elements", "cells", "cell", "around_mm", "along_mm", "edge_mm", "bulk_over_shear", "D1_per_MPa",
    "pressure_MPa", "angle_deg", "cpu_seconds",
)  # fmt: skip
FINE: dict[str, Any] = {"bulk_over_shear": 2000.0}
QUICK: dict[str, Any] = {"bulk_over_shear": 200.0, "steps": 5}
COARSE: dict[str, Any] = {"along_mm": 1.0, "edge_mm": None}
MESHES = ((1.0, 1.7, None), (0.5, 1.7, None), (0.25, 1.7, None), (0.75, 1.7, 0.2), (0.75, 1.7, 0.1), (0.75, 0.9, 0.2))

Run = tuple[str, str, ExportSettings]


def runs(group: str) -> list[Run]:
    """(group, design, settings) of a group."""
    if group == "reference":
        kinds = itertools.product(("sheets", "solid"), ("3 10", "3 20", "9 10", "3 5"))
        return [(group, design, ExportSettings(elements=elements, cells=3, **FINE)) for elements, design in kinds]
    if group == "mesh":
        made = [
            ExportSettings(elements=elements, cells=1, along_mm=along, around_mm=around, edge_mm=edge, **QUICK)
            for elements in ("sheets", "solid")
            for along, around, edge in MESHES
        ]
    elif group == "bulk":
        made = [
            ExportSettings(elements="solid", cells=1, steps=5, bulk_over_shear=bulk) for bulk in (200.0, 2000.0, 2e4)
        ]
    elif group == "cells":
        made = [ExportSettings(elements=e, cells=8, **COARSE, **QUICK) for e in ("solid", "sheets", "shell")]
    elif group == "cost":
        made = [ExportSettings(elements="sheets", cells=n, bulk_over_shear=200.0, **COARSE) for n in (4, None)]
    else:
        raise SystemExit(f"no group is called {group}")
    return [(group, "3 10", settings) for settings in made]


def rows(run: Run) -> list[dict[str, str]]:
    group, name, settings = run
    window, strip = map(float, name.split())
    design = ShellDesign(strip_width_mm=strip, window_width_mm=window)
    before = os.times()
    with tempfile.TemporaryDirectory() as folder:
        done = run_design(design, LAYUP, settings, Path(folder))
    after = os.times()
    seconds = after.children_user - before.children_user + after.children_system - before.children_system
    shown = range(done.angle_deg.shape[1]) if group in ("cells", "cost") else [0]
    d1 = 2 / (settings.bulk_over_shear * LAYUP.film.shear_modulus_MPa)
    values = [
        (group, design.name, settings.elements, done.angle_deg.shape[1], cell + 1, settings.around_mm, settings.along_mm, settings.edge_mm,
         f"{settings.bulk_over_shear:g}", f"{d1:.4g}", f"{p:.4f}", f"{angles[cell]:.3f}", f"{seconds:.1f}")
        for cell in shown
        for p, angles in zip(done.pressure_MPa, done.angle_deg)
    ]  # fmt: skip
    return [dict(zip(COLUMNS, map(str, row))) for row in values]


def key(row: dict[str, str]) -> tuple[str, ...]:
    """What makes a run: everything but the results and the place in the tube."""
    return tuple(
        row[name]
        for name in ("run", "design", "elements", "cells", "around_mm", "along_mm", "edge_mm", "bulk_over_shear")
    )


def add(out: Path, new: list[dict[str, str]], version: str) -> None:
    """Put rows into the table in place of those of the same run."""
    text = out.read_text(encoding="utf-8") if out.exists() else ""
    old = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    made = {key(row) for row in new}
    table = [row for row in old if key(row) not in made] + new
    file = io.StringIO()
    file.write(
        f"# Simulated with {version} on one thread by tests/benchmarks/predict_reference.py of benchlab {benchlab.__version__}\n"
    )
    file.write(
        f"# film {LAYUP.film} MPa {LAYUP.film_thickness_mm} mm, fabric {LAYUP.fabric} {LAYUP.fabric_thickness_mm} mm, strip\n"
    )
    file.write(
        f"# {LAYUP.strip_thickness_mm} mm; round and free of stress at first. solid: film inside, its middle at R, fabric outside of it;\n"
    )
    file.write(
        "# sheets: every layer centred on R. Pressure on the film's inner face. angle_deg: of a cell, times 180 / (tw + fw);\n"
    )
    file.write("# cell 1 is at the mirror plane. cpu_seconds: of the whole run of CalculiX.\n")
    writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(table)
    with written_whole(out) as stage:
        stage.write_text(file.getvalue(), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("groups", nargs="+")
    parser.add_argument("--out", type=Path, default=OUT)
    parser.add_argument("--only", help="of a group: a design as '3 10', or a kind of elements")
    chosen = parser.parse_args()
    program = find_calculix()
    if program is None:
        raise SystemExit("CalculiX (ccx) is not installed")
    said = subprocess.run([program, "-v"], capture_output=True, text=True, check=False).stdout
    version = "CalculiX " + said.split("Version")[-1].split()[0]
    for group in chosen.groups:
        for run in runs(group):
            if chosen.only in (None, run[1], run[2].elements):
                try:
                    new = rows(run)
                except InputError as error:  # CalculiX gave up: said, and without a row
                    print(f"no result for {run}: {error.what}", flush=True)
                    continue
                add(chosen.out, new, version)
                print(new[-1], flush=True)


if __name__ == "__main__":
    main()
