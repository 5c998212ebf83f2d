"""A drive file as a recording of a sample: its angle by the flex sensor, in each cycle, and what is to be said of it."""

import math

import numpy as np
import pytest

from benchlab.io.drive_file import write_drive_file
from benchlab.io.journal import read_journal
from benchlab.io.study_file import read_study
from benchlab.workflows.study_check import check_study
from benchlab.workflows.study_folder import look_into
from benchlab.workflows.study_new import NewStudy, new_study
from benchlab.workflows.study_readings import Target, read_run
from benchlab.workflows.study_values import collect
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


def study_of(tmp_path, files: str):
    (tmp_path / "study.yaml").write_text(f"title: T\npressure_MPa: 0.15\ndesigns:\n  a: {{samples: {{{files}}}}}\n")
    return tmp_path / "study.yaml"


def drive(tmp_path, name, kind="serial", angle=1.0, **options):
    """A drive file whose angles are so many times the usual."""
    samples = samples_of()
    samples["angle_deg"] *= angle
    header = options.pop("header", header_of(samples, kind))
    write_drive_file(
        tmp_path / f"{name}.h5", read_journal(write_journal(tmp_path / f"{name}.journal", samples, header, **options))
    )


STOPPED = {"reason": "stuck sensor", "words": "", "vented": True}


def left_out_of(values):
    (design,) = values.designs
    return {sample.name: sample.recordings[0].left_out for sample in design.samples}


def test_a_run_that_was_not_completed_counts_only_where_the_study_says_so(tmp_path):
    drive(tmp_path, "whole")
    drive(tmp_path, "stopped", angle=1.1, stop=STOPPED)
    drive(tmp_path, "full", angle=1.2, stop={"reason": "completed", "vented": True, "empty": False})
    drive(tmp_path, "cut", angle=1.3, stop=None)
    path = study_of(tmp_path, "s1: whole.h5, s2: stopped.h5, s3: full.h5, s4: cut.h5")
    values = collect(read_study(path), tmp_path / "out")
    assert left_out_of(values) == {
        "s1": "",
        "s2": "the run was not completed: stuck sensor",
        "s3": "the actuator was not empty after its vent",
        "s4": "the run was not completed: no record of its end",
    }
    assert [sample.name for sample in values.designs[0].counted] == ["s1"]
    told = check_study(path)
    assert told["designs"][0]["n"] == 1 and len(told["left_out"]) == 3
    path = study_of(tmp_path, "s1: whole.h5, s2: {recordings: [{file: stopped.h5, counts: stopped after its hold}]}")
    assert left_out_of(collect(read_study(path), tmp_path / "out")) == {"s1": "", "s2": ""}
    assert check_study(path)["designs"][0]["n"] == 2


def test_a_replay_and_a_copy_are_no_samples(tmp_path):
    drive(tmp_path, "one")
    drive(tmp_path, "again", header={**header_of(samples_of()), "title": "the same, told otherwise"})
    replayed = {**header_of(samples_of(), "replay"), "device": {"kind": "replay", "replayed": "serial"}}
    drive(tmp_path, "replay", angle=1.1, header=replayed)
    path = study_of(tmp_path, "s1: one.h5, s2: again.h5, s3: {recordings: [{file: replay.h5, counts: I want it}]}")
    assert left_out_of(collect(read_study(path), tmp_path / "out")) == {
        "s1": "",
        "s2": "has the same samples as one.h5 of a s1: a copy is no repetition",
        "s3": "a replay of a run is not another measurement",
    }
    assert check_study(path)["designs"][0]["n"] == 1


def test_what_was_not_measured_and_a_mixture_are_told_by_the_check(tmp_path):
    drive(tmp_path, "one", "twin")
    drive(tmp_path, "two", "twin", angle=1.1)
    drive(tmp_path, "real", angle=1.2)
    notes = check_study(study_of(tmp_path, "s1: one.h5, s2: two.h5"))["notes"]
    assert notes[0]["why"] == "nothing was measured: of the recordings that count, 2 simulated on the twin"
    notes = check_study(study_of(tmp_path, "s1: one.h5, s2: two.h5, s3: real.h5"))["notes"]
    assert notes[0]["why"].startswith(
        "MIXED ORIGINS: of the recordings that count, 1 measured, 2 simulated on the twin"
    )


def test_a_film_beside_its_run_has_its_pressure_from_it(tmp_path):
    for name in ("a_s1", "a_s2"):
        drive(tmp_path, name)
        (tmp_path / f"{name}.csv").write_text("time_s,angle_deg\n0,1\n")
    (tmp_path / "a_s1.film.mp4").write_bytes(b"film")
    (tmp_path / "a_s2.mp4").write_bytes(b"film")
    told = new_study(tmp_path, None, NewStudy())
    assert told["designs"][0]["samples"] == {"s1": ["a_s1.film.mp4"], "s2": ["a_s2.mp4"]} and told["pressure_known"]
    assert {each["file"] for each in told["unused"]} == {"a_s1.csv", "a_s2.csv"}
    (design,) = read_study(tmp_path / "study.yaml").designs
    pressures = [sample.recordings[0].analysis["pressure"] for sample in design.samples]
    assert pressures == [str(tmp_path / "a_s1.h5"), str(tmp_path / "a_s2.h5")]
    told = new_study(tmp_path, None, NewStudy(ramp="0:0.35:2.5"), overwrite=True)
    assert {"file": "a_s1.h5", "why": "--ramp tells the pressure of a_s1.film.mp4"} in told["unused"]
    assert "pressure" not in read_study(tmp_path / "study.yaml").designs[0].samples[0].recordings[0].analysis
