"""`benchlab report`: a study in; a page, tables, figures and numbers of it out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

from benchlab.errors import BenchlabError, UsageError
from benchlab.io.published import PublishedAngle, published_angles
from benchlab.io.study_file import Study, read_study
from benchlab.io.study_values import StudySet, StudyValues
from benchlab.io.values_table import write_values_table
from benchlab.report.pdf import check_pdf
from benchlab.report.study.document import study_document
from benchlab.report.study.numbers import report_numbers
from benchlab.report.study.report import ComparedSet, PublishedSet, SAME_PRESSURE_MPa, StudyReport
from benchlab.stats.comparison import Comparison, check_options, compare, compare_summaries
from benchlab.stats.measurements import measurements_of
from benchlab.workflows.provenance import made_by
from benchlab.workflows.report_outputs import NUMBERS, PAGE, PDF, VALUES, ReportOutputs, names_of, write_report
from benchlab.workflows.study_values import Progress, collect

LIBRARIES = ("numpy", "scipy", "matplotlib", "jinja2")
"""Of which a report names the versions."""


def report(
    study: Path,
    out: Path,
    jobs: int = 1,
    pdf: bool = False,
    confidence: float = 0.95,
    difference_deg: float | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Analyse what has changed in a study (a YAML file, or a folder with study.yaml), and write its report into `out`.

    Returns the numbers of report.json, with the paths written as `outputs`. A recording that fails is among `failures`; the report is
    written all the same. Raises UsageError and InputError; then there is no new report, and recordings that were analysed stay current.
    """
    asked = read_study(study)
    check_options(confidence, difference_deg)
    if pdf:
        check_pdf()
    if out.resolve() == asked.path.parent.resolve():
        hint = f"give a folder of its own, as --out {out / 'report'}"
        raise UsageError(
            "is the folder of the study: a report does not mix its files with its data", file=out, hint=hint
        )
    outputs = ReportOutputs(out, "report", overwrite, names=(PAGE, *[PDF] * pdf, NUMBERS))
    read = tuple(_read_by(asked))
    outputs.check(overlay=False, inputs=read)
    with outputs.locked():
        values = collect(asked, out, jobs, progress, overwrite)
        found = report_of(values, published_angles(), confidence, difference_deg)
        found.provenance["study"] = str(asked.path)
        document = study_document(found)
        outputs = replace(outputs, names=names_of(document, pdf, [VALUES]))
        outputs.check(overlay=False, inputs=read)
        numbers = write_report(
            outputs,
            document,
            report_numbers(found),
            lambda folder: write_values_table(folder / VALUES, values),
        )
    return {**numbers, "outputs": [str(path) for path in outputs.paths()]}


def _read_by(study: Study) -> list[Path]:
    """Every file that a study names: none of them may be replaced."""
    found = [study.path]
    for design in study.designs:
        found += [recording.path for sample in design.samples for recording in sample.recordings]
        found += [force.path for force in design.force]
        if design.simulated is not None and design.simulated.path is not None:
            found.append(design.simulated.path)
    return found


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
    for name in LIBRARIES:
        import_module(name)
    return StudyReport(
        values,
        tuple(_compared(values, chosen, confidence, difference_deg) for chosen in values.sets),
        near,
        _published_sets(near, confidence) if common else (),
        made_by(*LIBRARIES),
        confidence,
    )


def _compared(values: StudyValues, chosen: StudySet, confidence: float, difference_deg: float | None) -> ComparedSet:
    rows = [
        (design.name, sample.name, cycle.angle_deg)
        for design in values.of(chosen)
        for sample in design.counted
        for cycle in sample.cycles
    ]
    if not rows:
        return ComparedSet(chosen, None, "no sample has a value.")
    if sum(len(design.counted) > 1 for design in values.of(chosen)) < 2:
        return ComparedSet(chosen, None, "fewer than two designs have two samples or more; measure more samples.")
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
        ("slw set", "Fig. 6c", [p for p in known if p.tw_mm == 3]),
        ("tw set", "Fig. 7c", [p for p in known if p.slw_mm == 10]),
        ("all designs", "", known),
    )
    return tuple(
        PublishedSet(title, figure, tuple(rows), _of_summaries(rows, confidence)) for title, figure, rows in chosen
    )


def _of_summaries(rows: Sequence[PublishedAngle], confidence: float) -> Comparison:
    names = [p.design.name for p in rows]
    sizes = [p.samples or 0 for p in rows]
    means = [p.measured_angle_deg or 0.0 for p in rows]
    return compare_summaries(names, sizes, means, [p.measured_sd_deg or 0.0 for p in rows], confidence)
