"""Runs from run files and drive files, whose numbers are known."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.io.drive_file import cycles_of, read_drive_file, write_drive_file
from benchlab.io.journal import read_journal
from benchlab.io.measured_frame import RunName
from benchlab.io.measured_recording import Recorded, read_recording
from benchlab.io.run_file import write_run_file
from benchlab.vision.series import CurvatureSeries
from tests.unit.io.journals import header_of, samples_of, write_journal
from tests.unit.io.test_run_file import ABOUT, bend

NAME = RunName("tw3_slw10", "s1", "first")


def drive(folder: Path, samples: np.ndarray | None = None, **options: object) -> Path:
    journal = read_journal(write_journal(folder / "run.journal", samples, **options))  # type: ignore[arg-type]
    write_drive_file(folder / "run.h5", journal)
    return folder / "run.h5"


def film(folder: Path, series: CurvatureSeries, **about: object) -> Recorded:
    path = folder / "film.h5"
    write_run_file(path, series, **{**ABOUT, **about})  # type: ignore[arg-type]
    return read_recording(path, NAME)


def test_a_drive_file_gives_pressure_command_flex_and_cycles(tmp_path: Path) -> None:
    found, samples = read_recording(drive(tmp_path), NAME), samples_of()
    run = found.run
    assert (run.design, run.sample, run.run) == ("tw3_slw10", "s1", "first") and list(run.values) == ["flex_V"]
    for name, values in (("time_s", run.time_s), ("pressure_MPa", run.pressure_MPa), ("command_MPa", run.command_MPa)):
        np.testing.assert_array_equal(values, samples[name])  # type: ignore[arg-type]
    np.testing.assert_array_equal(run.values["flex_V"], samples["flex_V"])
    assert run.cycle is not None and run.cycle.tolist() == [1.0] * 200 + [2.0] * 200
    assert not found.simulated and not found.never and not found.unfit and found.warnings == ()


def test_what_a_drive_file_lacks_is_told(tmp_path: Path) -> None:
    samples = samples_of()
    samples["pressure_MPa"] = samples["flex_V"] = np.nan
    found = read_recording(drive(tmp_path, samples, stop=None), NAME)
    np.testing.assert_array_equal(found.run.pressure_MPa, samples["command_MPa"])
    np.testing.assert_array_equal(found.run.values["angle_deg"], samples["angle_deg"])
    assert "no pressure was measured: the pressure is what was asked for" in found.warnings
    assert found.unfit == "the run was not completed: no record of its end" and found.unfit in found.warnings


def test_a_drive_file_of_a_twin_and_of_a_replay(tmp_path: Path) -> None:
    assert read_recording(drive(tmp_path, header=header_of(samples_of(), "twin")), NAME).simulated
    (tmp_path / "again").mkdir()
    replay = drive(tmp_path / "again", header=header_of(samples_of(), "replay"))
    assert read_recording(replay, NAME).never == "a replay of a run is not another measurement"


def test_a_drive_file_without_a_reading(tmp_path: Path) -> None:
    samples = samples_of()
    samples["angle_deg"] = samples["flex_V"] = np.nan
    with pytest.raises(InputError, match="nothing was measured in it"):
        read_recording(drive(tmp_path, samples), NAME)


def test_the_vented_bench_is_no_part_of_the_run(tmp_path: Path) -> None:
    vent = {299: [{"kind": "vent", "cause": "end"}]}
    assert len(read_recording(drive(tmp_path, events=vent), NAME).run.time_s) == 300


def test_a_film_gives_angle_and_pressure_where_both_are_known(tmp_path: Path) -> None:
    series = bend()
    found = film(tmp_path, series)
    known = np.isfinite(series.pressure_MPa)  # type: ignore[arg-type]
    run = found.run
    np.testing.assert_array_equal(run.pressure_MPa, series.pressure_MPa[known])  # type: ignore[index]
    np.testing.assert_allclose(run.values["angle_deg"], np.degrees(series.angle_rad[known]), rtol=1e-13)
    np.testing.assert_allclose(run.sd["angle_deg"], np.degrees(series.angle_sd_rad[known]), rtol=1e-13)
    assert np.isnan(run.values["angle_deg"][7]) and run.cycle is None and run.command_MPa is None
    assert f"{(~known).sum()} moments without a pressure left out" in found.warnings


def test_frames_in_doubt_have_no_angle(tmp_path: Path) -> None:
    series = bend()
    found = film(tmp_path, replace(series, flag=(*series.flag[:3], "jump", *series.flag[4:])))
    assert np.flatnonzero(np.isnan(found.run.values["angle_deg"])).tolist() == [3, 7]
    assert "1 frame in doubt: no value there" in found.warnings


def test_a_film_whose_pressure_is_not_known(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="its pressure is not known; analyze the film again with --pressure"):
        film(tmp_path, bend(pressure=False))
    with pytest.raises(InputError, match="pressure of 350 MPa, more than 2"):
        film(tmp_path, replace(bend(), pressure_MPa=np.full(50, 350.0)))


def test_a_film_takes_command_and_cycle_from_its_drive_file(tmp_path: Path) -> None:
    path = drive(tmp_path, events={60: [{"kind": "trigger", "tick": 60, "time_s": 1.21}]})
    clock, samples = 1.2 + np.arange(200) / 30, samples_of()
    series = bend(200)
    pressure = np.interp(clock, samples["time_s"], samples["pressure_MPa"])
    found = film(tmp_path, replace(series, pressure_MPa=pressure), settings={"pressure": str(path)})
    run = found.run
    assert run.command_MPa == pytest.approx(np.interp(clock, samples["time_s"], samples["command_MPa"]))
    journal = read_drive_file(path)
    wanted = cycles_of(journal)[np.searchsorted(samples["time_s"], clock, side="right") - 1]
    assert run.cycle is not None and run.cycle.tolist() == wanted.tolist() and set(wanted) == {1, 2}
    other = film(tmp_path, replace(series, pressure_MPa=pressure * 1.01), settings={"pressure": str(path)})
    assert other.run.command_MPa is None and "does not give the film's pressure" in other.warnings[-1]
    synced = film(tmp_path, replace(series, pressure_MPa=pressure), settings={"pressure": str(path), "sync": -1.2})
    assert synced.run.cycle is not None and synced.run.cycle.tolist() == wanted.tolist()
