"""The serial bench over the emulated Nano in lockstep, on lines that lose, double, damage, delay and reorder."""

import itertools
import math
import random
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchlab.bench import Bench, LimitError, Line
from benchlab.devices import conversation
from benchlab.devices.emulated import LockstepTransport
from benchlab.devices.emulator import Emulator
from benchlab.devices.interface import LostError, OutputError, Status
from benchlab.devices.messages import HELLO, Answer
from benchlab.devices.serial_bench import SerialBench
from benchlab.devices.tally import Tally
from benchlab.devices.wire import ANSWER, Decoder, Frame, Wire, encode
from benchlab.errors import BenchError
from tests.unit.devices.faulty_line import FaultyLine
from tests.unit.devices.nano import BENCH, needs_emulator

pytestmark = needs_emulator


@pytest.fixture
def emulator(tmp_path: Path) -> Iterator[Emulator]:
    emulator = Emulator(BENCH, lockstep=True, log=tmp_path / "events.txt")
    yield emulator
    emulator.close()


@pytest.fixture
def line(emulator: Emulator) -> FaultyLine:
    return FaultyLine(LockstepTransport(emulator))


def ramp(device: SerialBench, line: FaultyLine, ticks: int = 5, start: int = 0, pressure_MPa: float = 0.1) -> list:
    return [device.exchange((start + tick) / 100, pressure_MPa) for tick in range(ticks)]


def causes(device: SerialBench) -> dict[str, int]:
    return {fault.cause: fault.count for fault in device.faults()}


def test_what_it_says_of_itself(line: FaultyLine) -> None:
    about = SerialBench(line, BENCH).about()
    assert about["ceiling_code"] == BENCH.ceiling_code and about["ceiling_MPa"] == BENCH.ceiling_MPa
    assert about["firmware"] == "1.1.1" and about["notes"] == []
    assert about["slew_MPa_per_s"] == pytest.approx(40_000 * 5 / 4096 * 0.096)


def test_a_reading_is_in_the_benchs_units(line: FaultyLine, emulator: Emulator) -> None:
    emulator.tell("flex 1500")
    device = SerialBench(line, BENCH)
    device.arm()
    readings = ramp(device, line, 100)
    assert [r.status for r in readings[10:]] == [Status.ARMED] * 90
    last = readings[-1]
    assert last.code == BENCH.code(0.1)
    assert last.pressure_MPa == pytest.approx(BENCH.pressure_MPa(last.code), abs=0.002)
    assert BENCH.monitor is not None
    assert last.monitor_V == pytest.approx(BENCH.monitor.inverse(last.pressure_MPa))
    assert last.flex_V == pytest.approx(1.5, abs=0.006)
    steps = [b.device_time_s - a.device_time_s for a, b in itertools.pairwise(readings)]
    assert max(abs(step - 0.01) for step in steps[10:]) < 0.0005
    assert device.faults() == []


def test_without_a_monitor_pressure_is_missing(line: FaultyLine) -> None:
    device = SerialBench(line, replace(BENCH, monitor=None))
    assert math.isnan(device.exchange(0.0, 0.0).pressure_MPa)


def test_its_clock_goes_on_where_the_nanos_begins_again() -> None:
    """The Nano's microseconds begin again after 71.6 minutes."""
    device = object.__new__(SerialBench)
    device._bench, device._hello = BENCH, type("H", (), {"adc_samples": 8})()
    device._talk = conversation.Conversation(Babble())
    device._boot = device._turns = device._micros = 0
    device._armed = True
    times = [device._reading(Answer(0, 0, 0, 1, us, 0, 0, 0)).device_time_s for us in (4_294_960_000, 2704)]
    assert times[1] - times[0] == pytest.approx(0.01)


def test_a_firmware_with_a_lower_ceiling_is_told_and_kept(line: FaultyLine) -> None:
    """The bench may give 0.35 MPa, the firmware was written for 0.3."""
    wider = replace(BENCH, limit_MPa=0.4, limit_reason="a test")
    device = SerialBench(line, wider)
    (note,) = device.about()["notes"]
    assert "the firmware gives at most 0.3499 MPa, the bench 0.4 MPa" in note
    device.arm()
    with pytest.raises(LimitError, match=r"above 0.3499 MPa, the firmware's ceiling"):
        device.exchange(0.0, 0.36)


