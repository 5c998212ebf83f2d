"""`benchlab recover`, and the commands that read what it makes: analyze, report, study, force."""

import json
import os
import platform
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas
import pytest

from benchlab.io.drive_file import read_drive_file, write_drive_file
from benchlab.io.journal import JournalWriter, read_journal
from tests.system.conftest import ANGLES_DEG, FPS
from tests.unit.io.journals import header_of, samples_of, write_journal

NAMES = ["trial.csv", "trial.h5", "trial.journal", "trial.png"]


@pytest.fixture
def journal(tmp_path: Path) -> Path:
    return write_journal(tmp_path / "trial.journal")


def cut(path: Path, by: int) -> None:
    path.write_bytes(path.read_bytes()[:-by])


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_files_of_a_whole_run_beside_its_journal(benchlab, journal: Path) -> None:
    before = journal.read_bytes()
    done = benchlab("recover", journal, "--json")
    assert done.code == 0
    assert names(journal.parent) == NAMES and journal.read_bytes() == before
    found = done.json
    assert (found["complete"], found["reason"], found["vented"]) == (True, "completed", True)
    assert (found["samples"], found["ticks"], found["ticks_planned"]) == (400, 400, 400)
    assert found["lost"] == [] and found["lost_bytes"] == 0 and found["origin"] == "measured"
    assert found["outputs"] == [str(journal.with_suffix(suffix)) for suffix in (".h5", ".csv", ".png")]
    for words in ("its end is recorded: completed", "vented", "nothing is lost", "wrote"):
        assert words in done.err
    assert read_drive_file(journal.with_suffix(".h5")).samples.tobytes() == samples_of().tobytes()
    assert len(pandas.read_csv(journal.with_suffix(".csv"))) == 400


def test_a_cut_journal_gives_what_is_whole_and_says_what_is_not(benchlab, journal: Path) -> None:
    cut(journal, 250)
    done = benchlab("recover", journal, "--json")
    assert done.code == 0
    found = done.json
    assert (found["complete"], found["reason"], found["vented"]) == (False, None, None)
    assert found["samples"] == 398 and found["lost_bytes"] > 0
    assert "no record of its end" in done.err and "not known" in done.err
    assert "lost:" in done.err and "the last record is cut" in done.err
    assert not read_drive_file(journal.with_suffix(".h5")).complete


