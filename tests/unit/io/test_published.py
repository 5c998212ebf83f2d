"""The table of published angles, against what the paper itself computes from it."""

import math

import pytest

from benchlab.errors import InputError
from benchlab.io.published import COLUMNS, published_angles


def test_errors_of_the_papers_finite_elements_are_those_of_its_table():
    measured = [p for p in published_angles() if p.measured_angle_deg is not None]
    errors = [p.fem_angle_deg - p.measured_angle_deg for p in measured]
    assert [round(e, 1) for e in errors] == [9.3, 4.5, 2.1, 4.7, -1.0]
    assert sum(map(abs, errors)) / 5 == pytest.approx(4.32)
    assert math.sqrt(sum(e * e for e in errors) / 5) == pytest.approx(5.18, abs=0.005)
    assert sum(p.measured_sd_deg for p in measured) / 5 == pytest.approx(2.8, abs=0.05)


def test_eight_designs_of_which_five_were_measured_on_five_samples():
    points = published_angles()
    assert len(points) == 8 and len({p.design for p in points}) == 8
    assert {p.samples for p in points} == {5, None}
    for point in points:
        absent = {point.measured_angle_deg is None, point.measured_sd_deg is None, point.samples is None}
        assert len(absent) == 1 and point.pressure_MPa == 0.35 and point.fem_angle_deg is not None


@pytest.mark.parametrize(
    ("row", "what"),
    [
        ("3,x,0.35,1,,,", "line 2: not a number: 'x'"),
        ("3,,0.35,1,,,", "line 2: one of tw_mm, slw_mm, pressure_MPa is empty"),
        ("3,1,0.35,1,2,3,2.5", "line 2: samples is 2.5, not a count"),
        ("3,1,0.35,1,2,3", "is cut and was left out"),
    ],
)
def test_a_row_that_is_not_one_is_refused(tmp_path, row, what):
    path = tmp_path / "angles.csv"
    path.write_text(f"{','.join(COLUMNS)}\n{row}\n")
    with pytest.raises(InputError, match=what):
        published_angles(path)


def test_other_columns_are_refused(tmp_path):
    path = tmp_path / "angles.csv"
    path.write_text("tw_mm,slw_mm\n3,1\n")
    with pytest.raises(InputError, match="columns are tw_mm"):
        published_angles(path)