def test_a_firmware_with_a_higher_ceiling_is_told(line: FaultyLine) -> None:
    device = SerialBench(line, replace(BENCH, limit_MPa=0.33))
    (note,) = device.about()["notes"]
    assert "ceiling, code 2986, lies above the bench's, 2816" in note
    device.arm()


def test_a_firmware_with_a_much_higher_ceiling_is_not_armed(line: FaultyLine) -> None:
    device = SerialBench(line, replace(BENCH, limit_MPa=0.3))
    assert "code 2986, more than 10 % above this bench's 2560" in device.about()["unsafe"][0]
    with pytest.raises(BenchError, match=r"not armed: .*more than 10 %.*bench firmware"):
        device.arm()
    device.vent()


@pytest.mark.parametrize(
    ("at", "value", "named"),
    [
        (8, 0, "silence limit is 0 ms"),
        (8, 60_000, "silence limit is 60000 ms"),
        (6, 4095, "slew is 4095 codes/ms"),
        (6, 0, "slew is 0"),
        (10, 9000, "hung main loop is 9000 ms"),
        (4, 65_535, "ceiling is code 65535, and the DAC ends at 4095"),
        (17, 0, "means of 0 conversions"),
    ],
)
def test_a_firmware_with_settings_that_are_not_safe_is_vented_and_not_armed(
    line, at: int, value: int, named: str
) -> None:
    edited = OldFirmware(line, head=bytes([1, 1, 1, 1]), size=23)
    old = edited.old

    def told(frame: Frame) -> Frame:
        payload = bytearray(old(frame).payload)
        payload[at : at + (1 if at == 17 else 2)] = value.to_bytes(1 if at == 17 else 2, "little")
        return replace(frame, payload=bytes(payload))

    edited.old = told
    device = SerialBench(edited, BENCH)
    assert named in device.about()["unsafe"][0]
    with pytest.raises(BenchError, match=named):
        device.arm()
    device.vent()
    assert device.exchange(0.0, 0.0).code == 0


@pytest.mark.parametrize(("code", "told"), [(2048, "50 % of the supply"), (0xFFFF, "could not be read")])
def test_a_dac_that_starts_with_pressure_is_told(line: FaultyLine, code: int, told: str) -> None:
    edited = OldFirmware(line, head=bytes([1, 1, 1, 1]), size=23)
    edited.old = lambda frame: replace(
        frame, payload=frame.payload[:14] + code.to_bytes(2, "little") + frame.payload[16:]
    )
    about = SerialBench(edited, BENCH).about()
    assert told in about["notes"][0] and about["dac_power_on_code"] == (code if code < 4096 else None)


def test_more_than_was_asked_for_ends_it_at_once(line: FaultyLine, emulator: Emulator) -> None:
    """A DAC that acknowledges and stays: falling is never slowed, so that its code is above what was asked for."""
    device = SerialBench(line, BENCH)
    device.arm()
    ramp(device, line, 20)
    device._reading = lambda answer, read=device._reading: replace(read(answer), code=900)
    with pytest.raises(OutputError, match="output is code 900, and 853 was asked for"):
        device.exchange(0.3, 0.1)
    device._reading = lambda answer, read=SerialBench._reading: replace(
        read(device, answer), code=3000, status=Status.REFUSED
    )
    with pytest.raises(OutputError, match="with a ceiling of 2986"):
        device.exchange(0.31, 0.1)


