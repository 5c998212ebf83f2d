"""Where files may be written: the last missing folder is made, no more than that."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from benchlab.errors import UsageError
from benchlab.io.files import check_new_file, make_folder, written_whole


def test_the_last_folder_is_made_when_the_file_is_written_and_not_before(tmp_path: Path) -> None:
    path = tmp_path / "results" / "a.txt"
    check_new_file(path)
    assert not path.parent.exists()
    with written_whole(path) as temporary:
        temporary.write_text("whole")
    assert path.read_text() == "whole" and [each.name for each in path.parent.iterdir()] == ["a.txt"]


def test_a_bare_name_lies_in_the_present_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    check_new_file(Path("a.txt"))
    with written_whole(Path("results", "a.txt")) as temporary:
        temporary.write_text("whole")
    assert (tmp_path / "results" / "a.txt").exists()


@pytest.mark.parametrize("check", [make_folder, lambda folder: check_new_file(folder / "a.txt")])
def test_what_cannot_be_a_folder_is_refused_and_nothing_made(tmp_path: Path, check: Callable[[Path], None]) -> None:
    (tmp_path / "file").write_text("mine")
    with pytest.raises(UsageError, match="none: no such folder"):
        check(tmp_path / "none" / "below")
    with pytest.raises(UsageError, match="file: cannot be used as output folder: it is a file"):
        check(tmp_path / "file")
    with pytest.raises(UsageError, match="file: no such folder"):
        check(tmp_path / "file" / "below")
    assert [each.name for each in tmp_path.iterdir()] == ["file"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_is_read_only_is_told_before_the_work(tmp_path: Path) -> None:
    (tmp_path / "shut").mkdir(mode=0o500)
    with pytest.raises(UsageError, match="the output folder is read-only"):
        check_new_file(tmp_path / "shut" / "a.txt")
    with pytest.raises(UsageError, match="the output folder is read-only"):
        make_folder(tmp_path / "shut" / "results")
