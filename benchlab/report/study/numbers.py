"""A repeatability report as plain data for machines: every number of the page and every value behind it."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from benchlab.actuator import DIMENSIONS
from benchlab.force.curve_json import blocked_force_json
from benchlab.io.nexus import plain
from benchlab.io.study_values import DesignValues, Missing, SampleValues
from benchlab.report.study.differences import all_warnings
from benchlab.report.study.origins import origins_of
from benchlab.report.study.report import ComparedSet, StudyReport, error_of, mean_of, scatter_of, sd_of, simulated_of
from benchlab.report.study.verdict import verdict_words

SCHEMA = "benchlab.study_report/1"


def report_numbers(report: StudyReport) -> dict[str, Any]:
    """The document of report.json: JSON's own types; null is what is not known or not defined, never NaN."""
    values, scatter = report.values, scatter_of(report)
    found: Any = plain(
        {
            "schema": SCHEMA,
            "title": values.title,
            "notes": values.notes,
            "pressure_MPa": values.pressure_MPa,
            "hold_tolerance_MPa": values.hold_tolerance_MPa,
            "origins": {origin or "measured": count for origin, count in origins_of(values).items()},
            "verdict": [f"{block.head} {block.text}".strip() for block in verdict_words(report)],
            "scatter": None if scatter is None else {**asdict(scatter), "limit_deg": scatter.limit_deg},
            "designs": [_design(report, design) for design in values.designs],
            "curve_pressure_MPa": values.curve_MPa,
            "sets": [_set(one) for one in report.compared],
            "published": [
                {"title": one.title, "figure": one.figure, **one.found.as_json()} for one in report.published_sets
            ],
            "failures": [_missing(one) for one in values.failures],
            "left_out": [_missing(one) for one in values.left_out],
            "warnings": [{"what": what, "why": why} for what, why in all_warnings(report)],
            "inputs": values.inputs,
            "provenance": report.provenance,
        }
    )
    return found


def _design(report: StudyReport, design: DesignValues) -> dict[str, Any]:
    mean, spread = design.band_deg(len(report.values.curve_MPa))
    paper, simulated = report.published_of(design), design.simulated
    return {
        "name": design.name,
        **{name: getattr(design.shell, field, None) for name, field in DIMENSIONS.items()},
        "n": len(design.counted),
        "cycles": sum(len(sample.cycles) for sample in design.counted),
        "mean_deg": mean_of(design),
        "sd_deg": sd_of(design),
        "simulated_deg": simulated_of(design),
        "simulated_by": None if simulated is None else simulated.source,
        "simulated_less_measured_deg": error_of(design),
        "published": None if paper is None else asdict(paper),
        "blocked_force": None if design.force is None else blocked_force_json(design.force),
        "curve": {"mean_deg": mean, "sd_deg": spread},
        "samples": [_sample(sample) for sample in design.samples],
    }


def _sample(sample: SampleValues) -> dict[str, Any]:
    return {
        "name": sample.name,
        "angle_deg": sample.angle_deg,
        "left_out": sample.left_out or None,
        "recordings": [
            {
                "file": recording.file,
                "status": recording.status,
                "left_out": recording.left_out or None,
                "origin": recording.origin or None,
                "warnings": recording.warnings,
                "cycles": [asdict(cycle) for cycle in recording.cycles],
                "curve_deg": recording.curve_deg,
            }
            for recording in sample.recordings
        ],
    }


def _set(one: ComparedSet) -> dict[str, Any]:
    chosen = {"name": one.chosen.name, "title": one.chosen.title, "designs": one.chosen.designs}
    return {**chosen, **({"reason": one.reason} if one.found is None else one.found.as_json())}


def _missing(one: Missing) -> dict[str, Any]:
    return {"what": one.what, **{name: value or None for name, value in asdict(one).items()}}