def test_another_protocol_is_refused(line: FaultyLine, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(conversation, "PROTOCOL", 9)
    with pytest.raises(BenchError, match=r"firmware 1.1.1 speaks protocol 1, this benchlab 9; .*bench firmware"):
        SerialBench(line, BENCH)


def test_it_waits_until_the_firmware_has_measured_its_supply(line: FaultyLine, emulator: Emulator) -> None:
    """Said hello to as soon as it listens, it has not yet; it is asked again."""
    for until, what in ((0.2, "reset"), (0.23, "state")):
        line.advance(until)
        line.read(0)
        emulator.tell(what)
    about = SerialBench(line, replace(BENCH, reference_counts=225.0)).about()
    assert about["reference_counts"] == 225 and about["supply_V"] == 5.0
    assert about["supply_between_V"] == pytest.approx([1024 / 225, 1.2 * 1024 / 225])


def test_after_a_run_the_supply_is_measured_anew(line: FaultyLine, emulator: Emulator) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    emulator.tell("supply 5200")
    ramp(device, line, 20)
    device.vent()
    assert SerialBench(line, BENCH).about()["reference_counts"] == 216


class OldFirmware:
    """Around a line: answers hello as version 1.0.0 did, whose hello ended before the supply; or as another."""

    def __init__(self, line: FaultyLine, head: bytes = bytes([1, 1, 0, 0]), size: int = 20) -> None:
        self.line, self.name, self.head, self.size = line, line.name, head, size
        self.about, self.clock_s, self.advance = line.about, line.clock_s, line.advance
        self.write, self.close, self.decoder = line.write, line.close, Decoder()

    def read(self, timeout_s: float) -> bytes:
        frames = self.decoder.feed(self.line.read(timeout_s))
        return b"".join(map(encode, (self.old(f) if f.command == HELLO | ANSWER else f for f in frames)))

    def old(self, frame: Frame) -> Frame:
        return replace(frame, payload=(self.head + frame.payload[4:])[: self.size])


def test_older_firmware_is_driven_and_told(line: FaultyLine) -> None:
    device = SerialBench(OldFirmware(line), replace(BENCH, reference_counts=225.0))
    about = device.about()
    assert (about["firmware"], about["reference_counts"], about["supply_V"]) == ("1.0.0", None, None)
    (note,) = about["notes"]
    assert "firmware 1.0.0 does not measure its supply" in note and "`benchlab bench firmware`" in note
    device.arm()
    assert ramp(device, line, 20)[-1].code == BENCH.code(0.1)


def test_what_an_older_version_says_after_its_hello_is_no_supply(line: FaultyLine) -> None:
    """The version says what is in a hello, not its length."""
    assert SerialBench(OldFirmware(line, size=23), BENCH).about()["reference_counts"] is None


def test_another_protocol_with_a_shorter_hello_is_named(line: FaultyLine) -> None:
    with pytest.raises(BenchError, match=r"firmware 2\.0\.0 speaks protocol 2, this benchlab 1"):
        SerialBench(OldFirmware(line, head=bytes([2, 2, 0, 0])), BENCH)


def test_a_firmware_whose_adc_does_not_convert_is_told(line: FaultyLine) -> None:
    """Its sum stays 0: half a second is waited for it."""
    mute = OldFirmware(line, head=bytes([1, 1, 1, 0]), size=23)
    mute.old = lambda frame: replace(frame, payload=frame.payload[:20] + bytes([0, 0, 64]))
    began = line.clock_s()
    (note,) = SerialBench(mute, BENCH).about()["notes"]
    assert "could not measure its supply" in note and 0.5 < line.clock_s() - began < 0.8


def test_a_calibration_without_counts_is_told_where_no_monitor_shows_the_supply(line: FaultyLine) -> None:
    assert SerialBench(line, BENCH).about()["notes"] == []
    (note,) = SerialBench(line, replace(BENCH, monitor=None)).about()["notes"]
    assert "has no reference_counts" in note and "calibrate again" in note
    assert SerialBench(line, replace(BENCH, monitor=None, calibrated=False)).about()["supply_V"] is None


def test_a_nano_that_still_boots_is_waited_for(line: FaultyLine) -> None:
    line.down.extend(["lose"] * 10)
    assert SerialBench(line, BENCH).about()["firmware"] == "1.1.1"


def test_nothing_that_answers_is_told(line: FaultyLine) -> None:
    line.down.extend(["lose"] * 1000)
    with pytest.raises(BenchError, match=r"no valid frame in 4 s: nothing answers; is the firmware on it") as told:
        SerialBench(line, BENCH)
    assert told.value.exit_code == 5


class Babble:
    """Another device, or the wrong baud: it says something all the time, for ever, and never a frame."""

    name, about = "COM7", dict

    def __init__(self, size: int = 10_000) -> None:
        self.now, self.noise, self.closed, self.size = 0.0, random.Random(1), False, size

    def clock_s(self) -> float:
        return self.now

    def advance(self, time_s: float) -> None: ...

    def write(self, data: bytes) -> None: ...

    def read(self, timeout_s: float) -> bytes:
        self.now += 0.02
        return self.noise.randbytes(self.size)

    def close(self) -> None:
        self.closed = True


def test_garbage_is_told_after_2_s_and_the_port_let_go() -> None:
    line = Babble()
    with pytest.raises(
        BenchError, match=r"COM7: no valid frame in 2 s, but [0-9]+ bytes came, .*; is this the Nano.* 500000 baud"
    ):
        SerialBench(line, BENCH)
    assert line.closed


def test_a_few_words_of_a_bootloader_are_no_garbage() -> None:
    """It answers a few bytes to what is no sketch, at its own baud, and the firmware comes after up to 2 s."""
    line = Babble(size=0)
    line.read = lambda timeout_s: setattr(line, "now", line.now + timeout_s) or (b"\x14\x10" if line.now < 2 else b"")
    with pytest.raises(BenchError, match=r"no valid frame in 4 s, but \d+ bytes came, none of them a frame"):
        SerialBench(line, BENCH)


class Says(Babble):
    """Answers each write with something: an echo, or words of another program."""

    def __init__(self, words: bytes | None) -> None:
        super().__init__(0)
        self.words, self.out = words, b""

    def write(self, data: bytes) -> None:
        self.out += data if self.words is None else self.words

    def read(self, timeout_s: float) -> bytes:
        self.now += min(timeout_s, 0.02)
        said, self.out = self.out, b""
        return said


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (b"ok\r\n", r"bytes came, none of them a frame; the last: .*ok.*500000 baud"),
        (None, r"bytes came, frames: \d+ that answer nothing that was asked: late, or an echo"),
        (b"", r"no valid frame in 4 s: nothing answers"),
    ],
    ids=["another program", "echo", "nothing"],
)
def test_what_came_instead_of_a_hello_is_told(words: bytes | None, told: str) -> None:
    with pytest.raises(BenchError, match=told):
        SerialBench(Says(words), BENCH)


