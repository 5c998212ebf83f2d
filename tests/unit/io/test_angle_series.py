"""Angles over time from a table or a run file of `benchlab analyze`."""

from pathlib import Path

import numpy as np
import pytest

from benchlab.errors import BenchlabError, InputError
from benchlab.io.angle_series import read_angle_series


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def test_a_table_with_other_columns_and_holes(tmp_path: Path) -> None:
    table = write(tmp_path / "a.csv", "frame,time_s,angle_deg\n0,0.0,1.5\n1,0.1,\n2,,7\n3,0.2,2.5\n")
    found = read_angle_series(table)
    assert found.time_s.tolist() == [0.0, 0.1, 0.2]
    assert found.angle_deg[[0, 2]].tolist() == [1.5, 2.5] and np.isnan(found.angle_deg[1])


def test_a_truth_with_its_first_line(tmp_path: Path) -> None:
    found = read_angle_series(write(tmp_path / "a.csv", "# simulated\ntime_s,angle_deg\n0,1\n1,2\n"))
    assert found.angle_deg.tolist() == [1, 2]


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("time_s,angle\n0,1\n1,2\n", "line 1: without one column angle_deg"),
        ("time_s,angle_deg,angle_deg\n0,1,1\n1,2,2\n", "without one column angle_deg"),
        ("time_s,angle_deg\n0,1\n1,x\n", "line 3: not a number: 'x'"),
        ("time_s,angle_deg\n0,1\n", "fewer than two rows"),
        ("time_s,angle_deg\n1,1\n0,2\n", "time goes back, from 1 s to 0 s"),
    ],
)
def test_what_is_no_series_is_refused_with_its_place(tmp_path: Path, text: str, named: str) -> None:
    with pytest.raises(InputError) as refused:
        read_angle_series(write(tmp_path / "a.csv", text))
    assert named in str(refused.value)


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(BenchlabError, match="no such file"):
        read_angle_series(tmp_path / "none.csv")
