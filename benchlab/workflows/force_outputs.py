"""Blocked force on disk: peaks and means as CSV, the figure as PNG and SVG."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from benchlab.force.curve import BlockedForce
from benchlab.io.files import cannot_write, written_whole
from benchlab.io.table import guarded
from benchlab.report.figures import save_png
from benchlab.report.force_figure import draw_force_figure
from benchlab.report.svg import svg_of
from benchlab.workflows.force_cycles import FoundCycles

FINAL = ("blocked_force.csv", "blocked_force.json", "blocked_force.png", "blocked_force.svg")

PEAK_COLUMNS = ("actuator", "cycle", "pressure_MPa", "time_s", "reading", "raw_peak_N", "baseline_N", "peak_N", "peak_sd_N",
                "lower_bound", "counts", "note")  # fmt: skip


def write_peaks_csv(path: Path, found: Sequence[FoundCycles]) -> None:
    """A row a cycle; `reading` is its place in the record, from 1. An empty cell is not known. InputError where the disk refuses."""
    rows = [
        [guarded(one.actuator), peak.number, _cell(pressure), _cell(peak.time_s), peak.row + 1, _cell(peak.raw_N), _cell(peak.baseline_N),
         _cell(peak.peak_N), _cell(peak.sd_N), int(peak.lower_bound), int(math.isfinite(pressure)), guarded(peak.why)]
        for one in found
        for peak, pressure in zip(one.record.peaks, one.pressure_MPa.tolist())
    ]  # fmt: skip
    _write(path, PEAK_COLUMNS, rows)


def write_blocked_csv(path: Path, found: BlockedForce) -> None:
    """A row a pressure: actuators, mean, SD, the line with its band, and the mean of each actuator. InputError where the disk refuses."""
    columns = ["pressure_MPa", "actuators", "mean_N", "sd_N", "lower_bound", "line_N", "line_low_N", "line_high_N"]
    columns += [guarded(f"{name} mean_N") for name in found.actuators]
    line = (
        [[math.nan] * len(found.pressure_MPa)] * 3
        if found.line is None
        else [v.tolist() for v in found.line.at(found.pressure_MPa)]
    )
    rows = [
        [_cell(found.pressure_MPa[j]), int(found.n[j]), _cell(found.over_actuators_N[j]), _cell(found.sd_N[j]),
         int(found.lower_bound[:, j].any()), *(_cell(values[j]) for values in line), *(_cell(value) for value in found.mean_N[:, j])]
        for j in range(len(found.pressure_MPa))
    ]  # fmt: skip
    _write(path, columns, rows)


def draw_figures(folder: Path, found: BlockedForce, drawn: bool) -> None:
    """The figure, in the manner of the paper's Fig. 3b; drawn: its title says that nothing was measured."""
    figure = draw_force_figure(found, drawn)
    png, svg = folder / "blocked_force.png", folder / "blocked_force.svg"
    with written_whole(svg) as temporary:
        temporary.write_text(svg_of(figure), encoding="utf-8")
    with written_whole(png) as temporary:
        try:
            save_png(figure, temporary)
        except OSError as error:
            raise cannot_write(error, png) from error


def _cell(value: float) -> str:
    return f"{value:.8g}" if math.isfinite(value) else ""


def _write(path: Path, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    with (
        written_whole(path) as temporary,
        temporary.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)