@pytest.mark.parametrize(
    ("way", "fault", "cause", "answered"),
    [
        ("down", "lose", "no answer to a command within 9 ms", False),
        ("down", "flip", "the device heard a command with a wrong checksum", False),
        ("down", "cut", "the device heard an old, unfinished or unreadable command", False),
        ("down", "double", "an answer that came late, or twice", True),
        ("down", "late", "no answer to a command within 9 ms", False),
        ("down", "swap", "the device heard an old, unfinished or unreadable command", False),
        ("up", "lose", "no answer to a command within 9 ms", False),
        ("up", "flip", "an answer with a wrong checksum", False),
        ("up", "cut", "an answer with a wrong checksum", False),
        ("up", "double", "an answer that came late, or twice", True),
        ("up", "late", "an answer that came late, or twice", False),
        ("up", "swap", "an answer that came late, or twice", False),
        ("up", "noise", "bytes on the line that are no frame", True),
    ],
)
def test_each_fault_is_survived_and_told_with_its_cause(
    line: FaultyLine, way: str, fault: str, cause: str, answered: bool
) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    ramp(device, line, 20)
    assert device.faults() == []
    getattr(line, way).append(fault)
    (hit,) = ramp(device, line, 1, 20)
    after = ramp(device, line, 20, 21)
    assert bool(hit.status & Status.NO_ANSWER) is not answered
    if not answered:
        assert hit.code == -1 and math.isnan(hit.pressure_MPa) and math.isnan(hit.device_time_s)
    assert [r.status for r in after[2:]] == [Status.ARMED] * 18
    told = causes(device)
    assert any(cause in each for each in told), told
    assert not causes(device)
    assert after[-1].code == BENCH.code(0.1)


