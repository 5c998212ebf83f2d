"""Whole runs of the runner on the emulated firmware: what fails on the bench ends the run, with its cause, and vented."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchlab.devices.emulated import LockstepTransport
from benchlab.devices.emulator import Emulator
from benchlab.devices.serial_bench import SerialBench
from benchlab.runner.clock import VirtualClock
from benchlab.runner.end import RunEnd
from benchlab.runner.run import execute
from tests.unit.devices.faulty_line import FaultyLine
from tests.unit.devices.nano import BENCH, needs_emulator
from tests.unit.runner.fakes import FakeJournal, plan_of, ramp

pytestmark = needs_emulator


@pytest.fixture
def emulator(tmp_path: Path) -> Iterator[Emulator]:
    emulator = Emulator(BENCH, lockstep=True, log=tmp_path / "events.txt")
    yield emulator
    emulator.close()


def run(emulator: Emulator, at_tick: Callable[[int, FaultyLine], Any] = lambda *_: None) -> tuple[RunEnd, FakeJournal]:
    """3 s up to 0.3 MPa; at_tick may do harm."""
    line, journal = FaultyLine(LockstepTransport(emulator)), FakeJournal()
    device = SerialBench(line, BENCH)
    plan = plan_of(ramp())
    end = execute(plan, device, BENCH, journal, VirtualClock(), on_tick=lambda tick: at_tick(tick.index, line))
    return end, journal


def test_a_run_to_its_end(emulator: Emulator) -> None:
    end, journal = run(emulator)
    assert (end.reason, end.vented, end.ticks, end.faults) == ("completed", True, 300, 0)
    assert emulator.tell("state").code == 0
    measured = np.array([row[8] for row in journal.samples])
    assert measured[-1] == pytest.approx(0.3, abs=0.003)


@pytest.mark.parametrize(
    ("command", "reason"),
    [("reset", "rebooted"), ("hang", "rebooted"), ("power", "rebooted"), ("dac lost", "dac lost")],
)
def test_what_happens_to_the_nano_ends_the_run(emulator: Emulator, command: str, reason: str) -> None:
    end, _ = run(emulator, lambda tick, line: emulator.tell(command) if tick == 150 else None)
    assert end.reason == reason and end.exit_code == 5
    assert 150 < end.ticks < 180
    assert end.vented is (command != "dac lost")


def test_an_unplugged_cable_ends_the_run_as_lost_and_the_nano_vents_itself(emulator: Emulator) -> None:
    """Nothing goes either way from the 150th tick on."""

    def unplug(tick: int, line: FaultyLine) -> None:
        if tick >= 150 and not line.down:
            line.down.extend(["lose"] * 1000)

    end, journal = run(emulator, unplug)
    assert end.reason == "lost" and end.exit_code == 5 and not end.vented
    assert "no answer for 0.5 s" in end.cause.words
    assert emulator.tell("state").code == 0
    assert journal.kinds()[-1] == "stop"


def test_checksum_errors_above_a_rate_end_the_run(emulator: Emulator) -> None:
    """One in five, where one in ten is borne."""

    def damage(tick: int, line: FaultyLine) -> None:
        if tick > 100 and tick % 5 == 0:
            line.up.append("flip")

    end, journal = run(emulator, damage)
    assert end.reason == "faults" and end.vented
    told = {content["cause"] for kind, content in journal.events if kind == "fault"}
    assert "an answer with a wrong checksum; passed over" in told


def test_a_few_checksum_errors_are_borne_and_written_down(emulator: Emulator) -> None:
    end, journal = run(emulator, lambda tick, line: line.up.append("flip") if tick in {120, 220} else None)
    assert end.reason == "completed" and end.faults >= 2
    assert journal.kinds().count("fault") >= 2
