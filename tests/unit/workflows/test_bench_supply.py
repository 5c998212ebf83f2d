"""A bench on a supply above the one of its calibration is refused before it is armed: the emulated firmware measures it."""

from dataclasses import replace
from pathlib import Path

import pytest

from benchlab.bench import Bench, Line
from benchlab.devices import emulated
from benchlab.devices.emulated import LockstepTransport
from benchlab.devices.emulator import Emulator
from benchlab.devices.serial_bench import SerialBench
from benchlab.devices.supply import supply_told
from benchlab.errors import BenchError
from benchlab.runner.stop import Stop
from benchlab.workflows import run
from benchlab.workflows.bench_supply import check_supply
from benchlab.workflows.run_prepare import RunSettings, prepare
from tests.unit.devices.nano import needs_emulator

REGULATOR, MONITOR = Line(0.096, 0.0), Line(0.12, -0.12)
BENCH = Bench("left", REGULATOR, supply_V=5.0, reference_counts=225.0, calibrated=True)


def about(counts: float) -> dict:
    """What a device with this calibration says of its supply."""
    return supply_told(counts, BENCH)


@pytest.mark.parametrize("supply_V", [4.5, 4.9, 5.0, 5.09])
def test_a_supply_that_is_the_same_or_lower_is_let_pass(supply_V: float) -> None:
    check_supply(about(225 * 5 / supply_V), BENCH)


def test_two_percent_above_is_refused_with_both_voltages_and_the_remedy() -> None:
    with pytest.raises(BenchError, match=r"is 5\.11 V, calibrated at 5\.00 V.*2\.2 % above.*USB port") as refused:
        check_supply(about(225 * 5 / 5.11), BENCH)
    assert refused.value.exit_code == 5


@pytest.mark.parametrize(("counts", "possible"), [(185, False), (187, True), (272, True), (274, False)])
def test_without_counts_at_the_calibration_only_an_impossible_supply_is_refused(counts: float, possible: bool) -> None:
    """A reference of 1.0 V reads as 186.2 counts on 5.5 V, one of 1.2 V as 273.1 counts on 4.5 V."""
    bench = replace(BENCH, reference_counts=None)
    told = {**about(counts), "supply_V": None}
    if possible:
        check_supply(told, bench)
        return
    with pytest.raises(BenchError, match=r"and a bench has 4\.5 to 5\.5 V; measure between 5V and GND"):
        check_supply(told, bench)


def test_a_device_that_does_not_measure_is_not_judged() -> None:
    check_supply({}, BENCH)
    check_supply({"reference_counts": None, "supply_V": None, "supply_between_V": None}, BENCH)


def device_on(supply_V: float, log: Path) -> SerialBench:
    """The bench that was calibrated at 5 V, now plugged in elsewhere."""
    emulator = Emulator(BENCH, lockstep=True, log=log)
    emulator.tell(f"supply {1000 * supply_V:.0f}")
    return SerialBench(LockstepTransport(emulator), BENCH, kind="emulated")


@needs_emulator
@pytest.mark.parametrize("supply_V", [4.5, 4.75, 4.9, 5.0, 5.1, 5.2, 5.25])
def test_the_supply_is_told_to_half_a_percent(tmp_path: Path, supply_V: float) -> None:
    device = device_on(supply_V, tmp_path / "events.txt")
    assert device.about()["supply_V"] == pytest.approx(supply_V, rel=0.005)
    low, high = device.about()["supply_between_V"]
    assert low < supply_V < high
    device.close()


def run_on(supply_V: float, folder: Path, monkeypatch: pytest.MonkeyPatch) -> run.Driven:
    """Up to 0.1 MPa, with the calibration of 5 V."""
    protocol = folder / "hold.yaml"
    protocol.write_text("title: hold\nlimit_MPa: 0.15\nsegments:\n  - ramp: {to_MPa: 0.1, duration_s: 0.2}\n")
    monkeypatch.setattr(emulated, "emulated_bench", lambda: BENCH)
    monkeypatch.setattr(run, "open_bench", lambda *_, **__: device_on(supply_V, folder / "events.txt"))
    settings = RunSettings(bench="emulated", fast=True, out=folder, name="r")
    return run.drive(prepare(str(protocol), settings), Stop())


def codes(folder: Path) -> list[int]:
    rows = [row.split() for row in (folder / "events.txt").read_text().splitlines()]
    return [int(value) for _, _, what, value in rows if what == "dac"]


@needs_emulator
def test_a_run_on_a_supply_that_has_risen_arms_nothing_and_leaves_no_file(tmp_path: Path, monkeypatch) -> None:
    with pytest.raises(BenchError, match=r"the supply is 5\.21 V, calibrated at 5\.00 V"):
        run_on(5.2, tmp_path, monkeypatch)
    assert set(codes(tmp_path)) == {0} and not list(tmp_path.glob("r.*"))


@needs_emulator
@pytest.mark.parametrize(("supply_V", "notes"), [(4.9, 0), (4.8, 1)])
def test_a_run_on_a_lower_supply_is_driven_and_told_from_three_percent_on(
    tmp_path: Path, monkeypatch, supply_V: float, notes: int
) -> None:
    driven = run_on(supply_V, tmp_path, monkeypatch)
    assert driven.end.vented and driven.end.reason == "completed"
    assert max(codes(tmp_path)) == BENCH.code(0.1)
    assert len(driven.about["notes"]) == notes
    assert all("4.81 V, calibrated at 5.00 V: each pressure is 4 % below" in note for note in driven.about["notes"])


@needs_emulator
def test_what_is_refused_would_have_been_given_more_and_not_seen_it(tmp_path: Path) -> None:
    """The regulator gets 4 % more volts at 5.2 V; the monitor, read against the same supply, shows less than that."""
    device = device_on(5.2, tmp_path / "events.txt")
    device.arm()
    reading = [device.exchange(tick / 100, 0.2) for tick in range(150)][-1]
    assert reading.code == BENCH.code(0.2)
    truly_V = reading.monitor_V * 5.2 / BENCH.supply_V
    assert MONITOR.of(truly_V) == pytest.approx(0.2 * 1.04, abs=0.001)
    assert MONITOR.of(reading.monitor_V) < 0.2 + 0.001
    device.close()
