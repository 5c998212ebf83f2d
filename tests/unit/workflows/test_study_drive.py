"""A drive file as a recording of a sample: its angle by the flex sensor, in each cycle, and what is to be said of it."""

import math

import numpy as np
import pytest

from benchlab.io.drive_file import write_drive_file
from benchlab.io.journal import read_journal
from benchlab.workflows.study_folder import look_into
from benchlab.workflows.study_readings import Target, read_run
from tests.unit.io.journals import header_of, samples_of, write_journal

TARGET = Target.of(0.15, 0.0005)


def readings(tmp_path, samples=None, kind="serial", target=TARGET, **options):
    header = header_of(samples_of(), kind)
    write_drive_file(
        tmp_path / "run.h5", read_journal(write_journal(tmp_path / "run.journal", samples, header, **options))
    )
    return read_run(tmp_path / "run.h5", target)


def test_each_cycle_has_its_angle_on_the_way_up(tmp_path):
    found = readings(tmp_path)
    assert [cycle.cycle for cycle in found.cycles] == [1, 2]
    for cycle in found.cycles:
        assert cycle.angle_deg == pytest.approx(300 * 0.15, abs=1e-6) and cycle.method == "interpolated"
        assert cycle.peak_MPa == pytest.approx(0.2) and cycle.flag == ""
        assert 0.5 < cycle.angle_sd_deg <= 0.8  # 0.8° is the sensor's; between two samples it is less
    np.testing.assert_allclose(found.curve_deg[5:], 300 * TARGET.curve_MPa[5:], atol=0.5)
    assert found.warnings == ("its angle is by the flex sensor, not from a film",)


def test_a_twin_a_stop_and_a_missing_end_are_told(tmp_path):
    told = readings(tmp_path, kind="twin", stop={"reason": "interrupted", "vented": True}).warnings
    assert told[0] == "no run on a bench of metal: simulated (twin)"
    assert told[-1] == "the run was not completed: interrupted"
    (tmp_path / "run.journal").unlink()
    assert readings(tmp_path, stop=None).warnings[-1] == "the run was not completed: no record of its end"


def test_without_an_angle_there_is_no_value_and_the_reason(tmp_path):
    samples = samples_of()
    samples["angle_deg"] = np.nan
    (cycle,) = readings(tmp_path, samples).cycles
    assert math.isnan(cycle.angle_deg) and cycle.flag.startswith("no angle was measured: the flex sensor")


def test_without_a_measured_pressure_what_was_asked_for_counts_with_a_warning(tmp_path):
    samples = samples_of()
    samples["pressure_MPa"] = np.nan
    found = readings(tmp_path, samples)
    assert found.cycles[0].angle_deg == pytest.approx(300 * 0.14, abs=0.01)  # 0.1 s behind, at 0.1 MPa/s
    assert "no pressure was measured" in found.warnings[-1]


def test_a_pressure_that_is_not_reached_gives_no_value(tmp_path):
    (cycle,) = readings(tmp_path, target=Target.of(0.35, 0.001)).cycles
    assert math.isnan(cycle.angle_deg) and "reaches 0.2 MPa at most" in cycle.flag


def test_a_new_study_takes_drive_files_and_leaves_their_tables_and_a_twins_truth(tmp_path):
    readings(tmp_path)
    (tmp_path / "run.csv").write_text("time_s,angle_deg\n0,1\n")
    (tmp_path / "run.truth.csv").write_text("time_s,angle_deg\n0,1\n")
    found = look_into(tmp_path)
    assert [path.name for path in found.recordings] == ["run.h5"]
    assert {path.name for path, _ in found.unused} == {"run.csv", "run.truth.csv"}
