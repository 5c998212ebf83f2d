"""Designs by name and by file."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError, UsageError
from benchlab.io.design_file import read_design, write_design


@given(st.integers(1, 1500), st.integers(1, 3999))
def test_a_name_is_read_as_it_is_written(tw: int, slw: int) -> None:
    design = ShellDesign(window_width_mm=tw / 100, strip_width_mm=slw / 100)
    assert read_design(design.name) == design


def test_a_file_is_read_as_it_is_written(tmp_path: Path) -> None:
    design = ShellDesign(7.1, 3.3, 1.9, 41.0, 120)
    write_design(tmp_path / "a.yaml", design)
    assert read_design(tmp_path / "a.yaml") == read_design(str(tmp_path / "a.yaml")) == design


def test_the_first_two_keys_suffice(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text("strip_width_mm: 10\nwindow_width_mm: 3\n")
    assert read_design(path) == read_design("tw3_slw10") == ShellDesign(10, 3)


def test_a_name_goes_before_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_design(Path("tw3_slw10"), ShellDesign(20, 3))
    assert read_design("tw3_slw10").strip_width_mm == 10
    assert read_design("./tw3_slw10").strip_width_mm == 20


@pytest.mark.parametrize(
    "name", ["tw3", "tw3_slw", "slw10_tw3", "tw-3_slw10", "tw3_slw10x", "tw3_slw1_0", "", "tw٣_slw1"]
)
def test_what_is_neither_name_nor_file(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError, match="a folder" if name == "" else "tw3_slw10"):
        read_design(name)


def test_an_impossible_name() -> None:
    with pytest.raises(UsageError, match="slw"):
        read_design("tw3_slw40")
    with pytest.raises(UsageError, match="tw"):
        read_design("tw0_slw10")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("window_width_mm: 3\n", ["strip_width_mm is missing"]),
        ("strip_width_mm: 10\nwindow_width_mm: 3\nrib_mm: 2\n", ["line 3", "unknown key rib_mm"]),
        ("strip_width_mm: 40\nwindow_width_mm: 3\n", ["strip_width_mm (slw) is 40", "40"]),
        ("strip_width_mm: .nan\nwindow_width_mm: 3\n", ["line 1", "nan", "finite"]),
    ],
)
def test_a_refused_file(text: str, words: list[str], tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_design(path)
    for word in ["a.yaml", *words]:
        assert word in str(caught.value)
