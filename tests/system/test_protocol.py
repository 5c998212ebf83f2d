"""`benchlab protocol` from end to end, and the shipped protocols in an installed package."""

import csv
import os
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from benchlab.bench import Bench
from benchlab.io.protocol_file import read_protocol, shipped_protocols
from tests.benches import write_bench

ROOT = Path(__file__).resolve().parents[2]
BAD = "title: bad\nlimit_MPa: 0.3\nsegments:\n  - ramp: {to: 10 psi, duration_s: 1}\n  - hold: {duration_s: -1}\n"


def test_show_tells_numbers_steps_and_marks(benchlab: Callable) -> None:
    done = benchlab("protocol", "show", "linear_ramp")
    assert done.code == 0 and not done.err
    for words in (
        "Linear ramp",
        "lasts 5 s, 501 samples at 100 Hz, 3 steps",
        "peak 0.35 MPa, limit 0.35 MPa",
        "slew at most 0.14 MPa/s within steps; besides, 1 fall of up to 0.35 MPa at once, as fast as the bench can\n",
        "not checked against a bench: --calibration FILE does that\n",
        "ends vented",
        "2.5 s  mark: top",
    ):
        assert words in done.out
    assert "inf" not in done.out


def test_show_writes_the_plan_as_table_and_picture_and_replaces_nothing(benchlab: Callable, tmp_path: Path) -> None:
    table, picture = tmp_path / "plan.csv", tmp_path / "plan.png"
    done = benchlab("protocol", "show", "sine_tracking", "--out", table, "--out", picture, "--json")
    assert done.code == 0 and done.json["outputs"] == [str(table), str(picture)]
    plan = read_protocol("sine_tracking")
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == done.json["samples"] == len(plan.time_s)
    for name in ("time_s", "pressure_MPa", "reference_deg"):
        written = np.array([float(row[name] or "nan") for row in rows])
        np.testing.assert_allclose(written, getattr(plan, name), atol=1e-7)
    assert [int(row["step"]) - 1 for row in rows] == plan.step.tolist()
    assert rows[0]["event"] == "trigger: camera; mark: approach" and rows[1000]["event"] == "mark: sine"
    assert cv2.imread(str(picture)).shape[1] == 1350
    again = benchlab("protocol", "show", "sine_tracking", "--out", picture)
    assert again.code == 2 and "--overwrite" in again.err
    assert benchlab("protocol", "show", "sine_tracking", "--out", picture, "--overwrite").code == 0


def test_the_last_folder_of_out_is_made_as_by_every_command(benchlab: Callable, tmp_path: Path) -> None:
    for index, words in enumerate((("protocol", "show", "linear_ramp", "--out"), ("cut", "tw3_slw10", "--out"))):
        out = tmp_path / f"results{index}" / f"a{('.png', '.svg')[index]}"
        done = benchlab(*words, out)
        assert done.code == 0 and out.exists(), done.err
        deep = benchlab(*words, tmp_path / "none" / "of" / out.name)
        assert deep.code == 2 and "none: no such folder" in deep.err


def test_steps_alone_are_told_as_fast_and_a_pressure_above_the_twins_is_told(
    benchlab: Callable, tmp_path: Path
) -> None:
    shown = benchlab("protocol", "show", "blocked_force_steps").out
    assert "\n  50 rises of up to 0.35 MPa and 50 falls of up to 0.35 MPa at once, as fast as the bench can\n" in shown
    assert "slew at most" not in shown
    high = tmp_path / "high.yaml"
    high.write_text("title: high\nlimit_MPa: 0.6\nsegments:\n  - ramp: {to_MPa: 0.36, duration_s: 2}\n")
    shown = benchlab("protocol", "show", high).out
    assert "not checked against a bench" in shown and "too high for the twin, which takes up to 0.35 MPa" in shown
    strong = tmp_path / "strong.yaml"
    write_bench(
        strong,
        Bench("strong", limit_MPa=0.4, limit_reason="a test", calibrated=True, gauge="a gauge", date="2026-01-01"),
    )
    shown = benchlab("protocol", "show", high, "--calibration", strong).out
    assert "checked against bench strong: fits, up to 0.4 MPa" in shown and "twin" not in shown


