"""What a run says of its control, and what it refuses, stops or warns of: gains, feed-forward, curves, reach, the flex line."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchlab.control.tuning import Lag, tune
from benchlab.io.control_file import control_of_tuning, write_control
from benchlab.io.drive_file import read_drive_file
from benchlab.io.twin_file import read_twin

LOOP = """\
title: Loop
limit_MPa: 0.35
control: {{kp_MPa_per_deg: 0.0016, ki_MPa_per_deg_s: 0.032{more}}}
segments:
  - curvature: {{ramp: {{to_deg: {to_deg}, duration_s: 4}}}}
"""
COLUMNS = "pressure_MPa,angle_deg,curvature_per_mm,axial_stretch,volume_mL,moment_Nmm,blocked_force_N"
CURVE = COLUMNS + "\n0,0,0,1,20,0,0\n0.1,{0},0,1,21,0,0\n0.2,{1},0,1,22,0,0\n0.35,{2},0,1,23,0,0\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name, to_deg, more in (
        ("loop", 60, ""),
        ("far", 300, ""),
        ("forward", 60, ", feed_forward: true"),
        ("far_forward", 100, ", feed_forward: true"),
    ):
        Path(f"{name}.yaml").write_text(LOOP.format(to_deg=to_deg, more=more))
    Path("hand.yaml").write_text("from: by hand\nrate_Hz: 100\ngains: {kp_MPa_per_deg: 0.8, ki_MPa_per_deg_s: 0.01}\n")
    Path("stiff.csv").write_text(CURVE.format(30, 55, 80))
    Path("soft.csv").write_text(CURVE.format(45, 80, 120))
    return tmp_path


def tuned(path: Path, factor: float) -> None:
    """A control file with its plant, whose gains were multiplied afterwards by hand."""
    plants = [Lag(500.0, 0.06, 0.02), Lag(250.0, 0.09, 0.02)]
    found = control_of_tuning(
        tune(plants, 100.0), [0.05, 0.3], plants, feed_forward=False, rate_Hz=100.0, source="a.h5"
    )
    write_control(path, replace(found, kp_MPa_per_deg=factor * found.kp_MPa_per_deg))


def test_gains_that_swing_on_the_plant_of_their_file_are_refused_and_near_that_told(folder: Path, benchlab) -> None:
    for factor, code in ((1, 0), (2.5, 0), (100, 3)):
        tuned(folder / f"c{factor}.yaml", factor)
        done = benchlab("run", "loop.yaml", "--fast", "--dry-run", "--control", f"c{factor}.yaml", "--json")
        assert done.code == code, done.err
        assert ("the loop will swing" in done.err) == (factor == 2.5)
    assert "c100.yaml" in done.err and "would oscillate" in done.err and "0.05 MPa" in done.err
    slow = benchlab("run", "loop.yaml", "--fast", "--dry-run", "--control", "c1.yaml", "--rate-Hz", "10")
    assert slow.code == 3 and "at 10 Hz" in slow.err  # the loop's own dead time is ten times as long


def test_gains_that_swing_stop_the_run(folder: Path, benchlab) -> None:
    done = benchlab("run", "loop.yaml", "--fast", "--control", "hand.yaml", "--name", "a", "--json")
    assert done.code == 5 and done.json["reason"] == "oscillating" and done.json["time_s"] < 2
    assert "the loop oscillates" in done.err and done.json["vented"]


def test_a_reference_that_the_curve_does_not_reach_is_told_and_by_feed_forward_refused(folder: Path, benchlab) -> None:
    dry = ("run", "--fast", "--dry-run", "--curve", "stiff.csv", "--json")
    told = benchlab(*dry, "far.yaml")
    assert told.code == 0 and len(told.json["warnings"]) == 1
    assert "goes to 300°, and the curve (stiff.csv) reaches 80.0° at 0.35 MPa" in told.json["warnings"][0]
    refused = benchlab(*dry, "far_forward.yaml")
    assert refused.code == 3 and "goes to 100°" in refused.err and "feed_forward: false" in refused.err
    assert benchlab(*dry, "loop.yaml").json["warnings"] == []


def test_it_is_said_which_gains_run_from_where_and_by_which_curve(folder: Path, benchlab) -> None:
    plain = benchlab("run", "loop.yaml", "--fast", "--dry-run", "--json")
    assert plain.json["control"]["from"] == "the protocol" and plain.json["control"]["curve"] is None
    assert "control: PI of the protocol: kp 0.0016 MPa/°, ki 0.032 MPa/(°·s); no feed-forward" in plain.err
    own = benchlab("run", "forward.yaml", "--fast", "--dry-run", "--json")
    assert "feed-forward by the curve tw3_slw10, simulated (benchlab/curves), lead 0 s" in own.err
    tuned(folder / "c.yaml", 1)
    done = benchlab("run", "forward.yaml", "--fast", "--control", "c.yaml", "--name", "a", "--json")
    assert done.code == 0 and "control: PI of c.yaml (a.h5)" in done.err.splitlines()[0]
    header = read_drive_file(folder / "a.h5").header["control"]
    assert header == done.json["control"] and header["from"] == "c.yaml (a.h5)" and header["feed_forward"] is False


def test_what_is_believed_of_an_actuator_does_not_replace_the_curve_of_a_twin(folder: Path, benchlab) -> None:
    """The twin bends by its own curve, and feed-forward goes by another; the twin that has none bends by what is given."""
    Path("twin.yaml").write_text("curve: stiff.csv\n")
    Path("effects.yaml").write_text("effects: {softening: on}\n")
    Path("ramp.yaml").write_text("title: R\nlimit_MPa: 0.35\nsegments: [{ramp: {to_MPa: 0.2, duration_s: 2}}]\n")
    reached = {}
    for name, bench in (
        ("own", "twin:twin.yaml"),
        ("file", "twin:stiff.csv"),
        ("none", "twin"),
        ("same", "twin:effects.yaml"),
    ):
        done = benchlab("run", "ramp.yaml", "--fast", "--bench", bench, "--curve", "soft.csv", "--name", name, "--json")
        assert done.code == 0, done.err
        reached[name] = float(np.nanmax(read_drive_file(folder / f"{name}.h5").samples["angle_deg"]))
        words = "controller and guards go by the curve soft.csv; the twin bends by its own, stiff.csv"
        assert (words in done.json["warnings"]) == (name in ("own", "file")), name
    assert max(reached["own"], reached["file"]) < 60 < min(reached["none"], reached["same"])
    wrong = ("run", "forward.yaml", "--fast", "--bench", "twin:twin.yaml", "--curve", "soft.csv")
    done = benchlab(*wrong, "--name", "ff", "--json")
    assert done.code == 0 and done.json["control"]["curve"] == "soft.csv"
    samples = read_drive_file(folder / "ff.h5").samples
    assert np.nanmax(np.abs(samples["angle_deg"] - samples["reference_deg"])[100:]) < 12


def test_the_shipped_curve_is_a_twins_own_by_name(folder: Path) -> None:
    Path("own.yaml").write_text("curve: tw3_slw10\n")
    own, shipped = read_twin(folder / "own.yaml"), read_twin(None)
    assert own.own_curve and not shipped.own_curve and own.design == shipped.design
    assert np.array_equal(own.curve.angle_deg, shipped.curve.angle_deg)


@pytest.mark.parametrize("protocol", ["loop.yaml", "linear_ramp"])
def test_a_wrong_offset_of_the_flex_line_stops_a_run_before_any_pressure(folder: Path, benchlab, protocol: str) -> None:
    assert benchlab("bench", "calibrate", "--bench", "twin", "--gauge", "twin", "--out", "wrong.yaml").code == 0
    with Path("wrong.yaml").open("a") as file:  # 66.7 instead of −66.7
        file.write("flex: {gain_deg_per_V: 66.667, offset_deg: 66.667, sd_deg: 0.1, from: by hand}\n")
    done = benchlab("run", protocol, "--fast", "--calibration", "wrong.yaml", "--name", "a", "--json")
    assert done.code == 5 and done.json["reason"] == "sensor" and done.json["ticks"] <= 5
    assert "reads 133." in done.err and "offset_deg" in done.err and json.dumps(done.json)
    assert read_drive_file(folder / "a.h5").samples["command_MPa"].max() < 0.006