def test_thousands_of_faults_never_give_more_than_was_asked(
    line: FaultyLine, emulator: Emulator, tmp_path: Path
) -> None:
    rng = random.Random(5)
    words = ["ok"] * 8 + ["lose", "double", "flip", "cut", "noise", "late", "swap"]
    device = SerialBench(line, BENCH)
    device.arm()
    asked, told = 0, Counter[str]()
    for tick in range(2000):
        line.down.append(rng.choice(words))
        line.up.append(rng.choice(words))
        pressure = 0.35 * rng.random()
        asked = max(asked, BENCH.code(pressure))
        reading = device.exchange(tick / 100, pressure)
        assert reading.status & (Status.ARMED | Status.NO_ANSWER)
        told.update(causes(device))
    codes = [int(row.split()[3]) for row in (tmp_path / "events.txt").read_text().splitlines() if " dac " in row]
    assert 0.34 < BENCH.pressure_MPa(max(codes)) <= BENCH.pressure_MPa(asked)
    assert len(told) == 6 and sum(told.values()) > 800
    line.down.clear()
    line.up.clear()
    device.vent()
    assert emulator.tell("state").code == 0


faults = st.sampled_from(["ok", "ok", "lose", "double", "flip", "cut", "noise", "late", "swap"])


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(faults, faults, st.floats(0, 0.35)), min_size=1, max_size=40), st.integers(0, 1000))
def test_whatever_the_line_does(said: list[tuple[str, str, float]], seed: int) -> None:
    """Never more than was asked, every tick without an answer told with a cause, and a vent at the end that is confirmed."""
    own = Emulator(BENCH, lockstep=True)
    line = FaultyLine(LockstepTransport(own), seed)
    device = SerialBench(line, BENCH)
    device.arm()
    asked = [0]
    for tick, (down, up, pressure) in enumerate(said):
        line.down.append(down)
        line.up.append(up)
        asked.append(BENCH.code(pressure))
        reading = device.exchange(tick / 100, pressure if device._armed else 0.0)
        assert own.tell("state").code <= max(asked)
        assert reading.code in {-1, *range(max(asked) + 1)}
        assert causes(device) or not reading.status & Status.NO_ANSWER
    line.down.clear()
    line.up.clear()
    device.vent()
    assert own.tell("state").code == 0
    assert [r.status for r in ramp(device, line, 3, len(said), 0.0)] == [Status(0)] * 3
    device.close()


def test_no_answer_for_half_a_second_is_lost(line: FaultyLine) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    ramp(device, line, 10)
    line.up.extend(["lose"] * 1000)
    readings = []
    with pytest.raises(LostError, match=r"no answer for 0.5 s; was the cable pulled"):
        for tick in range(10, 200):
            readings.append(device.exchange(tick / 100, 0.1))
    assert 45 <= len(readings) <= 55
    assert all(reading.status == Status.NO_ANSWER for reading in readings)
    with pytest.raises(BenchError, match=r"not armed"):
        device.exchange(2.0, 0.1)
    line.up.clear()
    device.vent()


def test_arm_and_vent_are_asked_again(line: FaultyLine) -> None:
    device = SerialBench(line, BENCH)
    line.down.extend(["lose", "flip"])
    device.arm()
    line.up.extend(["lose", "flip"])
    device.vent()
    told = causes(device)
    assert told["no answer to `arm`; asked again"] == 2 and told["no answer to `vent`; asked again"] == 2


@pytest.mark.parametrize(
    ("fault", "told"),
    [
        ("flip", r"but \d+ bytes came, frames: \d+ with a wrong"),
        ("cut", r"but \d+ bytes came"),
        ("lose", "was the cable"),
    ],
)
def test_a_line_that_breaks_is_told_by_what_came(line: FaultyLine, fault: str, told: str) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    ramp(device, line, 20)
    line.up.extend([fault] * 200)
    with pytest.raises(LostError, match=rf"no answer for 0.5 s.*{told}.*the firmware vents by itself"):
        ramp(device, line, 100, start=20)


def test_a_vent_that_nobody_confirms_is_lost(line: FaultyLine) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    line.up.extend(["lose"] * 100)
    with pytest.raises(LostError, match=r"nobody answered `vent` in 0.5 s"):
        device.vent()
    with pytest.raises(BenchError, match=r"not armed"):
        device.exchange(0.0, 0.1)
    device.close()  # tries once more, and never raises
    with pytest.raises(LostError, match=r"nobody confirmed"):
        device.vent()


def test_a_closed_bench_says_so(line: FaultyLine) -> None:
    device = SerialBench(line, BENCH)
    device.close()
    device.close()
    device.vent()  # it was vented
    for act in (device.arm, lambda: device.exchange(0.0, 0.0)):
        with pytest.raises(BenchError, match=r"the bench is closed"):
            act()


