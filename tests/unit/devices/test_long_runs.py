"""What only long runs meet: numbers of commands that begin again at 65535, and the Nano's clock that does after 49.7 days."""

import itertools
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchlab.bench import Bench
from benchlab.devices import emulator
from benchlab.devices.firmware import firmware_text
from benchlab.devices.interface import Status
from tests.unit.devices.nano import BENCH, Nano, needs_emulator

ARMED, SILENCE = Status.ARMED.value, Status.SILENCE.value


def test_the_sketch_as_it_lies_here_has_the_ceiling_of_a_bench_that_nobody_calibrated() -> None:
    sketch = Path(emulator.__file__).parents[1] / "firmware" / "benchlab_nano" / "benchlab_nano.ino"
    (code,) = re.findall(r"#define CEILING_CODE (\d+)", sketch.read_text(encoding="utf-8"))
    assert int(code) == Bench("new").ceiling_code
    assert f"#define CEILING_CODE {BENCH.ceiling_code} " in firmware_text(BENCH)


@needs_emulator
def test_commands_are_obeyed_across_the_end_of_their_numbers(tmp_path: Path) -> None:
    nano = Nano(tmp_path / "events.txt")
    nano.wire.number = 65530
    nano.arm()
    for code in range(20, 32):
        nano.line.advance(nano.line.clock_s() + 0.01)
        answer = nano.set(code)
        assert answer.flags & ARMED and answer.code == code
    assert nano.wire.number < 20 and answer.dropped == 0
    assert nano.vent().code == 0
    nano.emulator.close()


@pytest.fixture
def old_nano(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Nano]:
    """A Nano whose clock began 1 s before its end."""

    def text(bench: Bench) -> str:
        begun, count = re.subn(r"(uint32_t clock_ms);", r"\1 = 4294967295UL - 1000;", firmware_text(bench))
        assert count == 1
        return begun

    monkeypatch.setattr(emulator, "firmware_text", text)
    nano = Nano(tmp_path / "events.txt")
    yield nano
    nano.emulator.close()


@needs_emulator
def test_it_holds_across_the_end_of_its_clock(old_nano: Nano) -> None:
    nano = old_nano
    nano.arm()
    nano.hold(500, 0.1)  # it rises slowly
    micros = []
    for _ in range(200):
        nano.line.advance(nano.line.clock_s() + 0.01)
        answer = nano.set(500)
        assert answer.flags & ARMED and answer.code == 500
        micros.append(answer.micros)
    steps = [(b - a) % 2**32 for a, b in itertools.pairwise(micros)]
    assert max(steps) < 20_000 and min(steps) > 5_000


@needs_emulator
def test_silence_is_noticed_across_the_end_of_its_clock(old_nano: Nano) -> None:
    nano = old_nano
    nano.arm()
    while nano.line.clock_s() < 0.9:  # of 1.0
        nano.line.advance(nano.line.clock_s() + 0.01)
        heard_s = nano.line.clock_s()
        nano.set(500)
    nano.run(0.5)
    answer = nano.status()
    assert answer.code == 0 and answer.flags & SILENCE and not answer.flags & ARMED
    (vented_s,) = [s for s, _, value in nano.events("dac") if value == 0 and s > heard_s][:1]
    assert 0.19 < vented_s - heard_s < 0.25
