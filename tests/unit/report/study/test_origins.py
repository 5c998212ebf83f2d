"""A report of what nobody measured says so first, and everywhere."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchlab.io.study_values import StudyValues
from benchlab.report.document import Pictures
from benchlab.report.study.document import study_document
from benchlab.report.study.numbers import report_numbers
from benchlab.report.study.origins import origins_mark, origins_of, origins_words
from benchlab.report.study.verdict import verdict_words
from tests.unit.report.studies import paper_study
from tests.unit.report.studies import report as report_on


def made(values: StudyValues, *origins: str) -> StudyValues:
    """The study with the samples of each design from these origins in turn."""
    designs = []
    for design in values.designs:
        samples = [
            replace(sample, recordings=tuple(replace(r, origin=origins[i % len(origins)]) for r in sample.recordings))
            for i, sample in enumerate(design.samples)
        ]
        designs.append(replace(design, samples=tuple(samples)))
    return replace(values, designs=tuple(designs))


@pytest.fixture(scope="module")
def measured() -> StudyValues:
    return paper_study()


def test_a_simulated_study_says_so_in_title_verdict_captions_and_figures(measured):
    report = report_on(made(measured, "twin"))
    document = study_document(report)
    assert document.title == f"Simulated: {measured.title}"
    assert document.statement.startswith("Simulated on the digital twin, nothing was measured.")
    first, *others = verdict_words(report)
    assert (first.text, first.kind) == ("Simulated on the digital twin, nothing was measured.", "warning")
    assert all("simulated." in words.head for words in others if "differ" in words.text and "ANOVA" in words.text)
    pictures = [block for section in document.sections for block in section.blocks if isinstance(block, Pictures)]
    assert len(pictures) >= 4
    for block in pictures:
        assert block.caption.startswith("Simulated. ")
        assert all(panel.words.endswith("(simulated)") for panel in block.panels)
    numbers = report_numbers(report)
    assert list(numbers["origins"]) == ["twin"] and "nothing was measured" in numbers["verdict"][0]


def test_a_mixture_is_a_warning_at_the_verdict(measured):
    values = made(measured, "", "twin", "twin", "emulated")
    assert set(origins_of(values)) == {"", "emulated", "twin"} and origins_mark(values) == "mixed origins"
    first = verdict_words(report_on(values))[0]
    assert first.kind == "warning" and first.text.startswith("MIXED ORIGINS: ")
    assert "samples measured" in first.text and "simulated on the digital twin" in first.text
    assert origins_words(made(measured, "twin", "emulated")).startswith("MIXED ORIGINS, and nothing was measured: ")


def test_a_measured_study_says_nothing(measured):
    assert origins_mark(measured) == origins_words(measured) == ""
    document = study_document(report_on(measured))
    assert document.title == measured.title and "imulated on the" not in document.statement
