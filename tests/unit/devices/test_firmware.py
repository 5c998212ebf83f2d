"""The firmware itself, in lockstep: what it does at boot, when armed, over the limits, and when something fails."""

import itertools
import math
import random
import re
import struct
import subprocess
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

import pytest

from benchlab.bench import Bench
from benchlab.devices import emulator
from benchlab.devices.emulator import AVR, build
from benchlab.devices.firmware import firmware_text
from benchlab.devices.interface import Status
from benchlab.devices.messages import ARM, HELLO, SET, UNKNOWN_CODE, VENT, answer_of, arm_payload, set_payload
from benchlab.devices.wire import Frame, Wire, encode
from tests.unit.devices.nano import BENCH, Nano, needs_emulator

pytestmark = needs_emulator
CEILING = BENCH.ceiling_code
ARMED, SILENCE, REFUSED = Status.ARMED.value, Status.SILENCE.value, Status.REFUSED.value
DAC_LOST, REBOOTED, WATCHDOG = Status.DAC_LOST.value, Status.REBOOTED.value, Status.WATCHDOG.value


@pytest.fixture
def nano(tmp_path: Path) -> Iterator[Nano]:
    nano = Nano(tmp_path / "events.txt")
    yield nano
    nano.emulator.close()


def highest(nano: Nano) -> int:
    return max(value for _, _, value in nano.events("dac"))


def test_boot_zeroes_the_dac_before_anything_else(nano: Nano) -> None:
    """The DAC comes from the factory with half of full scale at power-on."""
    assert nano.tell("state").code == 2048
    nano.run(0.15)
    (boot, what, _), (zeroed, then, code) = nano.events()[:2]
    assert (what, then, code) == ("boot", "dac", 0)
    assert zeroed - boot < 0.001


def test_the_dacs_power_on_value_is_programmed_once(nano: Nano) -> None:
    nano.run(0.15)
    assert [value for _, _, value in nano.events("memory")] == [0]
    nano.tell("power")
    nano.run(0.15)
    assert len(nano.events("memory")) == 1  # its memory wears out: it is written only where it is not 0
    nano.hello()
    assert nano.said.dac_eeprom == 0
    nano.tell("memory 700")
    nano.tell("power")
    nano.run(0.15)
    assert nano.tell("state").memory == 0


def test_hello_tells_version_limits_and_boot(nano: Nano) -> None:
    nano.hello()
    said = nano.said
    assert (said.protocol, said.version, said.ceiling_code, said.cause) == (1, "1.1.1", CEILING, "power")
    assert (said.slew_codes_per_ms, said.silence_ms, said.watchdog_ms, said.adc_samples) == (40, 200, 100, 8)
    nano.tell("reset")
    nano.run(0.1)
    nano.hello()
    assert (nano.said.boot, nano.said.cause) == ((said.boot + 1) % 65536, "reset")


def test_hello_is_these_bytes(nano: Nano) -> None:
    """The layout in docs/firmware.md, number by number."""
    nano.run(0.2)
    nano.line.write(nano.wire.ask(HELLO))
    payload = nano.wire.hear(nano.line.read(0.05)) or b""
    told = struct.unpack("<BBBBHHHHHHBBBBHB", payload)
    assert told == (1, 1, 1, 1, CEILING, 40, 200, 100, 0, 0, 1, 8, 0x62, REBOOTED, 64 * 225, 64)


def test_the_supply_is_measured_after_the_boot_and_after_each_run(nano: Nano) -> None:
    """Of 1.1 V on 5 V the ADC counts 225 of 1023; hello says 0 until 64 conversions, one a millisecond, are done."""
    nano.run(0.2)
    nano.tell("reset")
    nano.run(0.03)
    nano.hello()
    assert nano.said.reference == 0 and nano.said.reference_counts is None
    nano.run(0.07)
    nano.hello()
    assert nano.said.reference_counts == 225
    nano.arm()
    nano.hold(100, 0.1)
    nano.tell("supply 4700")
    nano.hold(100, 0.1)
    nano.hello()
    assert nano.said.reference == 0  # what was measured before the run is not told after it
    nano.run(0.07)
    nano.hello()
    assert nano.said.reference_counts == 1100 * 1023 // 4700


