"""Tables of means, the published one first."""

from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from benchlab.discrepancy.measured import Measured, Summary
from benchlab.errors import InputError
from benchlab.io.measured_table import read_measured
from benchlab.io.published import published_angles

HEAD = "design,pressure_MPa,mean,sd,n\n"


def read(folder: Path, text: str, **options: object) -> Summary:
    path = folder / "means.csv"
    path.write_text(text)
    found = read_measured([path], **options)  # type: ignore[arg-type]
    assert isinstance(found, Summary)
    return found


def test_the_published_table() -> None:
    found = read_measured([Path(str(files("benchlab"))) / "published" / "paper_angles.csv"])
    assert isinstance(found, Summary) and found.quantity == "angle_deg"
    rows = {p.design.name: p for p in published_angles() if p.measured_angle_deg is not None}
    assert len(found.design) == len(rows) == 5
    for at, name in enumerate(found.design):
        row = rows[name]
        told = (found.pressure_MPa[at], found.mean[at], found.sd[at], found.n[at])
        assert told == (row.pressure_MPa, row.measured_angle_deg, row.measured_sd_deg, row.samples)
    assert [words.split(";")[0] for words in found.warnings] == [
        "columns not read: fem_angle_deg",
        "3 rows without angle_deg or pressure_MPa left out",
    ]


def test_rows_in_any_order_and_unit(tmp_path: Path) -> None:
    text = "n,angle_sd_rad,design,pressure_kPa,Angle mean (rad)\n5,0.1,b,350,1\n4,0.2,a,350,2\n3,0.3,a,100,0.5\n"
    found = read(tmp_path, text)
    assert found.design == ("a", "a", "b") and found.n.tolist() == [3, 4, 5] and found.quantity == "angle_deg"
    assert found.pressure_MPa == pytest.approx([0.1, 0.35, 0.35]) and found.warnings == ()
    assert found.mean == pytest.approx(np.degrees([0.5, 2, 1])) and found.sd == pytest.approx(
        np.degrees([0.3, 0.2, 0.1])
    )


def test_a_plain_mean_is_an_angle_which_is_told(tmp_path: Path) -> None:
    found = read(tmp_path, HEAD + "a,0.3,50,1,5\n")
    assert found.quantity == "angle_deg" and found.sd.tolist() == [1.0] and "read as angle_deg" in found.warnings[0]


@pytest.mark.parametrize("columns", ["force_mean_N,force_sd_N", "mean_N,sd_N", "force_N,sd_N", "mean_force_N,std_N"])
def test_another_quantity_by_its_name(tmp_path: Path, columns: str) -> None:
    found = read(tmp_path, f"design,pressure_MPa,{columns},samples\na,0.3,37.72,1.56,3\n")
    assert (found.quantity, found.mean[0], found.sd[0], found.n[0]) == ("force_N", 37.72, 1.56, 3)


def test_one_quantity_at_a_time(tmp_path: Path) -> None:
    text = "design,pressure_MPa,force_mean_N,angle_mean_deg,angle_sd_deg,n\na,0.3,2,50,1,5\n"
    found = read(tmp_path, text)
    assert found.mean.tolist() == [50] and "force_N is not read" in found.warnings[0]


def test_one_sample_says_nothing_of_scatter(tmp_path: Path) -> None:
    found = read(tmp_path, HEAD + "a,0.3,50,,1\nb,0.3,50,,5\n")
    assert np.isnan(found.sd).all()
    assert "1 mean of one sample: how samples scatter is not known there" in found.warnings
    assert "1 mean without a standard deviation" in found.warnings


@pytest.mark.parametrize(
    "row, words",
    [
        ("a,0.3,50,1,0", "n is 0, not a count"),
        ("a,0.3,50,1,2.5", "n is 2.5, not a count"),
        ("a,0.3,50,1,", "n is nan, not a count"),
        ("a,0.3,50,-1,5", "standard deviation of -1, below 0"),
        ("a,300,50,1,5", "pressure of 300 MPa"),
        ("b,0.3,51,1,5", "b at 0.3 stands twice, first in line 2"),
    ],
)
def test_what_is_refused(tmp_path: Path, row: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, f"{HEAD}b,0.3,50,1,5\n{row}\n")
    assert words in caught.value.what and caught.value.where == "line 3" and caught.value.hint


def test_a_mean_needs_its_number_of_samples(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no column n"):
        read(tmp_path, "design,pressure_MPa,angle_mean_deg\na,0.3,50\n")
    with pytest.raises(InputError, match="no column of means"):
        read(tmp_path, "design,pressure_MPa,n\na,0.3,5\n")


def test_no_means_are_no_summary(tmp_path: Path) -> None:
    path = tmp_path / "runs.csv"
    path.write_text("design,pressure_MPa,angle_deg,sd\na,0.3,50,1\n")
    assert isinstance(read_measured([path]), Measured)
