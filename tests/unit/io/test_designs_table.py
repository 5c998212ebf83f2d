"""Dimensions of designs from tables, studies, design files and names."""

from pathlib import Path

import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import BenchlabError, UsageError
from benchlab.io.design_file import write_design
from benchlab.io.designs_table import designs_of_names, read_designs


def write(folder: Path, text: str, name: str = "designs.csv") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_a_whole_table(tmp_path: Path) -> None:
    told: list[str] = []
    text = "length_mm,design,tw_mm,slw_cm,fw_mm,perimeter_mm\n150,short,3,1,2.5,42\n180,long,9,0.5,2,40\n"
    found = read_designs(write(tmp_path, text), told=told)
    assert found == {
        "short": ShellDesign(10, 3, rib_width_mm=2.5, perimeter_mm=42, length_mm=150),
        "long": ShellDesign(5, 9, rib_width_mm=2, perimeter_mm=40, length_mm=180),
    }
    assert told == []


def test_what_a_table_does_not_say_is_from_the_paper_and_told(tmp_path: Path) -> None:
    told: list[str] = []
    found = read_designs(write(tmp_path, "tw_mm,slw_mm,fw_mm\n3,10,2\n15,10,2\n"), told=told)
    assert found == {"tw3_slw10": ShellDesign(10, 3), "tw15_slw10": ShellDesign(10, 15)}
    assert told == ["perimeter_mm 40, length_mm 180: not in the table, taken from the paper"]


def test_a_table_of_measurements_serves_as_well(tmp_path: Path) -> None:
    rows = "".join(f"a,s{n},3,10,0.3,{n}\n" for n in range(5))
    found = read_designs(write(tmp_path, "design,sample,tw_mm,slw_mm,pressure_MPa,angle_deg\n" + rows))
    assert found == {"a": ShellDesign(10, 3)}


@pytest.mark.parametrize(
    "rows, words, where",
    [
        ("a,3,10\na,3,5\n", "design a has other dimensions in line 2", "line 3"),
        ("a,3,10\nb,3,40\n", "leaves no window", "line 3"),
        ("a,3,10\nb,3,-5\n", "strip_width_mm (slw) is -5", "line 3"),
        ("a,3,10\nb,,5\n", "no tw_mm", "line 3"),
        ("a,3,10\n,9,5\n", "no name of the design", "line 3"),
    ],
)
def test_what_is_refused(tmp_path: Path, rows: str, words: str, where: str) -> None:
    with pytest.raises(BenchlabError) as caught:
        read_designs(write(tmp_path, "design,tw_mm,slw_mm\n" + rows))
    assert words in caught.value.what and caught.value.where == where and caught.value.hint


def test_columns_that_are_wanted(tmp_path: Path) -> None:
    with pytest.raises(BenchlabError, match="no column slw_mm"):
        read_designs(write(tmp_path, "design,tw_mm\na,3\n"))
    with pytest.raises(BenchlabError, match="no unit in the name of column 'tw'"):
        read_designs(write(tmp_path, "design,tw,slw_mm\na,3,10\n"))
    found = read_designs(write(tmp_path, "Type,Window,slw_mm\na,3,10\n"), {"design": "Type", "tw_mm": "Window"})
    assert found == {"a": ShellDesign(10, 3)}


def test_a_name_that_says_other_dimensions_is_told(tmp_path: Path) -> None:
    told: list[str] = []
    read_designs(write(tmp_path, "design,tw_mm,slw_mm\ntw3_slw10,4,10\ntw3_slw99,3,10\n"), told=told)
    assert told[-1] == "design tw3_slw10 is tw4_slw10 by its dimensions, which count"


def test_a_study_and_a_design_file(tmp_path: Path) -> None:
    told: list[str] = []
    study = "title: t\npressure_MPa: 0.35\ndesigns:\n  a:\n    shell: {tw_mm: 3, slw_mm: 10, length_mm: 150}\n  b: {}\n"
    path = write(tmp_path, study, "study.yaml")
    for place in (path, tmp_path):
        assert read_designs(place, told=told) == {"a": ShellDesign(10, 3, length_mm=150)}
    assert told[0] == "designs without a shell in the study: b"
    write_design(tmp_path / "one.yaml", ShellDesign(10, 3))
    assert read_designs(tmp_path / "one.yaml") == {"tw3_slw10": ShellDesign(10, 3)}


def test_names_that_say_what_they_are() -> None:
    assert designs_of_names(["tw3_slw10", "glove", "tw2.5_slw5"]) == {
        "tw3_slw10": ShellDesign(10, 3),
        "tw2.5_slw5": ShellDesign(5, 2.5),
    }
    with pytest.raises(UsageError, match="leaves no window"):
        designs_of_names(["tw3_slw50"])