def test_the_sensors_read_the_same_while_the_supply_is_measured(nano: Nano) -> None:
    """It is measured while the bench is vented, and not while it is armed."""
    nano.tell("flex 1000")
    nano.tell("monitor 4000")
    nano.arm()
    nano.hold(0, 0.1)
    armed = nano.status()
    nano.vent()
    nano.run(0.1)
    vented = nano.status()
    assert (armed.flex, armed.monitor) == (vented.flex, vented.monitor) == (8 * 204, 8 * 818)


def test_disarmed_it_gives_no_pressure(nano: Nano) -> None:
    nano.hello()
    answer = nano.set(100)
    assert answer.flags & REFUSED and answer.code == 0
    assert not nano.set(0).flags & REFUSED
    assert highest(nano) == 0


def test_arming_names_the_boot(nano: Nano) -> None:
    nano.hello()
    answer = nano.ask(ARM, arm_payload(nano.boot ^ 1))
    assert answer.flags & REFUSED and not answer.flags & ARMED
    assert nano.ask(ARM, arm_payload(nano.boot)).flags == ARMED


def test_above_the_ceiling_is_refused_and_not_clipped(nano: Nano) -> None:
    nano.arm()
    nano.hold(1000, 0.1)
    for code in (CEILING + 1, 4095, 65535):
        answer = nano.set(code)
        assert answer.flags & REFUSED and answer.code == 1000
    answer = nano.hold(CEILING, 0.1)
    assert answer.code == CEILING and not answer.flags & REFUSED
    assert highest(nano) == CEILING


def test_rises_are_slowed_and_falls_are_not(nano: Nano) -> None:
    nano.arm()
    first = nano.set(2000)
    assert 0 < first.code <= 120 and first.flags & Status.SLEWING
    steps = []
    while nano.set(2000).code < 2000:
        steps.append(nano.line.clock_s())
    written = [(t, code) for t, _, code in nano.events("dac") if code]
    for (t0, a), (t1, b) in itertools.pairwise(written):
        assert b - a <= 40 * (t1 - t0) * 1000 + 41  # 40 a millisecond
    assert 0.04 < written[-1][0] - written[0][0] < 0.06  # 2000 codes are 50 ms
    assert not nano.set(2000).flags & Status.SLEWING
    assert nano.set(5).code == 5


def test_vent_zeroes_and_latches(nano: Nano) -> None:
    nano.arm()
    nano.hold(1500, 0.1)
    answer = nano.vent()
    assert (answer.code, answer.flags & ARMED) == (0, 0)
    assert nano.set(1500).code == 0
    assert nano.vent().code == 0


def test_a_vent_ends_what_was_told_of_earlier_commands(nano: Nano) -> None:
    nano.arm()
    assert nano.set(2000).flags & Status.SLEWING
    assert nano.vent().flags == 0
    assert nano.set(2000).flags & REFUSED
    assert nano.vent().flags == 0


def test_silence_vents_after_200_ms_and_latches(nano: Nano) -> None:
    nano.arm()
    nano.hold(1500, 0.1)
    last = nano.line.clock_s()
    nano.run(0.5)
    vented = next(t for t, _, code in nano.events("dac") if code == 0 and t > last)
    assert 0.19 < vented - last <= 0.205
    answer = nano.set(1500)
    assert answer.flags & SILENCE and answer.flags & REFUSED and answer.code == 0
    assert nano.arm().flags == ARMED


def test_noise_and_old_commands_are_no_sign_of_life(nano: Nano) -> None:
    nano.arm()
    nano.hold(1500, 0.1)
    old = encode(Frame(nano.wire.number - 3, SET, set_payload(1500, False)))
    for _ in range(30):
        nano.raw(old + b"\xb5\x03noise", 0.01)
    assert nano.status().flags & SILENCE


def test_only_a_code_that_is_taken_keeps_it_armed(nano: Nano) -> None:
    """Neither status nor codes above the ceiling nor arming twice in vain: a host that does not drive is silent."""
    for say in (nano.status, lambda: nano.set(CEILING + 1), lambda: nano.ask(ARM, arm_payload(nano.boot ^ 1))):
        nano.arm()
        nano.hold(1500, 0.1)
        for _ in range(30):
            nano.run(0.01)
            answer = say()
        assert answer.flags & SILENCE and answer.code == 0


