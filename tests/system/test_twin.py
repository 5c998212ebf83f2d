"""The twin through the command line: the closed loop to its film, its files, its faults."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from benchlab.io.angle_series import read_angle_series
from benchlab.io.journal import read_journal
from benchlab.io.twin_file import read_twin
from benchlab.twin.effects.catalogue import DEFAULT, EFFECTS, FAULTS
from benchlab.workflows.study_readings import Target, read_run
from tests.system.models import beam_model

GUIDE = (Path(__file__).resolve().parents[2] / "docs" / "twin.md").read_text(encoding="utf-8")
SMALL = "camera: {width_px: 640, height_px: 360, markers: 7}\n"
PROTOCOL = """\
title: Up and down
limit_MPa: 0.35
segments:
  - hold: {duration_s: 0.317}
  - trigger: camera
  - triangle: {low_MPa: 0, high_MPa: 0.3, rate_MPa_per_s: 0.3, cycles: 1}
"""


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "up.yaml").write_text(PROTOCOL)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_protocol_twin_film_angle(lab: Path, benchlab: Callable) -> None:
    """The closed loop, small: within 0.5° of the truth at the 95th percentile, aligned by the trigger alone."""
    (lab / "small.yaml").write_text(SMALL)
    done = benchlab("run", "up.yaml", "--bench", "twin:small.yaml", "--fast", "--video", "--name", "a", "--quiet")
    assert done.code == 0, done.err
    (trigger_s,) = [event["time_s"] for event in read_journal(lab / "a.journal").events if event["kind"] == "trigger"]
    assert trigger_s == pytest.approx(0.32)
    done = benchlab("analyze", "a.film.mp4", "--pressure", "a.h5", f"--sync={-trigger_s}", "--out", "seen")
    assert done.code == 0, done.err
    assert read_run(lab / "seen" / "a.film.h5", Target.of(0.2, 0.002)).origin == "twin"  # a study says so
    found, truth = read_angle_series(lab / "seen" / "a.film.csv"), read_angle_series(lab / "a.truth.csv")
    error = found.angle_deg - np.interp(found.time_s + trigger_s, truth.time_s, truth.angle_deg)
    assert len(error) >= 60 and truth.angle_deg.max() > 80
    assert np.quantile(np.abs(error), 0.95) <= 0.5
    late = found.angle_deg - np.interp(found.time_s + trigger_s + 1 / 30, truth.time_s, truth.angle_deg)
    assert np.quantile(np.abs(late), 0.95) > 1.5  # a frame off would be seen


def test_everything_of_a_twin_says_so(lab: Path, benchlab: Callable) -> None:
    assert benchlab("run", "up.yaml", "--bench", "twin", "--fast", "--name", "a", "--quiet").code == 0
    assert (lab / "a.truth.csv").read_text().startswith("# simulated, not measured")
    header = read_journal(lab / "a.journal").header
    assert header["device"]["simulated"] is True and header["device"]["seed"] == 1
    assert header["device"]["effects"]["friction"] == {"half_width_deg": 0.1, "half_width_deg_per_MPa": 4}


def test_the_same_seed_gives_the_same_run(lab: Path, benchlab: Callable) -> None:
    for name, seed in (("a", 4), ("b", 4), ("c", 5)):
        assert (
            benchlab("run", "up.yaml", "--bench", "twin", "--fast", "--seed", seed, "--name", name, "--quiet").code == 0
        )
    columns = ("pressure_MPa", "flex_V", "code", "device_time_s")
    one, same, other = ([read_journal(lab / f"{n}.journal").samples[c].tolist() for c in columns] for n in "abc")
    assert one == same and one != other


@pytest.mark.parametrize(
    ("fault", "words"),
    [("burst", "follow"), ("tube_off", "follow"), ("sensor_out_of_range", "sensor"), ("stuck_sensor", "sensor")],
)
def test_faults_stop_the_run_and_are_told(lab: Path, benchlab: Callable, fault: str, words: str) -> None:
    (lab / "bad.yaml").write_text(f"faults:\n  {fault}: {{at_s: 1}}\n")
    (lab / "long.yaml").write_text(
        "title: Long\nlimit_MPa: 0.35\nsegments:\n  - ramp: {to_MPa: 0.3, duration_s: 0.9}\n  - hold: {duration_s: 1}\n"
        "  - ramp: {to_MPa: 0.15, duration_s: 1}\n  - hold: {duration_s: 3}\n"
    )
    done = benchlab("run", "long.yaml", "--bench", "twin:bad.yaml", "--fast", "--name", "a", "--json")
    assert done.code == 5, done.out + done.err
    assert words in done.json["error"]["what"] and done.json["vented"]
    assert fault in json.dumps(read_journal(lab / "a.journal").header["device"]["effects"])


def test_a_curve_that_ends_early_is_a_lower_limit(lab: Path, benchlab: Callable) -> None:
    assert benchlab("simulate", "--design", "tw9_slw10", "--pressure-MPa", "0:0.2:0.1", "--name", "short").code == 0
    (lab / "short.yaml").write_text("curve: short.h5\n")
    done = benchlab("run", "up.yaml", "--bench", "twin:short.yaml", "--fast", "--name", "a")
    assert done.code in (3, 5) and "0.2 MPa" in done.err and not list(lab.glob("a.*"))


def test_the_guide_has_every_effect_with_its_numbers(tmp_path: Path) -> None:
    rows = {row.split("`")[1]: row for row in re.findall(r"^\| `[a-z_]+` \|.*$", GUIDE, re.MULTILINE)}
    assert list(rows) == [name for name in rows if name in EFFECTS]
    assert set(rows) == set(EFFECTS) - set(FAULTS) and all(f"`{name}`" in GUIDE for name in FAULTS)
    for name, row in rows.items():
        assert row.rstrip().endswith("| on |" if name in DEFAULT else "| off |")
        for parameter, value in vars(EFFECTS[name]()).items():
            assert re.search(rf"`{parameter}` {value:g}\b", row), (name, parameter)
    (text,) = re.findall(r"```yaml\n(.*?)```", GUIDE, re.DOTALL)
    (tmp_path / "own.yaml").write_text(text.replace("curve: tw9_slw10.h5", "design: a"))
    twin = read_twin(tmp_path / "own.yaml")
    assert twin.effects["burst"] == EFFECTS["burst"](at_s=3.0) and "viscoelasticity" not in twin.effects


def test_a_twin_of_a_model_has_its_curve_and_its_effects(
    lab: Path, benchlab: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("BENCHLAB_CACHE", str(lab / "kept"))
    beam_model(lab / "found.yaml", window_ballooning={"share": 1.0}, regulator_lag={"lag_s": 0.05}, friction={})
    (lab / "own.yaml").write_text("model: found.yaml\ndesign: tw5_slw10\neffects: {friction: off}\nseed: 3\n")
    for name, options in (
        ("a", ("--bench", "twin", "--model", "found.yaml", "--design", "tw5_slw10")),
        ("b", ("--bench", "twin:own.yaml")),
    ):
        done = benchlab("run", "up.yaml", *options, "--fast", "--name", name, "--quiet")
        assert done.code == 0, done.err
        assert ("friction" in done.err) == (name == "a")
    first, second = (read_journal(lab / f"{name}.journal").header for name in "ab")
    assert first["model"]["file"] == "found.yaml" == second["model"]["file"]
    assert set(first["device"]["effects"]) == {"dac_steps", "regulator_lag", "friction", "sensor_noise"}
    assert set(second["device"]["effects"]) == {"dac_steps", "regulator_lag", "sensor_noise"}
    assert first["device"]["effects"]["regulator_lag"] == {"lag_s": 0.05, "deadband_MPa": 0.0}
    assert first["device"]["curve"] == second["device"]["curve"] and second["seed"] == 3
    assert "window_ballooning" in first["device"]["curve"]["source"] and first["device"]["length_mm"] == 180
    for text, what in (
        ("model: found.yaml\ncurve: tw3_slw10\n", "a model has its own"),
        ("model: none.yaml\n", "no such file"),
    ):
        (lab / "own.yaml").write_text(text)
        refused = benchlab("run", "up.yaml", "--bench", "twin:own.yaml", "--fast", "--name", "c")
        assert refused.code in (2, 3) and what in refused.err
    (lab / "own.yaml").write_text("model: found.yaml\n")
    two = benchlab("run", "up.yaml", "--bench", "twin:own.yaml", "--model", "found.yaml", "--fast", "--name", "c")
    assert two.code == 2 and "are two" in two.err
