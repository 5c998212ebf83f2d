"""Measurements of other labs. What each file holds was taken from it with awk and the csv module, not with the reader."""

import csv
from pathlib import Path

import numpy as np
import pytest

from benchlab.discrepancy.measured import Measured
from benchlab.errors import InputError
from benchlab.io.measured_columns import columns_of
from benchlab.io.measured_table import read_measured
from benchlab.io.simulated_table import read_simulated

FINGERS = "design=Configuration,pressure_kPa=Pressure,angle_deg=Theta6"


@pytest.fixture
def actuators(real_folder: Path) -> Path:
    return real_folder / "actuators"


def find(folder: Path, pattern: str) -> Path:
    (path,) = folder.glob(pattern)
    return path


def rows(path: Path, **how: object) -> list[list[str]]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.reader(file, **how))  # type: ignore[arg-type]


def test_the_measured_fingers(actuators: Path) -> None:
    path = find(actuators, "Hiroshan*Experimental*")
    found = read_measured([path], columns_of(FINGERS))
    assert isinstance(found, Measured) and len(found.runs) == len(found.designs) == 102
    assert sum(len(run.pressure_MPa) for run in found.runs) == 4182
    run = next(run for run in found.runs if run.design == "DS10DS10_0_2")
    own = [row for row in rows(path) if row[0] == "DS10DS10_0_2"]
    assert run.pressure_MPa == pytest.approx([float(row[1]) / 1000 for row in own], abs=1e-15)
    assert run.values["angle_deg"].tolist() == [float(row[7]) for row in own]
    assert np.isnan(run.time_s).all() and run.cycle is None and run.pressure_MPa.max() == 0.34
    told = " | ".join(found.warnings)
    for words in (
        "columns not read: Theta1, Theta2",
        "no column sample",
        "no column of time",
        "one sample only of 102 designs",
    ):
        assert words in told


def test_measured_and_simulated_fingers_have_fourteen_designs_in_common(actuators: Path) -> None:
    measured = read_measured([find(actuators, "Hiroshan*Experimental*")], columns_of(FINGERS))
    told: list[str] = []
    simulated = read_simulated(find(actuators, "Hiroshan*Simulation_Data*"), columns_of(FINGERS), told)
    assert isinstance(measured, Measured) and len(simulated) == 39 and told == []
    assert len(set(measured.designs) & set(simulated)) == 14
    for base in simulated.values():
        assert base.pressure_MPa == pytest.approx(np.arange(101) * 0.004) and base.shape is None
    assert simulated["DS10DS10_0_1"].curves["angle_deg"][0] == -3.33404141


@pytest.mark.parametrize("columns", ["force_N=1,pressure_kPa=2,time_s=3", "force_N,pressure_kPa,time_s,-"])
def test_the_muscle_without_a_header(actuators: Path, columns: str) -> None:
    path = find(actuators, "Agile*")
    found = read_measured([path], columns_of(columns))
    assert isinstance(found, Measured)
    (run,) = found.runs
    numbers = np.array(rows(path), dtype=float)
    assert len(numbers) == 15_000 and len(run.time_s) == 14_999  # two rows are of 0.009 s
    assert run.values["force_N"][8] == pytest.approx((3.56 + 2.1938) / 2)
    assert run.values["force_N"][9:].tolist() == numbers[10:, 0].tolist()
    assert run.pressure_MPa.max() == 0.62662 and run.time_s[-1] == numbers[-1, 2]
    assert any(words.startswith("rows of one time averaged: 1, in run Agile") for words in found.warnings)
    with pytest.raises(InputError, match="no header"):
        read_measured([path])


def test_a_step_of_pressure_alone_is_no_measurement_of_an_actuator(actuators: Path) -> None:
    path = find(actuators, "TheBigBenn*")  # a step of 20000 in column 2, followed in column 3: Pa by the file's name
    with pytest.raises(InputError, match="no column of a measured quantity"):
        read_measured([path], columns_of("command_Pa=2,pressure_Pa=3"))
    found = read_measured([path], columns_of("command_Pa=2,pressure_Pa=3,flex_mV=1"))
    assert isinstance(found, Measured) and found.runs[0].pressure_MPa.max() == pytest.approx(0.02151578)
