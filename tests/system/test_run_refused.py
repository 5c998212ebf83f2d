"""What `benchlab run` refuses before a bench is opened, and what a dry run says."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from benchlab.workflows import run as run_workflow
from benchlab.workflows import run_prepare
from tests.system.runs import LOOP, SHORT, left


def test_a_dry_run_says_what_would_run_and_opens_nothing(
    tmp_path: Path, short: Path, benchlab: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(*_: Any, **__: Any) -> None:
        raise AssertionError("a bench was opened")

    monkeypatch.setattr(run_workflow, "open_bench", never)
    words = ("run", short, "--dry-run", "--out", tmp_path / "out", "--json")
    done = benchlab(*words, "--bench", "serial:/dev/nowhere")
    assert done.code == 0 and not (tmp_path / "out").exists()
    found = done.json
    assert found["plan"]["duration_s"] == 8 and found["plan"]["peak_MPa"] == 0.3 and found["dry_run"]
    assert found["bench"]["calibrated"] is False and found["bench"]["ceiling_MPa"] < 0.336
    assert found["guards"] == ["device", "faults"]  # no monitor, no flex sensor is calibrated
    assert any("no calibration" in warning for warning in found["warnings"])
    assert any("a burst or a tube that is off is not seen" in warning for warning in found["warnings"])
    assert "watched: device, faults" in done.err and "nothing was written" in done.err
    assert len(benchlab(*words, "--bench", "twin").json["guards"]) == 9


REFUSED = [
    (["high.yaml"], 3, "line 5: ramp 0 to 0.36 MPa in 1 s reaches 0.36 MPa"),
    (
        ["above.yaml", "--bench", "serial:/dev/nowhere"],
        3,
        "above.yaml, line 5, step 1 (ramp 0 to 0.349 MPa in 1 s): asks for 0.349 MPa, above 0.32 MPa, the ceiling of the bench; in all",
    ),
    (["nothing.yaml"], 2, "no protocol of this name"),
    (
        ["short.yaml", "--bench", "metal"],
        2,
        "'metal' is no bench; give twin, twin:FILE, serial:PORT, emulated or replay",
    ),
    (["short.yaml", "--bench", "serial"], 2, "give serial:PORT"),
    (["short.yaml", "--bench", "serial:/dev/nowhere", "--fast"], 2, "which a real bench does not have"),
    (["short.yaml", "--bench", "emulated", "--video"], 2, "--video is for a twin"),
    (["short.yaml", "--bench", "emulated", "--seed", "3"], 2, "--seed is for a twin"),
    (["short.yaml", "--bench", "emulated", "--rate-Hz", "2"], 3, "the plan's rate is 2 Hz"),
    (["short.yaml", "--guard", "follow=1"], 2, "there is no limit 'follow'"),
    (["short.yaml", "--pause-limit-s", "0"], 2, "--pause-limit-s is 0"),
    (["short.yaml", "--max-duration-s", "5"], 3, "8 s"),
    (["short.yaml", "--name", "a/b"], 2, "is no name for files"),
    (["short.yaml", "--name", ""], 2, "is no name for files"),
    (["short.yaml", "--name", "-x"], 2, "is no name for files"),
    (["short.yaml", "--name", "x.h5"], 2, "give --name x: the suffixes come by themselves"),
    (["short.yaml", "--guard", "above_MPa=5"], 2, "--guard above_MPa=5: more than 0.1"),
    (["short.yaml", "--out", "none/here"], 2, "no such folder"),
    (["short.yaml", "--out", "short.yaml"], 2, "it is a file"),
    (["short.yaml", "--name", "taken"], 2, "taken.h5: exists, and measured data is never replaced"),
    (["short.yaml", "--calibration", "none.yaml"], 2, "none.yaml: no such file"),
    (["loop.yaml"], 3, "give --control"),
    (["loop.yaml", "--bench", "serial:none"], 3, "is not calibrated"),
    (["short.yaml", "--bench", "replay:none.journal"], 2, "none.journal: no such file"),
    (["short.yaml", "--curve", "a.csv", "--design", "tw3_slw10"], 2, "both give a response curve"),
]


@pytest.mark.parametrize(("words", "code", "said"), REFUSED, ids=[" ".join(words) for words, _, _ in REFUSED])
def test_what_is_refused_opens_no_bench_and_leaves_no_file(
    tmp_path: Path, benchlab: Any, monkeypatch: pytest.MonkeyPatch, words: list[str], code: int, said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("short.yaml").write_text(SHORT)
    Path("high.yaml").write_text(SHORT.replace("to_MPa: 0.3", "to_MPa: 0.36"))
    Path("above.yaml").write_text(SHORT.replace("to_MPa: 0.3", "to_MPa: 0.349"))
    Path("loop.yaml").write_text("\n".join(line for line in LOOP.splitlines() if "control" not in line))
    Path("taken.h5").write_text("mine")
    before = left(tmp_path)
    opened: list[Any] = []
    monkeypatch.setattr(run_workflow, "open_bench", lambda *a, **k: opened.append(a))
    done = benchlab("run", *words, "--json")
    assert done.code == code and said in done.err, done.err
    assert done.json["error"]["code"] == code
    assert not opened and left(tmp_path) == before


def test_a_folder_without_permission_or_room_is_refused_before_the_bench_is_opened(
    tmp_path: Path, short: Path, benchlab: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run_workflow, "open_bench", lambda *a, **k: pytest.fail("opened"))
    access = os.access
    with monkeypatch.context() as patch:  # root may write everywhere
        patch.setattr(os, "access", lambda path, mode: not mode & os.W_OK and access(path, mode))
        done = benchlab("run", short, "--out", tmp_path)
    assert done.code == 2 and "the output folder is read-only" in done.err
    usage = run_prepare.shutil.disk_usage(tmp_path)
    monkeypatch.setattr(run_prepare.shutil, "disk_usage", lambda _: usage._replace(free=1_000_000))
    done = benchlab("run", short, "--out", tmp_path)
    assert done.code == 3 and "disk full: 1 MB free, 20 MB are kept" in done.err


def test_a_port_that_is_not_there_is_5_and_lists_the_ports(tmp_path: Path, short: Path, benchlab: Any) -> None:
    text = SHORT.replace("0.3", "0.2")
    short.write_text(text)
    done = benchlab("run", short, "--bench", "serial:/dev/ttyNOWHERE", "--out", tmp_path / "out", "--json")
    assert done.code == 5 and "/dev/ttyNOWHERE" in done.err and "port" in done.err
    assert done.json["error"]["code"] == 5 and left(tmp_path / "out") == []
