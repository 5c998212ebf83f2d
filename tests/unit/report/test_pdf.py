"""The PDF: the same sections, no text taken for markup."""

import shutil
import subprocess
from pathlib import Path

import pytest

from benchlab.errors import UsageError
from benchlab.report import pdf
from benchlab.report.pdf import check_pdf, render_pdf
from benchlab.report.study.document import study_document
from tests.unit.report import studies
from tests.unit.report.test_page import everywhere

MARKUP = '#panic("x") $x_{$ *bold* _a_ <label> @ref [b] `c` // no \\ = head " quoted'


def text_of(data: bytes, tmp_path: Path) -> str:
    if shutil.which("pdftotext") is None:
        pytest.skip("pdftotext (poppler-utils) is not installed: the PDF's text was not read")
    (tmp_path / "a.pdf").write_bytes(data)
    done = subprocess.run(["pdftotext", "-layout", tmp_path / "a.pdf", "-"], capture_output=True, check=True)
    return " ".join(done.stdout.decode().split())


def test_markup_in_a_name_is_text(tmp_path: Path) -> None:
    data = render_pdf(everywhere(MARKUP))
    assert data.startswith(b"%PDF")
    text = text_of(data, tmp_path)
    assert text.count('#panic("x") $x_{$ *bold*') >= 5 and "[b] `c` // no" in text


def test_a_report_has_its_numbers(tmp_path: Path) -> None:
    text = text_of(render_pdf(study_document(studies.report(studies.paper_study()))), tmp_path)
    for part in ("9 of 10", "529.46", "110.2 ± 1.9", "Left out and failed", "Provenance"):
        assert part in text


ODD = {
    "doubtful": studies.doubtful_study,
    "one design": lambda: studies.values((studies.design("a", 50, 1),)),
    "one sample": lambda: studies.values((studies.design("W" * 80, 50, 1, 1, 1),)),
}


@pytest.mark.parametrize("kind", ODD)
def test_studies_of_all_kinds_are_set(kind: str) -> None:
    assert len(render_pdf(study_document(studies.report(ODD[kind]())))) > 10_000


def test_without_the_extra_it_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pdf, "find_spec", lambda _: None)
    with pytest.raises(UsageError, match=r"benchlab\[pdf\]"):
        check_pdf()