def test_a_dac_that_acknowledges_and_does_not_follow_is_no_vent(nano: Nano) -> None:
    """Each vent reads back what the DAC holds."""
    nano.arm()
    nano.hold(1500, 0.1)
    nano.tell("dac stuck")
    answer = nano.vent()
    assert answer.code == UNKNOWN_CODE and answer.flags & DAC_LOST
    assert nano.arm().flags & REFUSED
    nano.tell("dac back")
    nano.run(0.02)
    assert nano.vent().code == 0 and nano.arm().flags == ARMED


def test_nothing_above_the_ceiling_reaches_the_dac_whoever_asks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the check of the command, the last one vents."""
    blind = firmware_text(BENCH).replace("if (code > CEILING_CODE || (code && ", "if ((code && ")
    assert blind != firmware_text(BENCH)
    monkeypatch.setattr(emulator, "firmware_text", lambda bench: blind)
    nano = Nano(tmp_path / "events.txt")
    nano.arm()
    nano.set(4000)
    nano.run(0.15)
    assert highest(nano) <= CEILING and nano.tell("state").code == 0 and not nano.status().flags & ARMED
    nano.emulator.close()


@pytest.mark.parametrize("setting", ["CEILING_CODE 4096", "SLEW_CODES_PER_MS 256", "SLEW_CODES_PER_MS 0", "SILENCE_MS 0",
                                     "SILENCE_MS 60000", "TRIGGER_MS 300", "DAC_ADDRESS 0x50", "ADC_SAMPLES 12"])  # fmt: skip
def test_settings_that_do_not_fit_are_not_compiled(tmp_path: Path, setting: str) -> None:
    name = setting.partition(" ")[0]
    text, count = re.subn(rf"#define {name} \w+", f"#define {setting}", firmware_text(BENCH))
    assert count == 1
    (tmp_path / "sketch.ino").write_text(text)
    done = subprocess.run([*AVR, "-E", str(tmp_path / "sketch.ino")], capture_output=True, text=True, check=False)
    assert done.returncode and f"{name} must be" in done.stderr


def test_a_hung_main_loop_is_vented_and_reset(nano: Nano) -> None:
    nano.arm()
    nano.hold(1500, 0.1)
    hung = nano.line.clock_s()
    nano.tell("hang")
    nano.run(0.5)
    vented = next(t for t, _, code in nano.events("dac") if code == 0 and t > hung)
    assert vented - hung < 0.105
    answer = nano.status()
    assert answer.flags == WATCHDOG | REBOOTED and answer.code == 0
    assert nano.arm().flags == WATCHDOG | ARMED
    nano.tell("reset")
    nano.run(0.2)
    assert nano.status().flags == REBOOTED  # the watchdog is told once


def test_the_watchdog_is_told_where_a_bootloader_hides_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Optiboot clears the register with the reset's cause before the firmware sees it."""
    hidden = firmware_text(BENCH).replace("reset_cause = MCUSR;", "reset_cause = 0;")
    monkeypatch.setattr(emulator, "firmware_text", lambda bench: hidden)
    nano = Nano(tmp_path / "events.txt")
    nano.arm()
    assert nano.said.cause == "not told by the bootloader"
    nano.tell("hang")
    nano.run(0.5)
    assert nano.status().flags == WATCHDOG | REBOOTED
    nano.emulator.close()


def test_a_hang_with_interrupts_off_is_reset(nano: Nano) -> None:
    nano.arm()
    nano.hold(1500, 0.1)
    hung = nano.line.clock_s()
    nano.tell("deaf")
    nano.run(0.5)
    vented = next(t for t, _, code in nano.events("dac") if code == 0 and t > hung)
    assert vented - hung < 0.27
    assert nano.status().flags == WATCHDOG | REBOOTED