def test_noise_from_before_the_first_answer_is_no_fault(line: FaultyLine) -> None:
    line.up.append("noise")
    assert SerialBench(line, BENCH).faults() == []


def test_it_waits_as_long_as_its_rate_allows(line: FaultyLine) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    for tick in range(100):
        device.exchange(tick / 500, 0.05)
    line.up.append("lose")
    device.exchange(100 / 500, 0.05)
    assert "no answer to a command within 2 ms; went on without" in causes(device)
    for tick in range(60):
        device.exchange(0.2 + tick / 50, 0.05)
    line.up.append("lose")
    device.exchange(0.2 + 60 / 50, 0.05)
    assert "no answer to a command within 18 ms; went on without" in causes(device)


def test_the_nanos_counters_begin_again() -> None:
    """At 65535 they begin again at 0; after a boot too."""
    tally, wire = Tally(), Wire()
    for crc_errors in (65530, 65533, 2, 4, 65000, 7):
        tally.device(crc_errors, 0)
    (fault,) = tally.take(wire)
    assert fault.count == 3 + 5 + 2 + 64996 + 543
    tally.device(3, 0)
    assert [fault.count for fault in tally.take(wire)] == [3]


def test_a_reset_in_mid_run_is_told_and_not_mended(line: FaultyLine, emulator: Emulator) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    ramp(device, line, 10)
    emulator.tell("reset")
    readings = [device.exchange(0.1 + tick / 100, 0.0) for tick in range(5)]
    assert readings[-1].status & Status.REBOOTED and not readings[-1].status & Status.ARMED
    with pytest.raises(BenchError, match=r"not armed"):
        device.exchange(0.2, 0.1)
    with pytest.raises(BenchError, match=r"has booted since it was opened; open it again"):
        device.arm()
    device.vent()


def test_a_long_silence_is_told(line: FaultyLine) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    ramp(device, line, 10)
    reading = device.exchange(0.5, 0.1)
    assert reading.status & Status.SILENCE and not reading.status & Status.ARMED and reading.code == 0
    device.arm()
    assert device.exchange(0.0, 0.1).status & Status.ARMED  # the next run begins at 0 s again


def test_a_lost_dac_is_told(line: FaultyLine, emulator: Emulator) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    ramp(device, line, 10)
    emulator.tell("dac lost")
    readings = [device.exchange(0.1 + tick / 100, 0.0) for tick in range(3)]
    assert readings[-1].status & Status.DAC_LOST and readings[-1].code == -1
    with pytest.raises(BenchError, match=r"does not arm: its DAC does not acknowledge"):
        device.arm()
    with pytest.raises(LostError, match=r"DAC does not acknowledge, .*; take the pressure away by hand"):
        device.vent()
    emulator.tell("dac back")
    device.exchange(0.2, 0.0)
    device.vent()


def test_a_trigger_reaches_the_camera(line: FaultyLine, emulator: Emulator) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    for tick in range(30):
        device.exchange(tick / 100, 0.05, trigger=tick in {3, 13})
    assert emulator.tell("state").triggers == 2


def test_an_emulator_that_dies_is_lost(line: FaultyLine, emulator: Emulator) -> None:
    device = SerialBench(line, BENCH)
    device.arm()
    emulator.close()
    with pytest.raises(LostError, match=r"the emulator has ended"):
        device.exchange(0.0, 0.1)
    with pytest.raises(LostError):
        device.vent()
    device.close()


def test_sensors_wear_the_calibration(emulator: Emulator) -> None:
    """The emulation's volts are made so that a calibrated bench reads true values from them."""
    odd = Bench("odd", Line(0.09, 0.002), Line(0.1, -0.05), Line(-80.0, 200.0), calibrated=True, supply_V=4.8)
    own = Emulator(odd, lockstep=True)
    device = SerialBench(LockstepTransport(own), odd)
    device.arm()
    reading = [device.exchange(tick / 100, 0.2) for tick in range(120)][-1]
    assert reading.pressure_MPa == pytest.approx(0.2, abs=0.002)
    assert odd.flex is not None
    assert odd.flex.of(reading.flex_V) == pytest.approx(314 * 0.2, abs=0.6)
    device.close()
