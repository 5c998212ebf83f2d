"""Force files of a study: blocked force of its designs, and what fails, is left out or is doubtful."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchlab.force.synthetic import draw_trace
from benchlab.io.study_file import Study, read_study
from benchlab.workflows.study_force import StudyForce, force_of
from benchlab.workflows.study_values import collect

LEVELS = np.repeat([0.1, 0.2, 0.3], 2)


@pytest.fixture
def bench(tmp_path: Path) -> Path:
    """Three drawn actuators of 98, 100 and 102 N/MPa, and a log of the pressure of the first."""
    for number, slope in enumerate((98.0, 100.0, 102.0), start=1):
        drawn = draw_trace(
            (slope * LEVELS).tolist(), LEVELS.tolist(), np.random.default_rng(number), noise_N=0.02, rate_Hz=50
        )
        table = np.column_stack([drawn.time_s, drawn.force_N])
        np.savetxt(tmp_path / f"a{number}.csv", table, "%.4f", ",", header="time_s,force_N", comments="")
        log = np.column_stack([drawn.time_s, drawn.pressure_MPa])
        np.savetxt(tmp_path / f"log{number}.csv", log, "%.5f", ",", header="time_s,pressure_MPa", comments="")
    (tmp_path / "angles.csv").write_text("angle_deg\n100\n101\n")
    return tmp_path


def study_of(bench: Path, force: str) -> Study:
    path = bench / "study.yaml"
    path.write_text(
        f"title: T\npressure_MPa: 0.3\ndesigns:\n  d:\n    samples:\n      s1: angles.csv\n    force:\n{force}"
    )
    return read_study(path)


def found(bench: Path, force: str) -> StudyForce:
    return force_of(study_of(bench, force).designs[0])


STEPS = "      steps_MPa: [0.1, 0.2, 0.3]\n      cycles: 2\n"


def test_files_are_actuators_and_share_the_settings_of_their_design(bench: Path) -> None:
    one = found(
        bench, STEPS + "      lever_arm_mm: 7.5\n      files: [a1.csv, {file: a2.csv, actuator: second}, a3.csv]\n"
    )
    assert one.failures == one.left_out == one.warnings == ()
    assert one.force is not None
    assert one.force.actuators == ("a1", "second", "a3")
    assert one.force.mean_N[:, -1] == pytest.approx([29.4, 30.0, 30.6], abs=0.06)
    assert one.force.lever_arm_mm == 7.5
    assert set(one.inputs) == {"a1.csv", "a2.csv", "a3.csv"} and all(len(sum_) == 64 for sum_ in one.inputs.values())


def test_a_log_beside_a_file_tells_its_pressures(bench: Path) -> None:
    one = found(
        bench, "      files:\n" + "".join(f"        - {{file: a{n}.csv, pressure: log{n}.csv}}\n" for n in (1, 2, 3))
    )
    assert one.force is not None
    assert one.force.over_actuators_N == pytest.approx([10, 20, 30], abs=0.06)
    assert {"log1.csv", "log2.csv", "log3.csv"} < set(one.inputs)


def test_what_fails_is_a_failure_and_the_rest_goes_on(bench: Path) -> None:
    (bench / "cut.csv").write_text("time_s,force_N\n")
    files = "      files: [a1.csv, cut.csv, nowhere.csv, a2.csv, {file: a3.csv, left_out: it leaked}]\n"
    one = found(bench, STEPS + files)
    assert one.force is not None and one.force.actuators == ("a1", "a2")
    assert [(missing.sample, missing.recording) for missing in one.failures] == [
        ("cut", "cut.csv"),
        ("nowhere", "nowhere.csv"),
    ]
    assert "no data rows" in one.failures[0].why and "no such file" in one.failures[1].why
    assert [(missing.recording, missing.why) for missing in one.left_out] == [("a3.csv", "it leaked")]


def test_files_without_a_pressure_are_failures(bench: Path) -> None:
    one = found(bench, "      files: [a1.csv]\n")
    assert one.force is None
    assert "no pressure of its cycles is known" in one.failures[0].why
    assert one.failures[1].why == "no force file has a value"


def test_doubts_are_warnings_with_their_file(bench: Path) -> None:
    (bench / "copy.csv").write_bytes((bench / "a1.csv").read_bytes())
    one = found(
        bench, STEPS + "      files: [{file: a1.csv, lever_arm_mm: 7}, copy.csv, {file: a2.csv, lever_arm_mm: 8}]\n"
    )
    assert next((w.recording, w.why) for w in one.warnings) == ("copy.csv", "has the same content as a1.csv")
    assert one.force is not None and one.force.lever_arm_mm is None
    assert any("different lever arms" in w.why for w in one.warnings)


def test_settings_without_sense_are_failures_of_the_file(bench: Path) -> None:
    one = found(bench, "      steps_MPa: [0.3, 0.2, 0.1]\n      files: [a1.csv]\n")
    assert one.force is None and "do not grow" in one.failures[0].why


def test_values_of_a_study_hold_the_force_of_its_designs(bench: Path, tmp_path: Path) -> None:
    (bench / "bad.csv").write_text("x")
    values = collect(study_of(bench, STEPS + "      files: [a1.csv, a2.csv, bad.csv]\n"), tmp_path / "out")
    force = values.designs[0].force
    assert force is not None and force.actuators == ("a1", "a2")
    assert "bad.csv" in [missing.recording for missing in values.failures]
    assert "a1.csv" in values.inputs
