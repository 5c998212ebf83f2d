"""`benchlab run` from end to end: on the twin, on the emulated firmware, on what it leaves and on what it refuses."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchlab.devices.interface import Reading, Status
from benchlab.io.design_file import read_design
from benchlab.io.drive_file import read_drive_file
from benchlab.io.journal import read_journal
from benchlab.io.protocol_file import read_protocol, shipped_protocols
from benchlab.io.response_file import CURVES
from benchlab.runner.stop import QUIT, Stop
from benchlab.twin.effects.catalogue import EFFECTS
from benchlab.twin.effects.catalogue import FAULTS as FAULTS_OF_TWIN
from benchlab.workflows import run as run_workflow
from benchlab.workflows import run_prepare
from benchlab.workflows.open_bench import Spec, twin_of
from benchlab.workflows.run import Driven
from benchlab.workflows.run_curve import simulated_curve
from benchlab.workflows.run_files import written
from benchlab.workflows.run_prepare import RunSettings
from tests.unit.devices.nano import needs_emulator

SHORT = """\
title: Short
limit_MPa: 0.35
segments:
  - trigger: camera
  - ramp: {to_MPa: 0.3, duration_s: 1}
  - mark: top
  - hold: {duration_s: 3}
  - vent: {duration_s: 4}
"""

LOOP = """\
title: Loop
limit_MPa: 0.35
control: {kp_MPa_per_deg: 0.0005, ki_MPa_per_deg_s: 0.01}
segments:
  - vent: {duration_s: 0.5}
  - curvature: {hold: {angle_deg: 60, duration_s: 4}}