def test_a_reset_leaves_it_vented_and_disarmed(nano: Nano) -> None:
    nano.arm()
    nano.hold(1500, 0.1)
    at = nano.line.clock_s()
    assert nano.tell("reset").code == 1500  # the DAC holds its output through the reset
    nano.run(0.1)
    assert next(t for t, _, code in nano.events("dac") if code == 0 and t > at) - at < 0.001
    answer = nano.set(1500)
    assert answer.flags & REBOOTED and answer.flags & REFUSED and answer.code == 0
    assert nano.ask(ARM, arm_payload(nano.boot)).flags & REFUSED  # armed for the boot before


def test_any_number_is_new_after_a_reset(nano: Nano) -> None:
    """So that the host hears of the reset, wherever its numbers are."""
    nano.arm()
    nano.wire.number = 40_000
    nano.tell("reset")
    nano.run(0.1)
    assert nano.status().flags & REBOOTED


def test_a_dac_that_is_lost_latches_and_is_zeroed_when_it_is_back(nano: Nano) -> None:
    nano.arm()
    nano.hold(1500, 0.1)
    nano.tell("dac lost")
    nano.run(0.02)  # it is told its code again each 10 ms, so its loss is noticed
    answer = nano.status()
    assert answer.flags & DAC_LOST and not answer.flags & ARMED and answer.code == UNKNOWN_CODE
    assert nano.arm().flags & REFUSED
    nano.tell("dac back")
    nano.run(0.02)
    assert nano.tell("state").code == 0
    answer = nano.status()
    assert answer.flags & DAC_LOST and answer.code == 0  # latched until it is armed again
    assert nano.arm().flags == ARMED


def test_one_missing_acknowledgement_is_borne(nano: Nano) -> None:
    nano.arm()
    nano.hold(1500, 0.1)
    nano.tell("dac skip")
    answer = nano.hold(1500, 0.05)
    assert answer.flags == ARMED and answer.code == 1500


def test_a_dac_that_lost_its_code_is_told_again(nano: Nano) -> None:
    nano.arm()
    nano.hold(1500, 0.1)
    told = len(nano.events("dac"))
    nano.hold(1500, 0.1)
    again = [value for _, _, value in nano.events("dac")[told:]]
    assert len(again) >= 9 and set(again) == {1500}


def test_wrong_checksums_are_counted_and_not_obeyed(nano: Nano) -> None:
    nano.arm()
    frame = bytearray(nano.wire.ask(SET, set_payload(1500, False)))
    for at in range(1, len(frame)):
        damaged = bytearray(frame)
        damaged[at] ^= 0x10
        nano.raw(bytes(damaged), 0.01)
    answer = nano.status()
    assert answer.code == 0 and answer.crc_errors + answer.dropped >= len(frame) - 2


def test_the_same_number_again_is_answered_and_not_obeyed(nano: Nano) -> None:
    nano.arm()
    nano.hold(1000, 0.1)
    again = encode(Frame(nano.wire.number, SET, set_payload(1200, False)))
    (answer,) = (answer_of(payload) for payload in nano.raw(again))
    assert answer is not None and answer.code == 1000


def test_old_numbers_are_dropped_counted_and_not_answered(nano: Nano) -> None:
    nano.arm()
    nano.hold(1000, 0.1)
    before = nano.status().dropped
    assert nano.raw(encode(Frame(nano.wire.number - 2, SET, set_payload(1200, False)))) == []
    answer = nano.status()
    assert (answer.code, answer.dropped) == (1000, before + 1)


def test_a_vent_is_obeyed_whatever_its_number(nano: Nano) -> None:
    nano.arm()
    nano.hold(1000, 0.1)
    assert len(nano.raw(encode(Frame(nano.wire.number - 5, VENT)))) == 1
    assert nano.status().code == 0


def test_a_command_of_the_wrong_size_or_kind_is_dropped(nano: Nano) -> None:
    nano.arm()
    for command, payload in ((SET, b"\x01"), (VENT, b"\x01\x02"), (77, b""), (ARM, b"")):
        assert nano.raw(Wire(nano.wire.number + 1).ask(command, payload)) == []
    assert nano.status().dropped == 4


