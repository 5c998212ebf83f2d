"""Simulated curves of other engines, of benchlab's own tables, and the published column."""

from importlib.resources import files
from pathlib import Path

import numpy as np
import pandas
import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import BenchlabError
from benchlab.io.published import published_angles
from benchlab.io.simulated_table import read_simulated


def write(folder: Path, text: str) -> Path:
    path = folder / "simulated.csv"
    path.write_text(text)
    return path


def test_curves_by_design_whatever_the_order(tmp_path: Path) -> None:
    table = pandas.DataFrame({"design": np.repeat(["tw3_slw10", "glove"], 5), "pressure_kPa": [0, 1, 5, 50, 350] * 2})
    table = table.assign(angle_rad=np.arange(10) / 10, volume_mL=np.arange(10.0), blocked_force_lbf=1.0)
    told: list[str] = []
    found = read_simulated(write(tmp_path, table.sample(frac=1, random_state=3).to_csv(index=False)), told=told)
    assert list(found) == ["glove", "tw3_slw10"] and told == []
    for name, start in (("tw3_slw10", 0), ("glove", 5)):
        base, numbers = found[name], np.arange(start, start + 5)
        assert base.name == name and base.pressure_MPa == pytest.approx([0, 0.001, 0.005, 0.05, 0.35])
        assert base.curves["angle_deg"] == pytest.approx(np.degrees(numbers / 10))
        assert base.curves["volume_mL"].tolist() == numbers.tolist() and not base.knobs
        assert base.curves["force_N"] == pytest.approx(4.4482216152605)
    assert found["tw3_slw10"].shape == ShellDesign(10, 3) and found["glove"].shape is None


def test_the_published_column() -> None:
    told: list[str] = []
    found = read_simulated(Path(str(files("benchlab"))) / "published" / "paper_angles.csv", told=told)
    rows = {p.design.name: p for p in published_angles()}
    assert set(found) == set(rows)
    for name, base in found.items():
        assert base.curves["angle_deg"].tolist() == [rows[name].fem_angle_deg] and base.pressure_MPa.tolist() == [0.35]
        assert base.shape == rows[name].design and list(base.curves) == ["angle_deg"]
    assert told[-1].startswith("one pressure only of tw15_slw10, ")


def test_the_straight_actuator_is_added_and_told(tmp_path: Path) -> None:
    told: list[str] = []
    text = "design,pressure_MPa,angle_deg,volume_mL,force_N\na,0.1,10,2,1\na,0.2,25,3,2\n"
    base = read_simulated(write(tmp_path, text), told=told)["a"]
    assert base.pressure_MPa.tolist() == [0, 0.1, 0.2] and base.curves["angle_deg"].tolist() == [0, 10, 25]
    assert base.curves["force_N"].tolist() == [0, 1, 2] and "volume_mL" not in base.curves
    assert told == [
        "a begins at 0.1 MPa: straight at 0 MPa, with no force, is assumed",
        "volume_mL of a is missing at some pressures: not read",
    ]


def test_states_that_were_not_found_are_left_out(tmp_path: Path) -> None:
    told: list[str] = []
    text = "design,pressure_MPa,angle_deg,volume_mL\na,0,0,\na,0.1,10,\na,0.2,,\n"
    base = read_simulated(write(tmp_path, text), told=told)["a"]
    assert base.pressure_MPa.tolist() == [0, 0.1] and list(base.curves) == ["angle_deg"]
    assert told == ["1 row without pressure or angle left out, the first in line 4"]


def test_forces_alone(tmp_path: Path) -> None:
    told: list[str] = []
    base = read_simulated(
        write(tmp_path, "design,pressure_kPa,blocked_force_N\na,100,2\na,200,5\na,300,\n"), told=told
    )["a"]
    assert base.pressure_MPa.tolist() == [0, 0.1, 0.2] and base.curves.keys() == {"force_N"}
    assert base.curves["force_N"].tolist() == [0, 2, 5]
    assert told[0] == "1 row without pressure or force left out, the first in line 4"


def test_columns_of_other_names(tmp_path: Path) -> None:
    path = write(tmp_path, "Configuration,Pressure,Theta6\na,0,1\na,100,2\n")
    base = read_simulated(path, {"design": "Configuration", "pressure_kPa": "Pressure", "angle_deg": "Theta6"})["a"]
    assert base.pressure_MPa.tolist() == [0, 0.1] and base.curves["angle_deg"].tolist() == [1, 2]


@pytest.mark.parametrize(
    "rows, words, where",
    [
        ("a,0,0\na,0.1,9\na,0.1,9\n", "a at 0.1 MPa stands twice, first in line 3", "line 4"),
        ("a,0,0\na,-0.05,9\n", "pressure of -0.05 MPa", "line 3"),
        ("a,0,0\na,350,9\n", "pressure of 350 MPa, outside", "line 3"),
        ("a,0,0\n,0.1,9\n", "no design", "line 3"),
        ("a,,\na,,9\n", "no row with a pressure and an angle", None),
    ],
)
def test_what_is_refused(tmp_path: Path, rows: str, words: str, where: str | None) -> None:
    with pytest.raises(BenchlabError) as caught:
        read_simulated(write(tmp_path, "design,pressure_MPa,angle_deg\n" + rows))
    assert words in caught.value.what and caught.value.where == where and caught.value.hint


@pytest.mark.parametrize(
    "header, words",
    [
        ("design,pressure_MPa,angle", "no unit in the name of column 'angle'"),
        ("design,pressure_MPa,volume_mL", "no column of the angle, nor of the blocked force"),
        ("design,volume_mL,angle_deg", "no column of pressure"),
    ],
)
def test_columns_that_are_wanted(tmp_path: Path, header: str, words: str) -> None:
    with pytest.raises(BenchlabError, match=words):
        read_simulated(write(tmp_path, f"{header}\na,0,0\na,0.1,1\n"))
    with pytest.raises(BenchlabError, match="no data rows"):
        read_simulated(write(tmp_path, "design,pressure_MPa,angle_deg\n"))