def test_with_strict_a_script_sees_that_a_journal_is_not_whole(benchlab, journal: Path) -> None:
    assert benchlab("recover", journal, "--strict").code == 0
    data = bytearray(journal.read_bytes())
    data[len(data) // 2] ^= 4
    journal.write_bytes(data)
    assert benchlab("recover", journal, "--overwrite").code == 0
    done = benchlab("recover", journal, "--overwrite", "--strict")
    assert done.code == 3 and "the journal is not whole, and --strict was given" in done.err
    data[len(data) // 2] ^= 4
    journal.write_bytes(data)
    cut(journal, 60)  # the record of the end
    done = benchlab("recover", journal, "--overwrite", "--strict", "--json")
    assert done.code == 3 and not done.json["complete"] and journal.with_suffix(".h5").exists()


def test_one_recover_at_a_time(benchlab, journal: Path) -> None:
    (journal.parent / ".trial.lock").write_text(f"process {os.getpid()} on {platform.node()}")
    done = benchlab("recover", journal)
    assert done.code == 2 and "is being written by another benchlab" in done.err
    assert not journal.with_suffix(".h5").exists()


def test_an_analysis_never_replaces_a_drive_file(benchlab, drawn_clip, journal: Path, tmp_path: Path) -> None:
    """A film that is called as the run is: what was measured stays, whatever is asked for."""
    assert benchlab("recover", journal).code == 0
    drive = journal.with_suffix(".h5")
    before = drive.read_bytes()
    for more in ([], ["--overwrite"]):
        done = benchlab("analyze", drawn_clip, "--pressure", drive, "--sync", "0", "--out", tmp_path, *more)
        assert done.code == 2 and "trial.h5" in done.err and drive.read_bytes() == before
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, "--overwrite")
    assert done.code == 2 and "the record of a run on a bench" in done.err and drive.read_bytes() == before


def test_damage_in_the_middle_is_told(benchlab, journal: Path) -> None:
    data = bytearray(journal.read_bytes())
    data[len(data) // 2] ^= 4
    journal.write_bytes(data)
    found = benchlab("recover", journal, "--json").json
    assert found["complete"] and found["samples"] == 399
    assert found["lost"][0].startswith("1 record at byte") and "of which 106 bytes are left" in found["lost"][0]
    assert found["missing_ticks"] == 1 and found["gaps"][0].startswith("no sample of 1 tick between")


def test_files_that_are_there_are_kept_unless_overwrite_is_given(benchlab, journal: Path) -> None:
    (journal.with_suffix(".csv")).write_text("mine")
    done = benchlab("recover", journal)
    assert done.code == 2 and "trial.csv: exists" in done.err
    assert names(journal.parent) == ["trial.csv", "trial.journal"]
    assert benchlab("recover", journal, "--overwrite").code == 0
    assert benchlab("recover", journal, "--out", journal.parent / "elsewhere").code == 0
    assert names(journal.parent / "elsewhere") == ["trial.csv", "trial.h5", "trial.png"]


def test_no_journal_no_folder_no_sample_are_refused_with_nothing_left(benchlab, journal: Path, tmp_path: Path) -> None:
    done = benchlab("recover", tmp_path / "none.journal")
    assert done.code == 2 and "no such file" in done.err
    done = benchlab("recover", journal, "--out", tmp_path / "none" / "none")
    assert done.code == 2 and "no such folder" in done.err
    (tmp_path / "a.journal").write_text("time_s,pressure_MPa\n0,0\n")
    done = benchlab("recover", tmp_path / "a.journal", "--json")
    assert done.code == 3 and done.json["error"]["what"] == "not a benchlab journal"
    empty = write_journal(tmp_path / "empty.journal", samples_of()[:0], {"title": "x"}, stop=None)
    done = benchlab("recover", empty)
    assert done.code == 3 and "holds no sample" in done.err
    damaged = bytearray(journal.read_bytes())
    damaged[100] ^= 1
    (tmp_path / "head.journal").write_bytes(damaged)
    done = benchlab("recover", tmp_path / "head.journal")
    assert done.code == 3 and "head of the journal is damaged" in done.err
    assert names(tmp_path) == ["a.journal", "empty.journal", "head.journal", "trial.journal"]


def test_a_journal_that_is_named_as_a_result_is_not_replaced(benchlab, journal: Path) -> None:
    journal.rename(journal.with_suffix(".h5"))
    done = benchlab("recover", journal.with_suffix(".h5"), "--overwrite")
    assert done.code == 2 and "would be replaced" in done.err


def test_a_run_that_goes_on_is_left_alone(benchlab, tmp_path: Path) -> None:
    writer = JournalWriter(tmp_path / "trial.journal", header_of(samples_of()))
    writer.sample(*samples_of().tolist()[0])
    done = benchlab("recover", writer.path)
    assert done.code == 2 and "still being written" in done.err and names(tmp_path) == ["trial.journal"]
    writer.close()
    assert benchlab("recover", writer.path).code == 0


def test_a_head_from_elsewhere_without_a_plan_is_enough(benchlab, tmp_path: Path) -> None:
    path = write_journal(tmp_path / "trial.journal", header={"title": "<script>\x1b[31m", "plan": None})
    done = benchlab("recover", path, "--json")
    assert done.code == 0 and done.json["ticks_planned"] is None
    assert "\x1b" not in done.err


@pytest.mark.parametrize("limit", [5_000, 36_000, 60_000])
def test_a_disk_that_is_full_leaves_the_journal_and_no_other_file(journal: Path, limit: int) -> None:
    code = (
        "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        f"resource.setrlimit(resource.RLIMIT_FSIZE, ({limit}, {limit}))\n"
        "from benchlab.cli.app import run; run(['recover', sys.argv[1]])\n"
    )
    done = subprocess.run([sys.executable, "-c", code, str(journal)], capture_output=True, text=True, check=False)
    assert done.returncode == 3 and "could not be written" in done.stderr
    assert names(journal.parent) == ["trial.journal"]


def test_a_folder_that_is_read_only_is_refused_before_anything_is_read(
    benchlab, journal: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", lambda path, mode: not mode & os.W_OK)
    done = benchlab("recover", journal)
    assert (
        done.code == 2 and "the output folder is read-only" in done.err and names(journal.parent) == ["trial.journal"]
    )


def drive_of(folder: Path, angles_deg: np.ndarray, delay_s: float, measured: bool = True) -> Path:
    """A run whose pressure is the film's true angle / 300 MPa, and whose camera starts delay_s after the run."""
    count = int(50 * (delay_s + len(angles_deg) / FPS)) + 1
    samples = np.resize(samples_of(), count)
    samples["tick"], samples["time_s"] = np.arange(count), np.arange(count) / 50
    film_s = samples["time_s"] - delay_s
    samples["command_MPa"] = np.interp(film_s, np.arange(len(angles_deg)) / FPS, angles_deg) / 300
    samples["pressure_MPa"] = samples["command_MPa"] if measured else np.nan
    tick = int(delay_s * 50)
    events = {tick: [{"kind": "trigger", "tick": tick, "time_s": delay_s + 0.004}]}
    path = folder / "drive.journal"
    path.unlink(missing_ok=True)
    write_drive_file(folder / "drive.h5", read_journal(write_journal(path, samples, header_of(samples), events)))
    return folder / "drive.h5"


def test_analyze_takes_the_pressure_of_a_run_from_the_moment_of_its_trigger(benchlab, drawn_clip, tmp_path) -> None:
    drive = drive_of(tmp_path, ANGLES_DEG, delay_s=1.5)
    done = benchlab("analyze", drawn_clip, "--pressure", drive, "--out", tmp_path / "a", "--json")
    assert done.code == 0
    assert "the film is taken to begin at 1.500 s of drive.h5, when the camera was triggered" in done.err
    assert "triggered" in json.dumps(done.json)
    table = pandas.read_csv(tmp_path / "a" / "trial.csv")
    assert np.abs(table["pressure_MPa"] - ANGLES_DEG / 300).max() < 0.004  # 50 Hz against 30 frames a second
    done = benchlab("analyze", drawn_clip, "--pressure", drive, "--sync", "-1.0", "--out", tmp_path / "b")
    assert done.code == 0 and "triggered" not in done.err
    shifted = pandas.read_csv(tmp_path / "b" / "trial.csv")["pressure_MPa"]
    wanted = np.interp(np.arange(40) / FPS - 0.5, np.arange(40) / FPS, ANGLES_DEG / 300)
    assert np.abs(shifted - wanted).max() < 0.004


def test_analyze_says_where_the_pressure_is_only_what_was_asked_for(benchlab, drawn_clip, tmp_path) -> None:
    drive = drive_of(tmp_path, ANGLES_DEG, delay_s=0.0, measured=False)
    done = benchlab("analyze", drawn_clip, "--pressure", drive, "--out", tmp_path / "a")
    assert done.code == 0 and "no pressure was measured in drive.h5: the pressure is what was asked for" in done.err


def test_report_and_study_check_read_drive_files(benchlab, tmp_path: Path) -> None:
    for name, factor in {"wide_s1": 1.0, "wide_s2": 1.02, "narrow_s1": 0.6, "narrow_s2": 0.63}.items():
        samples = samples_of()
        samples["angle_deg"] *= factor
        path = write_journal(tmp_path / f"{name}.journal", samples, header_of(samples, "twin"))
        assert benchlab("recover", path).code == 0
    done = benchlab("study", "new", tmp_path, "--pressure-MPa", 0.15)
    assert done.code == 0, done.err
    text = (tmp_path / "study.yaml").read_text()
    assert "wide_s1.h5" in text
    checked = benchlab("study", "check", tmp_path / "study.yaml", "--json")
    assert checked.code == 0 and not checked.json["missing"]
    done = benchlab("report", tmp_path / "study.yaml", "--out", tmp_path / "report", "--json")
    assert done.code == 0, done.err
    numbers = json.dumps(done.json) + done.err
    assert "by the flex sensor" in numbers and "simulated (twin)" in numbers
    rows = pandas.read_csv(tmp_path / "report" / "tables" / "values.csv")
    wide = rows[(rows["design"] == "wide") & (rows["sample"] == "s1")]
    assert wide["angle_deg"].tolist() == pytest.approx([45, 45], abs=1e-4)


def test_force_takes_the_pressure_of_a_run(benchlab, tmp_path: Path) -> None:
    samples = samples_of()
    drive = tmp_path / "run.h5"
    write_drive_file(drive, read_journal(write_journal(tmp_path / "run.journal", samples)))
    rows = "".join(f"{t:.3f},{100 * p:.4f}\n" for t, p in zip(samples["time_s"], samples["pressure_MPa"]))
    (tmp_path / "force.csv").write_text("time_s,force_N\n" + rows)
    done = benchlab("force", tmp_path / "force.csv", "--pressure", drive, "--out", tmp_path / "out", "--json")
    assert done.code == 0, done.err
    (level,) = done.json["blocked_force"]["pressures"]
    assert level["pressure_MPa"] == pytest.approx(0.2, abs=0.002)
    assert level["mean_N"] == pytest.approx(20, abs=1)  # a sharp peak, smoothed