def test_a_half_command_does_not_hold_up_the_next(nano: Nano) -> None:
    nano.arm()
    half = nano.wire.ask(SET, set_payload(900, False))[:6]
    nano.raw(half, 0.01)
    assert nano.set(20).code == 20
    nano.raw(half, 0.0001)  # and at once behind it
    assert nano.set(30).code == 30


def test_sensors_are_means_of_eight_milliseconds(nano: Nano) -> None:
    nano.tell("flex 1234")
    nano.tell("monitor 3210")
    nano.arm()
    nano.run(0.02)
    answer = nano.status()
    volts = [each / 8 / 1024 * 5 for each in (answer.flex, answer.monitor)]
    assert volts == pytest.approx([1.234, 3.210], abs=0.01)  # two steps of the ADC
    nano.tell("flex 5000")
    nano.tell("monitor 0")
    nano.run(0.004)
    assert 0.3 < nano.status().flex / 8 / 1023 < 0.9
    nano.run(0.01)
    answer = nano.status()
    assert (answer.flex, answer.monitor) == (8 * 1023, 0)


def test_the_monitor_follows_with_a_lag_of_100_ms(nano: Nano) -> None:
    nano.arm()
    start = nano.hold(0, 0.1).monitor
    nano.hold(2000, 0.14)
    half, at = nano.status().monitor, nano.line.clock_s()
    end = nano.hold(2000, 1.0).monitor
    since = (
        at - 0.005 - next(t for t, _, code in nano.events("dac") if code)
    )  # the readings are 4 ms old, the answer takes 1
    after_ramp = 1 - 0.1 / 0.05 * math.expm1(0.05 / 0.1) * math.exp(
        -since / 0.1
    )  # a ramp of 50 ms through a lag of 100
    assert (half - start) / (end - start) == pytest.approx(after_ramp, abs=0.01)
    volts = end / 8 / 1024 * 5
    assert BENCH.monitor is not None
    assert BENCH.monitor.of(volts) == pytest.approx(BENCH.pressure_MPa(2000), abs=0.002)


def test_a_trigger_is_one_pulse_of_20_ms(nano: Nano) -> None:
    nano.arm()
    nano.set(100, trigger=True)
    nano.hold(100, 0.1)
    nano.set(100, trigger=True)
    assert nano.tell("state").triggers == 2
    (up, *_), (down, *_) = nano.events("trigger", "released")[:2]
    assert 0.019 < down - up < 0.021


def test_its_clock_counts_microseconds(nano: Nano) -> None:
    nano.hello()
    a, ta = nano.status().micros, nano.line.clock_s()
    nano.run(1.5)
    b, tb = nano.status().micros, nano.line.clock_s()
    assert (b - a) / 1e6 == pytest.approx(tb - ta, abs=0.0005)


def test_a_million_random_bytes_give_no_pressure(nano: Nano) -> None:
    noise = random.Random(3)
    nano.arm()
    for _ in range(20):
        nano.raw(noise.randbytes(2000), 0.05)
    assert highest(nano) == 0
    assert nano.arm().flags & ARMED  # and it still listens


def test_two_runs_are_the_same_to_the_microsecond(tmp_path: Path) -> None:
    logs = []
    for name in ("a", "b"):
        nano = Nano(tmp_path / name)
        nano.arm()
        nano.hold(700, 0.3)
        nano.vent()
        nano.emulator.close()
        logs.append(nano.events())
    assert logs[0] == logs[1]


def test_the_ceiling_in_the_sketch_is_the_benchs(tmp_path: Path) -> None:
    assert build(BENCH) == build(BENCH)
    assert build(BENCH)[1] != build(Bench("new"))[1]


@pytest.mark.parametrize("words", [["-x", "c++"], ["-x", "c", "-std=gnu99"], ["-x", "c++", "-DARDUINO=10819", "-c"]])
def test_it_builds_without_a_warning(words: list[str], tmp_path: Path) -> None:
    """As C++ as the Arduino IDE does, where main is the IDE's own; and as C."""
    sketch = files("benchlab") / "firmware" / "benchlab_nano" / "benchlab_nano.ino"
    done = subprocess.run(
        [*AVR[:4], "-Wall", "-Wextra", "-Werror", *words, str(sketch), "-o", str(tmp_path / "out")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
