"""A repeatability report as a document: what a reader looks for first stands first."""

from __future__ import annotations

from benchlab.errors import counted
from benchlab.report.document import Block, Document, Section, Words, cut, listed, marked
from benchlab.report.provenance import PROVENANCE, provenance_section
from benchlab.report.study.differences import (
    all_warnings,
    assumptions_table,
    pairs_table,
    power_blocks,
    tests_table,
)
from benchlab.report.study.force import FORCE, force_section
from benchlab.report.study.origins import origins_mark, origins_words
from benchlab.report.study.pictures import bands_blocks, bars_blocks, consistency_blocks, intervals_blocks
from benchlab.report.study.published import published_section
from benchlab.report.study.repeatability import components_blocks, consistency_table, consistency_words
from benchlab.report.study.report import StudyReport, found_sets
from benchlab.report.study.tables import designs_table, samples_table
from benchlab.report.study.verdict import verdict_section

NUMBERS = "report.json"


def study_document(report: StudyReport) -> Document:
    """The whole report. The study's notes stand at its top, so that what is drawn or simulated is known before it is read."""
    tests: tuple[Block, ...] = (tests_table(report),) if found_sets(report) else ()
    pairs: tuple[Block, ...] = (pairs_table(report),) if found_sets(report) else ()
    mark, words = origins_mark(report.values), origins_words(report.values)
    sections = [
        verdict_section(report),
        Section("The designs", (designs_table(report), *bars_blocks(report))),
        Section("Angle against pressure", tuple(bands_blocks(report))),
        *filter(None, (force_section(report),)),
        Section("Do they differ?", (*tests, *intervals_blocks(report), *pairs)),
        *_repeatability(report),
        *filter(None, (published_section(report),)),
        *_doubts(report),
        Section("Every sample", (samples_table(report),)),
        _provenance(report),
    ]
    return Document(
        title=cut(f"{mark.capitalize()}: {report.values.title}" if mark else report.values.title, 140),
        statement=" ".join(filter(None, (words, cut(report.values.notes.strip(), 600)))),
        facts=_facts(report),
        sections=tuple(
            marked(section, mark if section.title not in (FORCE, PROVENANCE) else "")
            for section in sections
            if section.blocks
        ),
        foot=f"Written by benchlab {report.provenance['versions']['benchlab']}. This page asks nothing of the network.",
        data=(consistency_table(report),) if report.whole.found else (),
    )


def _facts(report: StudyReport) -> tuple[str, ...]:
    values = report.values
    samples = sum(len(design.counted) for design in values.designs)
    recordings = sum(len(sample.recordings) for design in values.designs for sample in design.samples)
    return (
        f"{counted(len(values.designs), 'design')}, {counted(samples, 'sample')}, {counted(recordings, 'recording')}",
        f"bending angle at {values.pressure_MPa:g} MPa",
        report.provenance["created"][:10],
    )


def _repeatability(report: StudyReport) -> list[Section]:
    found = report.whole.found
    doubtful = (consistency_words(found),) if found is not None else ()
    if not found_sets(report):
        return []
    return [
        Section("How well do they repeat?", (*components_blocks(report), *consistency_blocks(report), *doubtful)),
        Section("How far to trust this", (assumptions_table(report), *power_blocks(report))),
    ]


def _doubts(report: StudyReport) -> list[Section]:
    """What was left out and why, what failed, and every warning."""
    values = report.values
    blocks: list[Block] = []
    for what, found in (("Failed or missing", values.failures), ("Left out", values.left_out)):
        if found:
            blocks += [Words(f"{what}: {len(found)}."), listed([(one.what, one.why) for one in found], NUMBERS)]
    if not blocks:
        blocks.append(Words("Nothing: every recording of the study has a value and counts."))
    warnings = all_warnings(report)
    sections = [Section("Left out and failed", tuple(blocks))]
    if warnings:
        sections.append(Section("Warnings", (listed(warnings, NUMBERS),)))
    return sections


def _provenance(report: StudyReport) -> Section:
    made = report.provenance
    study = [("Study file", made["study"])] if "study" in made else []
    return provenance_section(study, made, report.values.inputs, NUMBERS)
