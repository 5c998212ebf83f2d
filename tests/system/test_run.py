"""`benchlab run` from end to end: on the twin, on the emulated firmware, in replay, and what it leaves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchlab.io.design_file import read_design
from benchlab.io.drive_file import read_drive_file
from benchlab.io.journal import read_journal
from benchlab.io.protocol_file import read_protocol, shipped_protocols
from benchlab.io.response_file import CURVES
from benchlab.workflows.run_curve import simulated_curve
from tests.system.runs import LOOP, SHORT, driven, left
from tests.unit.devices.nano import needs_emulator


@pytest.mark.parametrize("name", sorted(shipped_protocols()))
def test_each_shipped_protocol_runs_to_its_end_on_the_twin(tmp_path: Path, name: str) -> None:
    end, plan = driven(tmp_path, name).end, read_protocol(name)
    assert (end.reason, end.vented, end.ticks) == ("completed", True, len(plan.time_s)), end.cause
    journal = read_journal(tmp_path / "a.journal")
    assert journal.driven["tick"].tolist() == list(range(len(plan.time_s)))
    open_loop = np.isfinite(plan.pressure_MPa)
    assert np.array_equal(journal.driven["command_MPa"][open_loop], plan.pressure_MPa[open_loop])
    assert journal.samples["command_MPa"].max() <= 0.35
    marks = [e for e in journal.events if e["kind"] in ("mark", "trigger")]
    assert [(e["kind"], e["text"]) for e in marks] == [(e.kind, e.text) for e in plan.events]
    assert journal.stop and journal.stop["vented"]


def test_the_command_says_how_it_ended_and_what_it_wrote(tmp_path: Path, benchlab: Any) -> None:
    (tmp_path / "a.yaml").write_text("not one of ours")
    done = benchlab("run", "linear_ramp", "--fast", "--out", tmp_path, "--name", "a", "--json")
    found = done.json
    (tmp_path / "a.yaml").unlink()
    assert done.code == 0 and (found["reason"], found["vented"], found["exit_code"]) == ("completed", True, 0), done.err
    assert found["ticks"] == found["ticks_planned"] == 501 and found["late_ms"] is None and found["warnings"] == []
    assert left(tmp_path) == ["a.csv", "a.h5", "a.journal", "a.png", "a.truth.csv"]
    assert sorted(Path(path).name for path in found["outputs"]) == left(tmp_path)
    assert "completed: to the end of the plan" in done.err and "in virtual time; vented" in done.err
    assert "error" not in found


def test_the_head_tells_all_that_is_needed_to_run_it_again(tmp_path: Path, short: Path, benchlab: Any) -> None:
    words = ("--fast", "--seed", 7, "--guard", "follow_MPa=0.02", "--guard", "bend_s=off", "--out", tmp_path / "new")
    assert benchlab("run", short, *words, "--name", "a", "--quiet").code == 0
    head = read_drive_file(tmp_path / "new" / "a.h5").header
    assert head["protocol"]["text"] == SHORT and head["protocol"]["name"] == "short"
    assert head["plan"]["ticks"] == 801 and [s["kind"] for s in head["plan"]["steps"]] == ["ramp", "hold", "vent"]
    assert head["bench"]["regulator"]["gain"] == pytest.approx(0.096) and head["bench_kind"] == "twin"
    assert head["seed"] == 7 and head["device"]["seed"] == 7 and head["device"]["simulated"]
    assert head["guards"]["follow_MPa"] == 0.02 and head["guards"]["bend_s"] is None  # off
    assert head["clock"] == "virtual" and head["curve"]["angle_deg"][0] == pytest.approx(0, abs=1e-4)
    assert set(head["provenance"]) == {"argv", "created", "git", "versions"}


def test_the_same_seed_gives_the_same_run_and_another_another(tmp_path: Path, short: Path, benchlab: Any) -> None:
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        assert benchlab("run", short, "--fast", "--seed", seed, "--out", tmp_path, "--name", name).code == 0
    a, b, c = (read_journal(tmp_path / f"{name}.journal").samples for name in "abc")
    assert a.tobytes() == b.tobytes() != c.tobytes()


def test_a_design_bends_the_twin_as_it_is_simulated(tmp_path: Path, short: Path, benchlab: Any) -> None:
    done = benchlab("run", short, "--fast", "--design", "tw3_slw20", "--out", tmp_path, "--name", "a")
    assert done.code == 0, done.err
    angle = read_journal(tmp_path / "a.journal").samples["angle_deg"]
    curve = simulated_curve(read_design("tw3_slw20"))
    at_rest = np.interp(0.3, curve.pressure_MPa, curve.angle_deg)  # 50°, where the shipped twin has 108°
    assert angle.max() == pytest.approx(at_rest, rel=0.15)  # its effects are on
    table = np.column_stack([curve.pressure_MPa, curve.angle_deg, curve.volume_mL, curve.axial_stretch])
    rows = [f"{p:.9g},{a:.9g},0,{s:.9g},{v:.9g},0,0" for p, a, v, s in table]
    (tmp_path / "c.csv").write_text("\n".join([",".join(CURVES), *rows]))
    done = benchlab("run", short, "--fast", "--curve", tmp_path / "c.csv", "--out", tmp_path, "--name", "b")
    assert done.code == 0, done.err
    assert read_journal(tmp_path / "b.journal").samples["angle_deg"].max() == pytest.approx(angle.max(), abs=0.1)


def test_a_closed_loop_reaches_its_angle(tmp_path: Path, benchlab: Any) -> None:
    (tmp_path / "loop.yaml").write_text(LOOP)
    done = benchlab("run", tmp_path / "loop.yaml", "--fast", "--out", tmp_path / "out", "--name", "a", "--json")
    assert done.code == 0, done.err
    samples = read_journal(tmp_path / "out" / "a.journal").driven
    assert samples["angle_deg"][-50:].mean() == pytest.approx(60, abs=1.0)
    assert np.isnan(samples["reference_deg"][:50]).all() and (samples["reference_deg"][100:] == 60).all()


def test_gains_come_from_a_file_too_and_their_rate_is_compared(tmp_path: Path, benchlab: Any) -> None:
    (tmp_path / "loop.yaml").write_text("\n".join(line for line in LOOP.splitlines() if "control:" not in line))
    gains = "from: by hand\nrate_Hz: 50\ngains: {kp_MPa_per_deg: 0.0005, ki_MPa_per_deg_s: 0.01}\nfeed_forward: true\n"
    (tmp_path / "gains.yaml").write_text(gains)
    words = ("--fast", "--control", tmp_path / "gains.yaml", "--out", tmp_path, "--json")
    done = benchlab("run", tmp_path / "loop.yaml", *words, "--name", "a")
    assert done.code == 0 and "the gains are for 50 Hz, and the plan runs at 100 Hz" in done.err
    journal = read_journal(tmp_path / "a.journal")
    assert journal.driven["angle_deg"][-50:].mean() == pytest.approx(60, abs=0.5)
    assert journal.header["control"]["feed_forward"] is True and journal.header["control"]["ki_MPa_per_deg_s"] == 0.01
    done = benchlab("run", "linear_ramp", *words, "--name", "b")
    assert done.code == 0 and "--control is not used: no step is closed-loop" in done.err


@pytest.mark.parametrize("kind", ["a.journal", "a.h5"])
def test_a_replay_goes_the_same_way_and_fails_at_the_first_difference(
    tmp_path: Path, short: Path, benchlab: Any, kind: str
) -> None:
    assert benchlab("run", short, "--fast", "--out", tmp_path, "--name", "a").code == 0
    replay = ("--bench", f"replay:{tmp_path / kind}", "--out", tmp_path, "--json")
    done = benchlab("run", short, *replay, "--name", "b")
    assert done.code == 0, done.err
    a, b = (read_journal(tmp_path / f"{name}.journal").samples for name in "ab")
    for field in ("tick", "command_MPa", "pressure_MPa", "flex_V", "angle_deg", "status"):
        assert np.array_equal(a[field], b[field]), field
    short.write_text(SHORT.replace("to_MPa: 0.3", "to_MPa: 0.301"))
    done = benchlab("run", short, *replay, "--name", "c")
    assert done.code == 5 and done.json["reason"] == "refused" and "tick 1 differs from the recording" in done.err
    assert done.json["ticks"] == 1


def test_a_replayed_loop_asks_for_the_same_pressures(tmp_path: Path, benchlab: Any) -> None:
    (tmp_path / "loop.yaml").write_text(LOOP)
    assert benchlab("run", tmp_path / "loop.yaml", "--fast", "--out", tmp_path, "--name", "a").code == 0
    replay = ("--bench", f"replay:{tmp_path / 'a.journal'}", "--out", tmp_path)
    done = benchlab("run", tmp_path / "loop.yaml", *replay, "--name", "b")
    assert done.code == 0, done.err
    (tmp_path / "loop.yaml").write_text(LOOP.replace("0.0005", "0.0006"))
    assert "differs from the recording" in benchlab("run", tmp_path / "loop.yaml", *replay, "--name", "c").err


@needs_emulator
def test_the_firmware_itself_runs_a_protocol(tmp_path: Path, short: Path, benchlab: Any) -> None:
    done = benchlab("run", short, "--bench", "emulated", "--fast", "--out", tmp_path, "--name", "a", "--json")
    assert done.code == 0, done.err
    journal = read_journal(tmp_path / "a.journal")
    assert len(journal.driven) == 801 and journal.header["device"]["firmware"]
    assert journal.samples["code"].max() > 2500 and journal.samples["code"][-1] == 0
    assert 0.29 < np.nanmax(journal.samples["pressure_MPa"]) < 0.36  # its regulator, monitor and actuator live
    assert 90 < np.nanmax(journal.samples["angle_deg"]) < 115


def test_a_film_of_the_twin_is_drawn_when_asked_for(tmp_path: Path, benchlab: Any) -> None:
    (tmp_path / "tiny.yaml").write_text(
        "title: Tiny\nlimit_MPa: 0.35\nsegments:\n  - ramp: {to_MPa: 0.1, duration_s: 0.3}\n"
    )
    done = benchlab("run", tmp_path / "tiny.yaml", "--fast", "--video", "--out", tmp_path, "--name", "a", "--json")
    assert done.code == 0, done.err
    assert str(tmp_path / "a.film.mp4") in done.json["outputs"] and (tmp_path / "a.film.mp4").stat().st_size > 1000
