"""`benchlab report`: a study in; a page, tables, figures and numbers of it out."""

from __future__ import annotations

from collections.abc import Sequence

from benchlab.errors import BenchlabError
from benchlab.io.published import PublishedAngle
from benchlab.io.study_values import StudySet, StudyValues
from benchlab.report.study.report import ComparedSet, PublishedSet, SAME_PRESSURE_MPa, StudyReport
from benchlab.stats.comparison import Comparison, compare, compare_summaries
from benchlab.stats.measurements import measurements_of
from benchlab.workflows.provenance import made_by


def report_of(
    values: StudyValues,
    published: Sequence[PublishedAngle] = (),
    confidence: float = 0.95,
    difference_deg: float | None = None,
) -> StudyReport:
    """Compare each set of a study, and the paper's designs where the study has one of them at their pressure."""
    near = tuple(p for p in published if abs(p.pressure_MPa - values.pressure_MPa) <= SAME_PRESSURE_MPa)
    paper = {p.design for p in near if p.measured_angle_deg is not None}
    common = any(design.shell in paper for design in values.designs)
    return StudyReport(
        values,
        tuple(_compared(values, chosen, confidence, difference_deg) for chosen in values.sets),
        near,
        _published_sets(near, confidence) if common else (),
        made_by("numpy", "scipy", "matplotlib", "jinja2"),
    )


def _compared(values: StudyValues, chosen: StudySet, confidence: float, difference_deg: float | None) -> ComparedSet:
    rows = [
        (design.name, sample.name, cycle.angle_deg)
        for design in values.of(chosen)
        for sample in design.counted
        for cycle in sample.cycles
    ]
    if not rows:
        return ComparedSet(chosen, None, "No sample has a value.")
    groups, samples, angles = zip(*rows)
    try:
        return ComparedSet(chosen, compare(measurements_of(groups, angles, samples), confidence, difference_deg))
    except BenchlabError as error:
        if error.exit_code == 2:
            raise
        return ComparedSet(chosen, None, str(error))


def _published_sets(published: Sequence[PublishedAngle], confidence: float) -> tuple[PublishedSet, ...]:
    """The slw set and the tw set of the paper's Figs 6c and 7c, and all its designs."""
    known = [p for p in published if p.measured_sd_deg is not None and p.samples is not None]
    chosen = (
        ("Paper, slw set", "Fig. 6c", [p for p in known if p.tw_mm == 3]),
        ("Paper, tw set", "Fig. 7c", [p for p in known if p.slw_mm == 10]),
        ("Paper, all designs", "", known),
    )
    return tuple(PublishedSet(title, figure, _of_summaries(rows, confidence)) for title, figure, rows in chosen)


def _of_summaries(rows: Sequence[PublishedAngle], confidence: float) -> Comparison:
    names = [f"tw {p.tw_mm:g}, slw {p.slw_mm:g}" for p in rows]
    sizes = [p.samples or 0 for p in rows]
    means = [p.measured_angle_deg or 0.0 for p in rows]
    return compare_summaries(names, sizes, means, [p.measured_sd_deg or 0.0 for p in rows], confidence)
