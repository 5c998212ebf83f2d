"""A new study file reads back as what it was made of, whatever its names are."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError
from benchlab.io.study_file import read_study
from benchlab.io.study_text import DesignDraft, StudyDraft, write_study
from benchlab.io.study_values import StudySet

TEXT = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=30)
ODD = [
    "no",
    "null",
    "true",
    "1:30",
    "010",
    "1e3",
    "~",
    "- a",
    "a: b",
    "a #b",
    "'",
    '"',
    "{a",
    "[",
    "*a",
    "&a",
    "!a",
    "%a",
    "@a",
    "`a",
    "a, b",
    "a\nb",
    "\ta",
    " a ",
    "\x7f",
    "\x85",
    "\u2028",
    "\ufeffa",
    "é",
    "😀",
    "<script>",
    "=1+1",
    ".nan",
    ".inf",
    "0:0.35:2.5",
]


def draft(title: str, file: str, notes: str = "") -> StudyDraft:
    designs = [DesignDraft("a b", ShellDesign(10, 3, length_mm=120), {"s1": [file, "b.mp4"]}, "sim.h5", ["f.csv"])]
    return StudyDraft(title, 0.35, {"ramp": "0:0.35:2.5"}, designs, [StudySet("x y", "X, y", ("a b",))], notes)


@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow], deadline=None, max_examples=60
)
@given(title=TEXT | st.sampled_from(ODD), file=TEXT | st.sampled_from(ODD))
def test_any_title_and_file_name_reads_back(tmp_path: Path, title: str, file: str) -> None:
    if file == "b.mp4" or Path(file).suffix in (".csv", ".h5"):
        return
    write_study(tmp_path / "s.yaml", draft(title, file))
    study = read_study(tmp_path / "s.yaml")
    assert study.title == title
    assert study.designs[0].samples[0].recordings[0].file == file


def test_all_parts_read_back(tmp_path: Path) -> None:
    study = write_study(tmp_path / "s.yaml", draft("T", "a.mp4", "first words " * 30))
    assert read_study(tmp_path / "s.yaml").designs == study.designs
    (design,) = study.designs
    assert design.shell == ShellDesign(10, 3, length_mm=120) and design.simulated is not None
    assert [record.file for record in design.force] == ["f.csv"]
    assert study.notes == ("first words " * 30).strip()
    assert study.sets == (StudySet("x y", "X, y", ("a b",)),)
    assert design.samples[0].recordings[0].analysis["ramp"] == "0:0.35:2.5"


def test_what_would_not_read_back_is_not_written(tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text("mine")
    with pytest.raises(InputError, match=r"s\.yaml, line \d+: would not be a study"):
        write_study(tmp_path / "s.yaml", draft("T", "b.mp4"))
    assert (tmp_path / "s.yaml").read_text() == "mine" and len(list(tmp_path.iterdir())) == 1
