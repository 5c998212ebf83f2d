"""A run as a CSV table: a row a sample, an empty cell for what is not known. UTF-8, commas, decimal points."""

from __future__ import annotations

import csv
import itertools
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchlab.io.drive_file import cycles_of, origin, steps_of
from benchlab.io.files import written_whole
from benchlab.io.journal import Journal
from benchlab.io.table import guarded
from benchlab.units import FloatArray

_NUMBERS = {
    "time_s": "%.6f",
    "command_MPa": "%.9g",
    "pressure_MPa": "%.9g",
    "angle_deg": "%.8g",
    "flex_V": "%.8g",
    "reference_deg": "%.8g",
}
_MORE = {"late_s": "%.6f", "answer_s": "%.6f", "command_V": "%.6g", "device_time_s": "%.6f", "monitor_V": "%.8g"}


def write_drive_csv(path: Path, journal: Journal) -> None:
    """Write the table whole or not at all. InputError where the disk refuses.

    Columns: time_s, command_MPa, pressure_MPa, angle_deg, flex_V, reference_deg, cycle, step (from 0), step_label, tick, late_s, answer_s,
    command_V, device_time_s, monitor_V, code, status, event: what happened after the sample and before the next, origin: where the
    numbers are from: `bench`, `simulated (twin)`, ...
    """
    samples = journal.samples
    labels = [guarded(str(step.get("label", ""))) for step in steps_of(journal.header)]
    steps = samples["step"].tolist()
    columns = {name: _cells(samples[name], form) for name, form in _NUMBERS.items()}
    columns["cycle"] = map(str, cycles_of(journal).tolist())
    columns["step"] = map(str, steps)
    columns["step_label"] = (labels[step] if step < len(labels) else "" for step in steps)
    columns["tick"] = map(str, samples["tick"].tolist())
    columns |= {name: _cells(samples[name], form) for name, form in _MORE.items()}
    columns["code"] = ("" if code < 0 else str(code) for code in samples["code"].tolist())
    columns["status"] = map(str, samples["status"].tolist())
    columns["event"] = iter(_events(journal))
    columns["origin"] = itertools.repeat(origin(journal.header) or "bench", len(samples))
    with (
        written_whole(path) as temporary,
        temporary.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))


def _events(journal: Journal) -> list[str]:
    """What happened, at the sample that it came after; before the first, at the first."""
    told: list[list[str]] = [[] for _ in journal.samples]
    for event in journal.events if told else ():
        words = event.get("text") or event.get("cause") or event.get("reason") or ""
        told[max(0, int(event["after_samples"]) - 1)].append(f"{event['kind']}: {words}" if words else event["kind"])
    return [guarded("; ".join(each)) for each in told]


def _cells(values: FloatArray, form: str) -> Iterator[str]:
    return (form % value if np.isfinite(value) else "" for value in values.tolist())
