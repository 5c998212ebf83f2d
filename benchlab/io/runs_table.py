"""Runs as a tidy table that `benchlab explain` reads: a row a moment of a run, an empty cell for what is not known."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from benchlab.discrepancy.measured import QUANTITIES, Run
from benchlab.io.files import written_whole
from benchlab.io.table import guarded
from benchlab.units import FloatArray

NAMES = ("design", "sample", "run")
OF_A_RUN = ("run_index", "start_s", "orientation_deg")


def write_runs_csv(path: Path, runs: Sequence[Run], origin: str) -> None:
    """Write the table whole or not at all. InputError where the disk refuses.

    Columns: design, sample, run, cycle, time_s, pressure_MPa, command_MPa, those of QUANTITIES that any run has, run_index, start_s,
    orientation_deg, origin: where the numbers are from, as `simulated (twin)` or `bench`.
    """
    quantities = [name for name in QUANTITIES if any(name in run.values for run in runs)]
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*NAMES, "cycle", "time_s", "pressure_MPa", "command_MPa", *quantities, *OF_A_RUN, "origin"])
        for run in runs:
            names = [guarded(getattr(run, name)) for name in NAMES]
            tail = [_cell(getattr(run, name)) for name in OF_A_RUN]
            writer.writerows([*names, *cells, *tail, origin] for cells in zip(*_columns(run, quantities), strict=True))


def _columns(run: Run, quantities: Sequence[str]) -> Iterator[list[str]]:
    yield _cells(run.cycle, run, "%.0f")
    yield _cells(run.time_s, run, "%.4f")
    yield _cells(run.pressure_MPa, run, "%.6f")
    yield _cells(run.command_MPa, run, "%.6f")
    for name in quantities:
        yield _cells(run.values.get(name), run, "%.5g" if name == "force_N" else "%.4f")


def _cells(values: FloatArray | None, run: Run, form: str) -> list[str]:
    if values is None:
        return [""] * len(run.time_s)
    return [form % value if np.isfinite(value) else "" for value in values.tolist()]


def _cell(value: float | None) -> str:
    return "" if value is None or not np.isfinite(value) else f"{value:.10g}"
