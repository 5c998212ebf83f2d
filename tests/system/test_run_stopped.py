"""What stops a run, with its cause, and what does not; what is left of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from benchlab.devices.interface import Reading, Status
from benchlab.io.journal import read_journal
from benchlab.runner.stop import QUIT, Stop
from benchlab.twin.effects.catalogue import EFFECTS
from benchlab.twin.effects.catalogue import FAULTS as FAULTS_OF_TWIN
from benchlab.workflows import run as run_workflow
from benchlab.workflows import run_prepare
from benchlab.workflows.open_bench import Spec, twin_of
from benchlab.workflows.run_files import written
from benchlab.workflows.run_prepare import RunSettings
from tests.system.runs import driven, left
from tests.unit.devices.nano import needs_emulator


@pytest.mark.parametrize("name", ["linear_ramp", "multi_rate_loading", "repeatability", "sine_tracking"])
def test_no_guard_stops_a_healthy_twin_with_every_effect_on(tmp_path: Path, name: str) -> None:
    twin = tmp_path / "twin.yaml"
    twin.write_text("effects:\n" + "".join(f"  {effect}: on\n" for effect in EFFECTS if effect not in FAULTS_OF_TWIN))
    end = driven(tmp_path, name, bench=f"twin:{twin}").end
    assert end.completed, end.cause


FAULTS = [
    ("burst: {at_s: 2}", "not following", "leak, burst or tube off", 2.5),
    ("tube_off: {at_s: 2}", "not following", "leak, burst or tube off", 2.5),
    ("supply_shut: {at_s: 0.1}", "not following", "burst, tube off, the flex sensor came off", 2.5),
    ("supply_shut: {at_s: 2}", "not following", "exhaust blocked, tube kinked or a valve shut", 7.0),
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
    assert journal.stop and journal.stop["reason"] == reason and len(journal.driven) == found["ticks"]
    assert (tmp_path / "a.h5").exists() and (tmp_path / "a.png").exists()


def test_a_guard_that_is_switched_off_lets_pass(tmp_path: Path, short: Path, benchlab: Any) -> None:
    twin = tmp_path / "twin.yaml"
    twin.write_text("faults:\n  stuck_sensor: {at_s: 0.1}\n")
    off = ("--guard", "stuck_s=off", "--guard", "bend_s=off")
    done = benchlab("run", short, "--bench", f"twin:{twin}", "--fast", *off, "--out", tmp_path, "--name", "a")
    assert done.code == 0, done.err


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

    twin = Twin(twin_of(Spec("twin")), twin_bench())
    exchange, vented = twin.exchange, []

    def blocked(time_s: float, *rest: Any) -> Any:
        if not vented:
            return exchange(time_s, *rest)
        return Reading(0.1, 1.0, 0, time_s, Status(0))

    monkeypatch.setattr(twin, "exchange", blocked)
    monkeypatch.setattr(run_workflow, "check_zero", lambda *_: None)
    monkeypatch.setattr(run_workflow, "open_bench", lambda *_, **__: twin)
    monkeypatch.setattr(twin, "vent", lambda: vented.append(True))
    soon = ("--guard", "empty_s=0.3")
    (tmp_path / "tiny.yaml").write_text(
        "title: Tiny\nlimit_MPa: 0.35\nsegments:\n  - ramp: {to_MPa: 0.1, duration_s: 0.3}\n"
    )
    done = benchlab(
        "run", tmp_path / "tiny.yaml", "--bench", "serial:x", *soon, "--out", tmp_path, "--name", "a", "--json"
    )
    assert done.code == 5 and (done.json["reason"], done.json["empty"]) == ("not empty", False), done.err
    assert "the monitor shows 100.0 kPa" in done.err and "exhaust blocked" in done.json["error"]["what"]


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
    assert journal.stop and journal.stop["reason"] == "bug" and journal.stop["vented"] and len(journal.driven) == 101


@pytest.mark.parametrize("at_s", [0.9, 1.5, 2.6])
def test_air_locked_in_the_actuator_is_a_failure_of_a_shipped_protocol(
    tmp_path: Path, benchlab: Any, at_s: float
) -> None:
    twin = tmp_path / "twin.yaml"
    twin.write_text(f"faults:\n  supply_shut: {{at_s: {at_s}}}\n")
    words = ("--bench", f"twin:{twin}", "--fast", "--guard", "follow_s=off", "--guard", "bend_s=off")
    done = benchlab("run", "linear_ramp", *words, "--out", tmp_path, "--name", "a", "--json")
    found = done.json
    assert (done.code, found["reason"], found["vented"], found["empty"]) == (5, "not empty", True, False), done.err
    assert "PRESSURE MAY BE LEFT INSIDE" in done.err and "not watched: a pressure that does not follow" in done.err
    assert found["guards_off"] == ["follow_s", "bend_s"] and "; vented\n" not in done.err
    journal = read_journal(tmp_path / "a.journal")
    assert journal.header["guards_off"] == ["follow_s", "bend_s"]
    assert len(journal.samples) - len(journal.driven) == found["samples_watched"] == 301
    assert benchlab("recover", tmp_path / "a.journal", "--out", tmp_path / "again", "--json").json["ticks"] == 501


def test_a_stop_at_the_top_has_the_fall_of_the_pressure_in_its_journal_and_replays(
    tmp_path: Path, benchlab: Any
) -> None:
    stop = Stop()
    prepared = run_prepare.prepare("linear_ramp", RunSettings(out=tmp_path, name="a", fast=True))
    done = run_workflow.drive(
        prepared, stop, lambda tick: stop.ask(QUIT) if tick.index == 240 and not stop.over else None
    )
    found = written(prepared, done, stop)
    journal = read_journal(tmp_path / "a.journal")
    after = journal.samples[len(journal.driven) :]
    assert (found["reason"], found["empty"], found["exit_code"], found["ticks"]) == ("quit", True, 130, 241)
    assert after["pressure_MPa"][0] > 0.3 and after["pressure_MPa"][-1] < 0.01 and after["angle_deg"][-1] < 20
    assert done.truth is not None and len(done.truth.time_s) == len(journal.samples)
    benchlab("run", "linear_ramp", "--bench", f"replay:{tmp_path / 'a.journal'}", "--out", tmp_path, "--name", "b")
    again = read_journal(tmp_path / "b.journal")
    assert again.samples["pressure_MPa"].tolist() == journal.samples["pressure_MPa"].tolist()
    assert again.stop and again.stop["empty"] is True


def test_enough_of_a_film_leaves_the_outcome_and_the_files(tmp_path: Path) -> None:
    """A wish while it is drawn ends the drawing, and the run was complete."""
    stop = Stop()
    prepared = run_prepare.prepare("linear_ramp", RunSettings(out=tmp_path, name="a", fast=True, video=True))
    driven_run = run_workflow.drive(prepared, stop)
    stop.write()
    frames = []

    def progress(done: int, total: int | None) -> None:
        frames.append(done)
        if done == 3:
            stop.ask(QUIT)

    found = written(prepared, driven_run, stop, progress)
    assert frames[-1] == 3 and (found["reason"], found["empty"], found["exit_code"]) == ("completed", True, 130)
    assert left(tmp_path) == ["a.csv", "a.h5", "a.journal", "a.png", "a.truth.csv"] and len(found["outputs"]) == 5
    assert "the film was not drawn: interrupted" in found["warnings"][-1]


def test_an_interrupt_that_gets_through_while_files_are_written_says_how_to_make_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from benchlab.workflows import run_files

    def hang(*_: Any) -> None:
        raise KeyboardInterrupt

    prepared = run_prepare.prepare("linear_ramp", RunSettings(out=tmp_path, name="a", fast=True))
    driven_run = run_workflow.drive(prepared, Stop())
    monkeypatch.setattr(run_files, "write_results", hang)
    found = written(prepared, driven_run)
    assert found["exit_code"] == 130 and found["outputs"] == [str(tmp_path / "a.journal")]
    assert "benchlab recover" in found["error"]["what"]
