"""The values of a study as a CSV table: a row a cycle of a sample, which `benchlab stats` reads."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from benchlab.io.files import written_whole
from benchlab.io.study_values import CycleValue, DesignValues, RecordingValues, SampleValues, StudyValues
from benchlab.io.table import guarded

COLUMNS = ("design", "sample", "recording", "cycle", "angle_deg", "angle_sd_deg", "left_out_angle_deg", "pressure_peak_MPa", "method",
           "note")  # fmt: skip


def write_values_table(path: Path, values: StudyValues) -> None:
    """Write the table whole or not at all: UTF-8, commas, decimal points, texts guarded against formulas.

    angle_deg: what counts, at the study's pressure. left_out_angle_deg: what does not count, so that nobody counts it by mistake; the
    note says why. Both are empty where there is no angle. Raises InputError where the disk refuses.
    """
    with (
        written_whole(path) as temporary,
        temporary.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(_row(*row) for row in values.rows())


def _row(design: DesignValues, sample: SampleValues, recording: RecordingValues, cycle: CycleValue) -> list[str]:
    why = sample.left_out or recording.left_out
    note = "; ".join(part for part in (f"left out: {why}" if why else "", cycle.flag) if part)
    angle = _number(cycle.angle_deg)
    return [
        guarded(design.name), guarded(sample.name), guarded(recording.file), str(cycle.cycle), "" if why else angle,
        _number(cycle.angle_sd_deg), angle if why else "", _number(cycle.peak_MPa), cycle.method, guarded(note),
    ]  # fmt: skip


def _number(value: float) -> str:
    return repr(float(value)) if math.isfinite(value) else ""
