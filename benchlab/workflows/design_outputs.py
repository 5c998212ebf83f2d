"""What an inverse design writes: a table, a figure, and the best designs as files."""

from __future__ import annotations

import csv
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

from benchlab.io.design_file import write_design
from benchlab.io.files import cannot_write, check_new_file, make_folder, written_whole
from benchlab.workflows.design_wish import SLW, TW, AngleMap, Wish
from benchlab.workflows.simulated import Conditions

PREFERENCES = {
    "least_cut_error": "least change of angle by cutting errors",
    "least_volume": "least volume",
    "most_force": "most blocked force",
    "least_film_strain": "least strained film",
}
"""What a design may be the best in."""


def design_paths(out: Path, wish: Wish, overwrite: bool) -> dict[str, Path]:
    """What will be written, by name. Raises UsageError where something is in the way."""
    stem = f"design_{wish.angle_deg:g}deg"
    paths = {"table": out / f"{stem}.csv", "figure": out / f"{stem}.png"}
    paths |= {name: out / f"{stem}_{name}.yaml" for name in ("balanced", *PREFERENCES)}
    make_folder(out)
    for path in paths.values():
        check_new_file(path, overwrite)
    return paths


def write_designs(
    wish: Wish,
    conditions: Conditions,
    angles: AngleMap,
    candidates: list[dict[str, Any]],
    best: dict[str, int],
    paths: dict[str, Path],
) -> None:
    """Everything into a hidden folder first, then into its place."""
    from benchlab.report.design_figure import draw_design_figure
    from benchlab.report.figures import save_png

    folder = paths["table"].parent
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=".design-") as hidden:
            stage = {name: Path(hidden) / path.name for name, path in paths.items()}
            _write_table(stage["table"], candidates, best)
            for name, index in best.items():
                row = candidates[index]
                write_design(stage[name], replace(wish.base, **{TW: row["tw_mm"], SLW: row["slw_mm"]}))
            note = f"simulated, not measured · material {conditions.layup.name} · blocked force: {conditions.fixture}"
            title = f"Designs that bend {wish.angle_deg:g}° at {conditions.pressures_MPa[-1]:g} MPa"
            swapped = wish.along == TW
            figure = draw_design_figure(
                angles.nodes if swapped else angles.lines,
                angles.lines if swapped else angles.nodes,
                angles.angle_deg.T if swapped else angles.angle_deg,
                wish.angle_deg, candidates, best, title, note,
            )  # fmt: skip
            save_png(figure, stage["figure"])
            for name, path in paths.items():
                if stage[name].exists():
                    stage[name].replace(path)
    except OSError as error:
        raise cannot_write(error, folder) from error


def _write_table(path: Path, candidates: list[dict[str, Any]], best: dict[str, int]) -> None:
    """A row a design; best_in names what it is the best in."""
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*candidates[0], "best_in"])
        for index, row in enumerate(candidates):
            cells = ["" if v is None else f"{v:.8g}" if isinstance(v, float) else str(v).lower() for v in row.values()]
            writer.writerow([*cells, " ".join(name for name, chosen in best.items() if chosen == index)])