def test_json_says_all_of_the_plan(benchlab: Callable) -> None:
    found = benchlab("protocol", "show", "blocked_force_steps", "--rate-Hz", 50, "--json").json
    assert found["samples"] == 10151 and found["rate_Hz"] == 50 and found["peak_MPa"] == 0.35
    assert found["jumps"]["rises"] == 50 and len(found["steps"]) == 101 and found["ends_vented"]
    assert found["slew_MPa_per_s"] == 0 and not found["closed_loop"] and found["about"].startswith("The paper")


def test_list_names_them_all(benchlab: Callable) -> None:
    listed = benchlab("protocol", "list", "--json").json
    assert [one["name"] for one in listed] == list(shipped_protocols())
    shown = benchlab("protocol", "list").out
    assert all(name in shown for name in shipped_protocols())


def test_a_bad_file_is_refused_whole(benchlab: Callable, tmp_path: Path) -> None:
    (tmp_path / "bad.yaml").write_text(BAD)
    done = benchlab("protocol", "show", tmp_path / "bad.yaml", "--out", tmp_path / "bad.png", "--json")
    assert done.code == 3 and done.err.count("\n") == 1
    assert "2 things are wrong" in done.err and "write to_MPa: 0.0689" in done.err
    assert "line 5: segments[1].hold.duration_s is -1" in done.json["error"]["what"]
    assert [path.name for path in tmp_path.iterdir()] == ["bad.yaml"]


def test_a_long_protocol_is_refused_with_an_estimate_and_may_be_allowed(benchlab: Callable, tmp_path: Path) -> None:
    path = tmp_path / "long.yaml"
    path.write_text("title: long\nlimit_MPa: 0.3\nrate_Hz: 10\nsegments:\n  - vent: {duration_s: 5400}\n")
    done = benchlab("protocol", "show", path)
    assert done.code == 3 and "would last 5400 s (1 h 30 min)" in done.err and "--max-duration-s" in done.err
    assert benchlab("protocol", "show", path, "--max-duration-s", 6000).code == 0


def test_a_bench_that_may_not_be_asked_for_it_is_named(benchlab: Callable, tmp_path: Path) -> None:
    write_bench(
        tmp_path / "weak.yaml", Bench("weak", limit_MPa=0.2, calibrated=True, gauge="a gauge", date="2026-01-01")
    )
    done = benchlab("protocol", "show", "linear_ramp", "--calibration", tmp_path / "weak.yaml")
    assert done.code == 3
    assert (
        "linear_ramp.yaml, line 9, step 1 (ramp 0 to 0.35 MPa in 2.5 s): asks for 0.35 MPa, above 0.2 MPa" in done.err
    )
    blind = benchlab("protocol", "show", "sine_tracking", "--calibration", tmp_path / "weak.yaml")
    assert blind.code == 3 and "flex sensor of bench weak is not calibrated" in blind.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["show", "linear_ramp", "--out", "plan.pdf"], "neither a .png nor a .csv"),
        (["show", "linear_ramp", "--out", "a.png", "--out", "a.png"], "named twice"),
        (["show", "nothing"], "one of blocked_force_steps"),
        (["show", "liner_ramp"], "did you mean linear_ramp?"),
        (["show", "linear_ramp.yml"], "did you mean linear_ramp?"),
        (["show", "linear_ramp", "--max-duration-s", "nan"], "finite"),
        (["show", "linear_ramp", "--rate-Hz", "1000"], "give 1 to 500"),
        (["show"], "PROTOCOL"),
    ],
)
def test_usage(
    arguments: list[str], words: str, benchlab: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = benchlab("protocol", *arguments)
    assert done.code == 2 and words in done.err and not list(tmp_path.iterdir())


def test_a_wheel_brings_the_protocols(tmp_path: Path) -> None:
    source = tmp_path / "source"
    for part in ("benchlab", "protocols"):
        shutil.copytree(ROOT / part, source / part, ignore=shutil.ignore_patterns("__pycache__"))
    for part in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / part, source)
    command = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", str(tmp_path), str(source)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if "No matching distribution found for setuptools" in done.stderr + done.stdout:
        pytest.skip("no package index in reach: the wheel is not built")
    assert done.returncode == 0, done.stderr
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as packed:
        packed.extractall(tmp_path / "installed")
    code = "from benchlab.io.protocol_file import *; print(*shipped_protocols().values()); print(read_protocol('linear_ramp').title)"
    told = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path / "installed")},
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    folder = tmp_path / "installed" / "benchlab" / "protocols"
    assert [Path(path) for path in told[0].split()] == [folder / f"{name}.yaml" for name in shipped_protocols()]
    assert told[1] == "Linear ramp"
