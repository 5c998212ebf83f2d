"""The tables of designs and samples in a report."""

from __future__ import annotations

from typing import Any

from benchlab.io.study_values import DesignValues, SampleValues
from benchlab.report.document import Cell, Column, Table, cut
from benchlab.report.rounding import count, number, words
from benchlab.report.study.report import StudyReport, error_of, interval_of, mean_of, sd_of, simulated_of, span_text


def designs_table(report: StudyReport) -> Table:
    """A row a design: what was measured, and what was simulated."""
    columns = (
        Column("design", "design", False), Column("tw_mm"), Column("slw_mm"), Column("samples", "n"), Column("cycles", "cycles"),
        Column("mean_deg", "mean θ (°)"), Column("sd_deg", "SD (°)"), Column("mean_low_deg"), Column("mean_high_deg"),
        Column("", f"{report.percent} interval of mean (°)"), Column("simulated_deg", "simulated (°)"),
        Column("error_deg", "simulated − measured (°)"),
    )  # fmt: skip
    sources = list(
        dict.fromkeys(cut(d.simulated.source, 120) for d in report.values.designs if d.simulated is not None)
    )
    notes = ["n: samples, each counted once with the mean of its cycles. SD: between samples."]
    if sources:
        notes.append(f"Simulated: {'; '.join(sources[:4])}{'; …' * (len(sources) > 4)}.")
    rows = tuple(_design_row(report, design) for design in report.values.designs)
    caption = f"Bending angle θ of each design at {report.values.pressure_MPa:g} MPa."
    return Table("designs", caption, columns, rows, " ".join(notes))


def _design_row(report: StudyReport, design: DesignValues) -> tuple[Cell, ...]:
    places = report.places
    mean, sd = mean_of(design), sd_of(design)
    low, high = interval_of(design, report.confidence)
    shell: Any = design.shell
    return (
        words(design.name, 40), number(None if shell is None else shell.window_width_mm, 1),
        number(None if shell is None else shell.strip_width_mm, 1),
        count(len(design.counted)), count(sum(len(sample.cycles) for sample in design.counted)),
        number(mean, places), number(sd, places), number(low, places), number(high, places),
        Cell(None, span_text(low, high, places)), number(simulated_of(design), places), number(error_of(design), places),
    )  # fmt: skip


def samples_table(report: StudyReport) -> Table:
    """A row a sample, also those that do not count, with why."""
    rows = [_sample_row(report, design, sample) for design in report.values.designs for sample in design.samples]
    columns = (
        Column("design"), Column("sample", "sample", False), Column("cycles", "cycles"),
        Column("angle_deg", "θ, mean of cycles (°)"), Column("cycle_sd_deg", "SD of cycles (°)"),
        Column("recordings", "recordings", False), Column("note", "note", False),
    )  # fmt: skip
    caption = f"Every sample: θ at {report.values.pressure_MPa:g} MPa."
    return Table("samples", caption, columns, tuple(rows), by="design")


def _sample_row(report: StudyReport, design: DesignValues, sample: SampleValues) -> tuple[Cell, ...]:
    angles = [cycle.angle_deg for cycle in sample.cycles]
    mean = sample.angle_deg
    spread = (sum((a - mean) ** 2 for a in angles) / (len(angles) - 1)) ** 0.5 if len(angles) > 1 else None
    why = sample.left_out or next((r.left_out for r in sample.recordings if r.left_out), "")
    note = f"left out: {why}" if why else "" if angles else "no value"
    files = ", ".join(recording.file for recording in sample.recordings)
    return (
        words(design.name, 40), words(sample.name, 40), count(len(angles)), number(mean, report.places),
        number(spread, report.places + 1), words(files, 60), words(note, 80),
    )  # fmt: skip