"""


@pytest.fixture
def short(tmp_path: Path) -> Path:
    path = tmp_path / "short.yaml"
    path.write_text(SHORT)
    return path


def left(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir()) if folder.exists() else []


def driven(folder: Path, protocol: str, **settings: Any) -> Driven:
    """A run up to its journal `a.journal`, without the files that are made of it."""
    prepared = run_prepare.prepare(protocol, RunSettings(out=folder, name="a", fast=True, **settings))
    return run_workflow.drive(prepared, Stop())


@pytest.mark.parametrize("name", sorted(shipped_protocols()))
def test_each_shipped_protocol_runs_to_its_end_on_the_twin(tmp_path: Path, name: str) -> None:
    end, plan = driven(tmp_path, name).end, read_protocol(name)
    assert (end.reason, end.vented, end.ticks) == ("completed", True, len(plan.time_s)), end.cause
    journal = read_journal(tmp_path / "a.journal")
    assert journal.samples["tick"].tolist() == list(range(len(plan.time_s)))
    open_loop = np.isfinite(plan.pressure_MPa)
    assert np.array_equal(journal.samples["command_MPa"][open_loop], plan.pressure_MPa[open_loop])
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


@pytest.mark.parametrize("name", ["linear_ramp", "multi_rate_loading", "repeatability", "sine_tracking"])
def test_no_guard_stops_a_healthy_twin_with_every_effect_on(tmp_path: Path, name: str) -> None:
    twin = tmp_path / "twin.yaml"
    twin.write_text("effects:\n" + "".join(f"  {effect}: on\n" for effect in EFFECTS if effect not in FAULTS_OF_TWIN))
    end = driven(tmp_path, name, bench=f"twin:{twin}").end
    assert end.completed, end.cause


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
    samples = read_journal(tmp_path / "out" / "a.journal").samples
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
    assert journal.samples["angle_deg"][-50:].mean() == pytest.approx(60, abs=0.5)
    assert journal.header["control"]["feed_forward"] is True and journal.header["control"]["ki_MPa_per_deg_s"] == 0.01
    done = benchlab("run", "linear_ramp", *words, "--name", "b")
    assert done.code == 0 and "--control is not used: no step is closed-loop" in done.err


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
    assert len(benchlab(*words, "--bench", "twin").json["guards"]) == 7


REFUSED = [
    (["high.yaml"], 3, "line 5: ramp 0 to 0.36 MPa in 1 s reaches 0.36 MPa"),
    (["above.yaml", "--bench", "serial:/dev/nowhere"], 3, "the ceiling of bench not calibrated"),
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
    (["short.yaml", "--out", "none/here"], 2, "no such folder"),
    (["short.yaml", "--out", "short.yaml"], 2, "is no folder"),
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
        patch.setattr(run_prepare.os, "access", lambda path, mode: not mode & os.W_OK and access(path, mode))
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


FAULTS = [
    ("burst: {at_s: 2}", "not following", "leak, burst or tube off", 2.5),
    ("tube_off: {at_s: 2}", "not following", "leak, burst or tube off", 2.5),
    ("supply_shut: {at_s: 0.1}", "not following", "burst, tube off, or the flex sensor came off", 2.5),
    ("supply_shut: {at_s: 2}", "not following", "PRESSURE MAY BE LEFT INSIDE", 7.0),
    ("sensor_out_of_range: {at_s: 2}", "sensor", "the flex sensor reads 5 V", 2.15),
    ("stuck_sensor: {at_s: 0.6}", "sensor", "stuck, or not connected", 2.0),
]


@pytest.mark.parametrize(("fault", "reason", "said", "before_s"), FAULTS, ids=[f"{f[0]}" for f in FAULTS])
def test_what_breaks_on_the_twin_stops_the_run_with_its_cause(
    tmp_path: Path, short: Path, benchlab: Any, fault: str, reason: str, said: str, before_s: float
) -> None:
    twin = tmp_path / "twin.yaml"
    twin.write_text(f"faults:\n  {fault}\n")
    done = benchlab("run", short, "--bench", f"twin:{twin}", "--fast", "--out", tmp_path, "--name", "a", "--json")
    found = done.json
    assert (done.code, found["reason"], found["vented"]) == (5, reason, True), done.err
    assert said in found["words"] and found["time_s"] <= before_s
    assert found["error"]["code"] == 5 and f"benchlab: {reason}: " in done.err
    journal = read_journal(tmp_path / "a.journal")
    assert journal.stop and journal.stop["reason"] == reason and len(journal.samples) == found["ticks"]
    assert (tmp_path / "a.h5").exists() and (tmp_path / "a.png").exists()


def test_a_guard_that_is_switched_off_lets_pass(tmp_path: Path, short: Path, benchlab: Any) -> None:
    twin = tmp_path / "twin.yaml"
    twin.write_text("faults:\n  stuck_sensor: {at_s: 0.1}\n")
    off = ("--guard", "stuck_s=off", "--guard", "bend_s=off")
    done = benchlab("run", short, "--bench", f"twin:{twin}", "--fast", *off, "--out", tmp_path, "--name", "a")
    assert done.code == 0, done.err


def test_a_replay_goes_the_same_way_and_fails_at_the_first_difference(
    tmp_path: Path, short: Path, benchlab: Any
) -> None:
    assert benchlab("run", short, "--fast", "--out", tmp_path, "--name", "a").code == 0
    replay = ("--bench", f"replay:{tmp_path / 'a.journal'}", "--out", tmp_path, "--json")
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
    assert len(journal.samples) == 801 and journal.header["device"]["firmware"]
    assert journal.samples["code"].max() > 2500 and journal.samples["code"][-1] == 0
    assert 0.29 < np.nanmax(journal.samples["pressure_MPa"]) < 0.36  # its regulator, monitor and actuator live
    assert 90 < np.nanmax(journal.samples["angle_deg"]) < 115


def test_a_film_of_the_twin_is_drawn_when_asked_for(tmp_path: Path, benchlab: Any) -> None:
    (tmp_path / "tiny.yaml").write_text(
        "title: Tiny\nlimit_MPa: 0.35\nsegments:\n  - ramp: {to_MPa: 0.1, duration_s: 0.3}\n"
    )
    done = benchlab("run", tmp_path / "tiny.yaml", "--fast", "--video", "--out", tmp_path, "--name", "a", "--json")
    assert done.code == 0, done.err
    assert str(tmp_path / "a.mp4") in done.json["outputs"] and (tmp_path / "a.mp4").stat().st_size > 1000


def test_results_that_cannot_be_made_leave_the_journal_and_say_how_to_make_them(
    tmp_path: Path, short: Path, benchlab: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    from benchlab.errors import InputError
    from benchlab.workflows import run_files

    def full(*_: Any, **__: Any) -> None:
        raise InputError("could not be written: no space left on device", file="a.h5")

    monkeypatch.setattr(run_files, "write_results", full)
    done = benchlab("run", short, "--fast", "--out", tmp_path, "--name", "a", "--json")
    assert done.code == 3 and done.json["reason"] == "completed" and done.json["error"]["code"] == 3
    assert "benchlab recover" in done.err and left(tmp_path) == ["a.journal", "short.yaml"]


def test_a_wish_to_stop_before_the_first_tick_arms_and_vents_and_asks_for_nothing(tmp_path: Path) -> None:
    stop = Stop()
    stop.ask(QUIT)
    prepared = run_prepare.prepare("linear_ramp", RunSettings(out=tmp_path, name="a", fast=True))
    done = run_workflow.drive(prepared, stop)
    found = written(prepared, done)
    assert (found["reason"], found["ticks"], found["exit_code"], found["vented"]) == ("quit", 0, 130, True)
    assert left(tmp_path) == ["a.journal"] and "holds no sample" in found["warnings"][-1]


@needs_emulator
def test_a_bench_that_is_unplugged_is_lost_and_its_vent_is_not_claimed(
    tmp_path: Path, short: Path, benchlab: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    from benchlab.devices.serial_bench import SerialBench

    exchange = SerialBench.exchange

    def unplugged(self: SerialBench, time_s: float, *rest: Any) -> Any:
        if time_s > 0.5:
            self._line.emulator.close()
        return exchange(self, time_s, *rest)

    monkeypatch.setattr(SerialBench, "exchange", unplugged)
    done = benchlab("run", short, "--bench", "emulated", "--out", tmp_path, "--name", "a", "--json")
    found = done.json
    assert (done.code, found["reason"], found["vented"]) == (5, "lost", False), done.err
    assert 45 <= found["ticks"] < 110 and found["time_s"] < 3
    assert "NOT CONFIRMED VENTED" in done.err and "relief valve" in done.err
    assert (tmp_path / "a.h5").exists()


def test_a_bench_of_metal_that_does_not_empty_is_told_after_a_run_that_completed(
    tmp_path: Path, benchlab: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A twin stands in for it: after the vent its monitor goes on showing 0.1 MPa."""
    from benchlab.devices.twin.bench import twin_bench
    from benchlab.devices.twin.twin import Twin
    from benchlab.workflows import bench_vent

    twin = Twin(twin_of(Spec("twin")), twin_bench())
    exchange, vented = twin.exchange, []

    def blocked(time_s: float, *rest: Any) -> Any:
        if not vented:
            return exchange(time_s, *rest)
        return Reading(0.1, 1.0, 0, time_s, Status(0))

    monkeypatch.setattr(twin, "exchange", blocked)
    monkeypatch.setattr(bench_vent, "WAIT_S", 0.2)
    monkeypatch.setattr(run_workflow, "check_zero", lambda *_: None)
    monkeypatch.setattr(run_workflow, "open_bench", lambda *_, **__: twin)
    monkeypatch.setattr(twin, "vent", lambda: vented.append(True))
    (tmp_path / "tiny.yaml").write_text(
        "title: Tiny\nlimit_MPa: 0.35\nsegments:\n  - ramp: {to_MPa: 0.1, duration_s: 0.3}\n"
    )
    done = benchlab("run", tmp_path / "tiny.yaml", "--bench", "serial:x", "--out", tmp_path, "--name", "a", "--json")
    assert done.code == 5 and done.json["reason"] == "completed", done.err
    assert "the monitor shows 100.0 kPa" in done.err and "relief valve" in done.json["error"]["what"]


def test_a_bug_is_told_as_one_after_the_bench_was_vented(
    tmp_path: Path, short: Path, benchlab: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    from benchlab.devices.twin.twin import Twin

    exchange = Twin.exchange

    def wrong(self: Twin, time_s: float, *rest: Any) -> Any:
        if time_s > 1:
            raise ZeroDivisionError("division by zero")
        return exchange(self, time_s, *rest)

    monkeypatch.setattr(Twin, "exchange", wrong)
    done = benchlab("run", short, "--fast", "--out", tmp_path, "--name", "a")
    assert done.code == 1 and "this is a bug in benchlab: ZeroDivisionError" in done.err and "vented" in done.err
    journal = read_journal(tmp_path / "a.journal")
    assert journal.stop and journal.stop["reason"] == "bug" and journal.stop["vented"] and len(journal.samples) == 101
