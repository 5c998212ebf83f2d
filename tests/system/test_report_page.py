"""The report opened in headless Chromium: nothing overlaps, nothing is cut off, everything can be read, and it prints."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from benchlab.io.study_values import StudyValues
from benchlab.report.page import render_page
from benchlab.report.study.document import study_document
from tests.system.chromium import chromium, layouts, run
from tests.unit.report import studies

HOSTILE = ("<script>alert(1)</script>", "$x_{$", "bell\x07\x1b[31m", "=cmd|calc", "n" * 5000, "W" * 80)
STUDIES: dict[str, Callable[[], StudyValues]] = {
    "the paper's": studies.paper_study,
    "with failures": studies.doubtful_study,
    "one design": lambda: studies.values((studies.design("alone", 50, 2),)),
    "one sample": lambda: studies.values((studies.design("alone", 50, 0, samples=1, cycles=1),)),
    "twelve designs": lambda: studies.values(
        tuple(studies.design(f"variant {i} of film 0.{i} mm", 60 + 3 * i, 2, 4, 2) for i in range(12))
    ),
    "hostile names": lambda: studies.values(
        tuple(studies.design(name, 50 + 5 * i, 2) for i, name in enumerate(HOSTILE))
    ),
}


def page_of(values: StudyValues) -> str:
    report = studies.report(values, difference_deg=5.0)
    report.provenance["study"] = "a folder with a long name/study.yaml"
    return render_page(study_document(report))


@pytest.mark.parametrize("kind", STUDIES)
def test_layout(kind: str) -> None:
    chromium()
    for seen in layouts(page_of(STUDIES[kind]()), 1200, 400):
        assert seen.texts > 60 and not seen.faults, f"{seen.width} px"


def test_the_check_sees_faults() -> None:
    chromium()
    faulty = page_of(STUDIES["one sample"]()).replace("<main>", '<main><p style="position:absolute;top:3rem">On top of something</p><p style="width:2000px;max-width:none;white-space:nowrap;font-size:8px">' + "wide " * 400 + "</p>")  # fmt: skip
    (seen,) = layouts(faulty, 800)
    assert seen.overlaps and seen.outside and seen.small and seen.wide > seen.width


def test_it_is_drawn_and_prints(tmp_path: Path) -> None:
    chromium()
    path = tmp_path / "report.html"
    path.write_text(page_of(studies.paper_study()), encoding="utf-8")
    run(path, f"--screenshot={tmp_path / 'page.png'}", "--window-size=1200,3000")
    picture = cv2.imread(str(tmp_path / "page.png"))
    assert picture is not None and picture.shape == (3000, 1200, 3)
    blue = np.all(np.abs(picture.astype(int) - (0xEE, 0xDC, 0xBC)) < 6, axis=2)  # the colour of bars
    assert blue.sum() > 20_000
    run(path, f"--print-to-pdf={tmp_path / 'page.pdf'}", "--no-pdf-header-footer")
    assert 4 <= (tmp_path / "page.pdf").read_bytes().count(b"/Type /Page\n") <= 14


def test_no_script_of_a_name_runs_and_nothing_is_asked_for(tmp_path: Path) -> None:
    chromium()
    path = tmp_path / "report.html"
    path.write_text(page_of(STUDIES["hostile names"]()), encoding="utf-8")
    done: subprocess.CompletedProcess[bytes] = run(path, "--dump-dom", "--enable-logging=stderr", "--v=0")
    assert b"Refused" not in done.stderr and b"violates" not in done.stderr
    assert b"<script" not in done.stdout and b"&lt;script&gt;alert(1)" in done.stdout
