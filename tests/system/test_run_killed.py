"""A run as a process of its own, in real time: what signals, a full disk and kill -9 leave of it."""

from __future__ import annotations

import json
import resource
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchlab.io.journal import Journal, read_journal
from tests.system.patience import LATE, LONG_S, PATIENT, wait_until

PROTOCOL = """\
title: Long
limit_MPa: 0.35
segments:
  - ramp: {to_MPa: 0.2, duration_s: 0.5}
  - hold: {duration_s: 1200}  # no test waits for its end, however slow the computer
"""

Process = subprocess.Popen[str]


class Runs:
    """Starts runs, and ends those that are left."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.protocol = folder / "long.yaml"
        self.protocol.write_text(PROTOCOL)
        self.processes: list[Process] = []

    def start(self, *options: str, **popen: Any) -> Process:
        command = [*PATIENT, "run", self.protocol, "--out", self.folder, "--name", "a", "--json", *LATE, *options]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **popen)
        self.processes.append(process)
        return process

    def going(self, process: Process, ticks: int = 60) -> None:
        """Wait until so many ticks are in the journal."""
        journal, until = self.folder / "a.journal", time.monotonic() + LONG_S
        while time.monotonic() < until and process.poll() is None:
            if journal.exists() and journal.stat().st_size > 4000 and len(read_journal(journal).samples) >= ticks:
                return
            time.sleep(0.02)
        pytest.fail(f"the run does not go on: {process.communicate(timeout=1)}")

    def until_event(self, process: Process, kind: str) -> None:
        """Wait until an event of this kind is in the journal."""
        wait_until(lambda: kind in [each["kind"] for each in self.journal.events], lambda: process.poll() is None)

    @property
    def journal(self) -> Journal:
        return read_journal(self.folder / "a.journal")


@pytest.fixture
def runs(tmp_path: Path) -> Iterator[Runs]:
    found = Runs(tmp_path)
    yield found
    for process in found.processes:
        if process.poll() is None:
            process.kill()
        process.communicate()


@pytest.mark.parametrize(
    ("number", "reason"),
    [(signal.SIGINT, "interrupted"), (signal.SIGTERM, "terminated"), (signal.SIGHUP, "hung up")],
    ids=["SIGINT", "SIGTERM", "SIGHUP"],
)
def test_a_signal_vents_and_leaves_all_files(runs: Runs, number: int, reason: str) -> None:
    process = runs.start()
    runs.going(process)
    process.send_signal(number)
    if number == signal.SIGINT:
        process.send_signal(number)  # a second one, while it vents, changes nothing
    out, err = process.communicate(timeout=LONG_S)
    found = json.loads(out)
    assert process.returncode == 130, err
    assert (found["reason"], found["vented"], found["error"]["code"]) == (reason, True, 130)
    assert runs.journal.stop and runs.journal.stop["reason"] == reason and runs.journal.stop["vented"]
    assert found["ticks"] == len(runs.journal.driven) and found["empty"] is True and 0 < found["late_ms"]["p50"] < 5000
    assert sorted(path.suffix for path in runs.folder.glob("a.*")) == [".csv", ".csv", ".h5", ".journal", ".png"]


def test_a_run_that_is_killed_leaves_a_journal_that_recover_reads(runs: Runs, benchlab: Any) -> None:
    process = runs.start()
    runs.going(process)
    process.kill()
    process.communicate()
    journal = runs.journal
    assert not journal.complete and journal.lost_bytes == 0 and len(journal.samples) >= 60
    assert journal.samples["tick"].tolist() == list(range(len(journal.samples)))
    done = benchlab("recover", runs.folder / "a.journal", "--json")
    assert done.code == 0 and done.json["samples"] == len(journal.samples) and (runs.folder / "a.h5").exists()


def test_usr1_pauses_and_goes_on(runs: Runs) -> None:
    process = runs.start()
    runs.going(process)
    began = time.monotonic()
    process.send_signal(signal.SIGUSR1)
    runs.until_event(process, "pause")
    time.sleep(0.3)
    process.send_signal(signal.SIGUSR1)
    runs.until_event(process, "resume")
    longest_s = time.monotonic() - began
    ticks = len(runs.journal.samples)
    wait_until(lambda: len(runs.journal.samples) > ticks + 5, lambda: process.poll() is None)
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=LONG_S)
    kinds = [event["kind"] for event in runs.journal.events]
    assert kinds == ["pause", "resume", "vent", "stop"]
    assert 0.2 < (runs.journal.stop or {})["paused_s"] < longest_s + 0.1
    ticks = runs.journal.samples["tick"].astype(int)
    assert set(np.diff(ticks)) == {0, 1}  # held, then on, and none left out


def test_a_pause_that_is_forgotten_vents(runs: Runs) -> None:
    process = runs.start("--pause-limit-s", "0.3")
    runs.going(process)
    process.send_signal(signal.SIGUSR1)
    out, err = process.communicate(timeout=LONG_S)
    assert process.returncode == 5 and json.loads(out)["reason"] == "pause", err
    assert "a pause lasts 0.3 s at most" in err and json.loads(out)["vented"]


def test_a_stopped_process_finds_itself_late_and_ends(runs: Runs) -> None:
    process = runs.start("--guard", "late_s=2")
    runs.going(process)
    process.send_signal(signal.SIGSTOP)
    time.sleep(2.5)
    process.send_signal(signal.SIGCONT)
    out, err = process.communicate(timeout=LONG_S)
    found = json.loads(out)
    assert process.returncode == 5 and found["reason"] == "overrun" and found["vented"], err
    assert "after its deadline, more than 2 s" in err
    assert runs.journal.samples["late_s"].max() <= 2


def test_a_full_disk_vents_and_keeps_what_was_measured(runs: Runs) -> None:
    def small_files() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

    process = runs.start(preexec_fn=small_files)
    out, err = process.communicate(timeout=LONG_S)
    found = json.loads(out)
    assert process.returncode == 3 and found["reason"] == "journal" and found["vented"], err
    assert "the journal could not be written" in err and "recover" in err
    assert err.count("the journal could not be written") == 1 and "old result" not in err
    assert len(runs.journal.samples) > 60 and runs.journal.samples["tick"].tolist() == list(
        range(len(runs.journal.samples))
    )


def test_two_runs_of_one_name_are_not_mixed(runs: Runs) -> None:
    first = runs.start()
    runs.going(first)
    second = runs.start()
    _, err = second.communicate(timeout=LONG_S)
    assert second.returncode == 2 and "a.journal: exists, and measured data is never replaced" in err
    first.send_signal(signal.SIGTERM)
    first.communicate(timeout=LONG_S)
    assert first.returncode == 130 and runs.journal.complete


def test_a_reader_that_has_gone_does_not_stop_the_run(runs: Runs) -> None:
    runs.protocol.write_text(PROTOCOL.replace("1200", "0.5"))
    process = runs.start()
    assert process.stdout is not None and process.stderr is not None
    process.stdout.close()
    process.stderr.close()
    process.wait(timeout=LONG_S)
    assert runs.journal.stop and runs.journal.stop["reason"] == "completed"
    process.stdout = process.stderr = None
    assert (runs.folder / "a.h5").exists()


def test_interrupting_again_and_again_still_tells_the_outcome_and_the_files(runs: Runs) -> None:
    process = runs.start()
    runs.going(process)
    ended = time.monotonic() + LONG_S
    while not (runs.folder / "a.truth.csv").exists() and process.poll() is None and time.monotonic() < ended:
        process.send_signal(signal.SIGINT)
        time.sleep(0.05)
    out, err = process.communicate(timeout=LONG_S)
    assert process.returncode == 130 and "benchlab: interrupted: " in err and "vented" in err, err
    found = json.loads(out)
    assert found["vented"] and found["outputs"] == [
        line.split("wrote ")[1] for line in err.splitlines() if "wrote " in line
    ]
    assert all(Path(path).exists() for path in found["outputs"]) and runs.journal.complete


def test_a_folder_that_is_removed_ends_the_run_and_no_file_is_claimed(runs: Runs) -> None:
    out = runs.folder / "out"
    process = runs.start("--out", str(out))
    until = time.monotonic() + LONG_S
    while not (out / "a.journal").exists() or (out / "a.journal").stat().st_size < 8000:
        assert time.monotonic() < until and process.poll() is None
        time.sleep(0.02)
    shutil.rmtree(out)
    told, err = process.communicate(timeout=LONG_S)
    found = json.loads(told)
    assert process.returncode == 3 and found["reason"] == "journal" and found["vented"], err
    assert "not at its place any more" in found["words"] and found["outputs"] == [] and found["time_s"] < 30
    assert "wrote" not in err and "recover" not in err and "old result" not in err
