"""Tables of angles: which column is what, whose rows are read, and what is refused with its line."""

from pathlib import Path

import numpy as np
import pytest

from benchlab.errors import InputError, UsageError
from benchlab.io.angle_table import is_series, names_samples, read_angle_table


def table(folder: Path, text: str | bytes) -> Path:
    path = folder / "t.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_reads_the_rows_of_one_sample_in_any_order_of_columns(tmp_path: Path) -> None:
    head = "sample;angle_deg;design;Pressure (kPa);cycle;angle_sd_deg;who\n"
    text = head + "s1;1,5;d;350;1;0,1;me\ns2;9;d;350;1;;\ns1;9;e;350;1;;\ns1;2,5;d;;2;0,2;\n"
    found = read_angle_table(table(tmp_path, text), "d", "s1")
    assert found.line.tolist() == [2, 5]
    assert found.angle_deg.tolist() == [1.5, 2.5] and found.angle_sd_deg.tolist() == [0.1, 0.2]
    assert found.cycle is not None and found.cycle.tolist() == [1, 2]
    assert found.pressure_MPa is not None
    np.testing.assert_allclose(found.pressure_MPa, [0.35, np.nan])
    assert found.warnings == ("columns not read: who",)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
def test_reads_other_encodings_and_line_ends(tmp_path: Path, encoding: str) -> None:
    path = table(tmp_path, "angle_deg\tsample\r\n50.5\tséance\r\n".encode(encoding))
    found = read_angle_table(path, "d", "séance")
    assert found.angle_deg.tolist() == [50.5] and found.cycle is None and found.pressure_MPa is None
    assert np.isnan(found.angle_sd_deg).all()


def test_a_name_that_a_spreadsheet_would_run_is_read_back(tmp_path: Path) -> None:
    assert read_angle_table(table(tmp_path, "sample,angle_deg\n'=s1,5\n"), "d", "=s1").angle_deg.tolist() == [5]


def test_an_empty_angle_is_missing_and_not_zero(tmp_path: Path) -> None:
    found = read_angle_table(table(tmp_path, "cycle,angle_deg\n1,\n2,7\n"), "d", "s")
    assert np.isnan(found.angle_deg[0]) and found.angle_deg[1] == 7


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("cycle,angle\n1,50\n", ["line 1", "no column angle_deg among 'cycle', 'angle'"]),
        ("angle_deg,angle_deg\n1,2\n", ["line 1", "'angle_deg' stands twice"]),
        ("angle_deg,p (kPa),q (bar)\n1,2,3\n", ["line 1", "2 pressure columns: 'p (kPa)' and 'q (bar)'"]),
        ("angle_deg,who\n50,a\nfifty,a\n", ["line 3", "not a number: 'fifty'"]),
        ("angle_deg,cycle\n50,0\n", ["line 2", "cycle is not a whole number from 1"]),
        ("angle_deg,cycle\n50,1.5\n", ["line 2", "whole number"]),
        ("angle_deg,cycle\n50,1\n51,1\n", ["line 3", "cycle 1", "in lines 2 and 3"]),
        ("angle_deg,sample\n50,s2\n", ["no row of d s1", "column sample"]),
        ("angle_deg,design,sample\n50,D,s1\n", ["no row of d s1", "design and sample"]),
        ("angle_deg\n50\n", ["line 1", "only one column"]),
        ("angle_deg,who\n", ["no data rows"]),
        ("angle_deg,cycle\n50,1,2\n", ["line 2"]),
        ("<html><body>login</body></html>", ["t.csv"]),
        (b"PK\x03\x04abc", ["Excel"]),
        ("angle_deg,who\n5\x000,a\n", ["binary"]),
    ],
)
def test_refuses_with_the_line(tmp_path: Path, text: str | bytes, words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        read_angle_table(table(tmp_path, text), "d", "s1")
    for word in words:
        assert word in str(caught.value)


def test_which_tables_are_of_analyze_and_which_name_their_samples(tmp_path: Path) -> None:
    path = table(tmp_path, "frame,time_s,angle_deg,flag\n0,0,1,\n")
    assert is_series(path) and not names_samples(path)
    path = table(tmp_path, "sample,angle_deg\ns1,1\n")
    assert not is_series(path) and names_samples(path)
    with pytest.raises(UsageError, match="no such file"):
        is_series(tmp_path / "none.csv")
