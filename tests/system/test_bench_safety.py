"""Paths on which pressure could be left on, or be more than was meant, tried on a Nano at a pty: none does."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchlab.io.bench_file import read_bench
from benchlab.io.journal import read_journal
from tests.system.patience import LATE, LONG_S, PATIENT, be_patient, wait_until
from tests.system.small_nano import SmallNano

CALIBRATION = """name: left
date: '{date}'
gauge: test
supply_V: {supply_V}
regulator: {{gain_MPa_per_V: 0.0965, offset_MPa: -0.001}}
monitor: {{gain_MPa_per_V: 0.12, offset_MPa: -0.12}}
readings:
- {{volts: 0.5, pressure_MPa: 0.04725, monitor_V: 1.39375}}
- {{volts: 1.0, pressure_MPa: 0.0955, monitor_V: 1.7958333}}
- {{volts: 2.0, pressure_MPa: 0.192, monitor_V: 2.6}}
- {{volts: 3.0, pressure_MPa: 0.2885, monitor_V: 3.4041667}}
"""
PROTOCOL = """title: hold
limit_MPa: 0.15
segments:
  - ramp: {to_MPa: 0.1, duration_s: 0.2}
  - hold: {duration_s: 0.5}
"""
HELD_MPA = 0.1


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    bench, protocol = tmp_path / "bench.yaml", tmp_path / "hold.yaml"
    bench.write_text(CALIBRATION.format(date="2026-05-31", supply_V=4.9))
    protocol.write_text(PROTOCOL)
    return bench, protocol


@pytest.fixture
def nano(files: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch) -> Iterator[SmallNano]:
    be_patient(monkeypatch)
    with SmallNano(read_bench(files[0]).ceiling_code) as nano:
        yield nano


def words(nano: SmallNano, bench: Path, protocol: Path) -> list[str]:
    where = ["--bench", f"serial:{nano.port}", "--calibration", str(bench), "--name", "r", "--out", str(bench.parent)]
    return ["run", str(protocol), *where, *LATE]


def stop_of(folder: Path) -> dict:
    stop = read_journal(folder / "r.journal").stop
    assert stop is not None
    return stop


def test_a_run_gives_what_was_asked_for_and_ends_vented(benchlab, nano: SmallNano, files, tmp_path: Path) -> None:
    done = benchlab(*words(nano, *files))
    assert done.code == 0, done.err
    assert nano.highest_code == read_bench(files[0]).code(HELD_MPA)
    assert nano.code == 0 and not nano.armed and "silence" not in nano.vents
    assert stop_of(tmp_path)["vented"]


def test_a_firmware_that_gives_less_is_told_before_anything_is_armed(
    benchlab, nano: SmallNano, files, tmp_path
) -> None:
    nano.ceiling_code = read_bench(files[0]).code(HELD_MPA) - 5
    done = benchlab(*words(nano, *files))
    assert done.code == 5 and "asks for 0.1 MPa" in done.err and "benchlab bench firmware" in done.err
    assert nano.highest_code == 0 and not list(tmp_path.glob("r.*"))


def test_a_firmware_that_never_falls_silent_is_refused_before_anything_is_armed(
    benchlab, nano: SmallNano, files, tmp_path
) -> None:
    nano.silence_ms = 0
    done = benchlab(*words(nano, *files))
    assert done.code == 5 and "silence limit is 0 ms, not 50 to 500" in done.err
    assert nano.highest_code == 0 and not list(tmp_path.glob("r.*"))


def test_a_supply_that_has_risen_is_refused_before_anything_is_armed(
    benchlab, nano: SmallNano, files, tmp_path
) -> None:
    files[0].write_text(CALIBRATION.format(date="2026-05-31", supply_V=4.6))  # it is 4.9
    done = benchlab(*words(nano, *files))
    assert done.code == 5 and "supply were 4.9" in done.err and "measure the supply" in done.err
    assert nano.highest_code == 0 and not list(tmp_path.glob("r.*"))


def test_a_flex_line_with_a_wrong_sign_is_refused_before_anything_is_armed(
    benchlab, nano: SmallNano, files, tmp_path: Path
) -> None:
    """The sensor gives 1 V at rest."""
    line = "flex: {gain_deg_per_V: 66.7, offset_deg: 66.7, sd_deg: 0.1, from: a test}\n"
    files[0].write_text(CALIBRATION.format(date="2026-05-31", supply_V=4.9) + line)
    done = benchlab(*words(nano, *files))
    assert done.code == 5 and "reads 133." in done.err and "offset_deg" in done.err
    assert nano.highest_code == 0 and not list(tmp_path.glob("r.*"))


def test_without_a_monitor_the_nanos_own_measurement_shows_a_supply_that_has_risen(
    benchlab, nano: SmallNano, files, tmp_path: Path
) -> None:
    """Of 1.1 V it counts 229.9 on 4.9 V, and counted 237 on the 4.75 V that it was calibrated with: 3 % more pressure."""
    text = CALIBRATION.format(date="2026-05-31", supply_V="4.75\nreference_counts: 237.1")
    text = text.replace("monitor: {gain_MPa_per_V: 0.12, offset_MPa: -0.12}\n", "")
    files[0].write_text(text)
    nano.ceiling_code, nano.counts = read_bench(files[0]).ceiling_code, 1.1 * 1024 / 4.9
    done = benchlab(*words(nano, *files))
    assert done.code == 5, done.err
    assert "the supply is 4.90 V, calibrated at 4.75 V" in done.err and "the USB port" in done.err
    assert nano.highest_code == 0 and not list(tmp_path.glob("r.*"))
    files[0].write_text(text.replace("4.75", "4.9").replace("237.1", "229.9"))
    done = benchlab(*words(nano, *files))
    assert done.code == 0 and "supply" not in done.err and nano.code == 0


def test_a_bench_is_vented_whatever_its_supply(benchlab, nano: SmallNano, files) -> None:
    """Only runs are refused."""
    files[0].write_text(CALIBRATION.format(date="2026-05-31", supply_V="4.75\nreference_counts: 237.1"))
    nano.counts, nano.code = 1.1 * 1024 / 4.9, 500
    done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}", "--calibration", files[0])
    assert done.code == 0 and nano.code == 0


def test_a_bench_that_is_not_empty_is_not_armed(benchlab, nano: SmallNano, files, monkeypatch) -> None:
    from benchlab.workflows import bench_zero

    monkeypatch.setattr(bench_zero, "WAIT_S", 0.2)
    nano.sticks_MPa = 0.05
    done = benchlab(*words(nano, *files))
    assert done.code == 5 and "shows 50" in done.err and nano.highest_code == 0


def test_an_old_calibration_is_told_with_the_run(benchlab, nano: SmallNano, files) -> None:
    files[0].write_text(CALIBRATION.format(date="2020-05-31", supply_V=4.9))
    done = benchlab(*words(nano, *files))
    assert done.code == 0 and "calibrate it at least once a year" in done.err


def test_a_vent_that_nobody_confirms_is_told_loudly(
    benchlab, nano: SmallNano, files, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from benchlab.devices.messages import SET, VENT

    monkeypatch.setattr("benchlab.devices.conversation.TRY_S", 0.1)
    answer = nano.answer

    def deaf_once_armed(frame) -> None:
        if frame.command == SET and nano.armed:
            nano.deaf_to = (VENT,)
        answer(frame)

    nano.answer = deaf_once_armed
    done = benchlab(*words(nano, *files))
    assert done.code == 5 and "NOT CONFIRMED VENTED" in done.err and "by hand" in done.err
    assert not stop_of(tmp_path)["vented"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL, signal.SIGSTOP])
def test_every_signal_ends_vented(nano: SmallNano, files, tmp_path: Path, number: signal.Signals) -> None:
    files[1].write_text(PROTOCOL.replace("0.5", "1200"))
    running = subprocess.Popen([*PATIENT, *words(nano, *files)], stderr=subprocess.DEVNULL)
    try:
        wait_until(lambda: nano.pressure_MPa >= 0.99 * HELD_MPA, lambda: running.poll() is None)
        running.send_signal(number)
        wait_until(lambda: not nano.armed)  # how soon is measured with the true firmware
        assert nano.code == 0
        by_firmware = number in (signal.SIGKILL, signal.SIGSTOP)
        assert (nano.vents[-1] == "silence") == by_firmware
        if not by_firmware:
            assert running.wait(LONG_S) == 130 and stop_of(tmp_path)["vented"]
        else:
            assert not read_journal(tmp_path / "r.journal").complete
    finally:
        running.kill()
        running.wait()


def test_a_closed_terminal_ends_vented(nano: SmallNano, files, tmp_path: Path) -> None:
    files[1].write_text(PROTOCOL.replace("0.5", "1200"))
    pid, terminal = pty.fork()
    if pid == 0:
        os.execv(sys.executable, [*PATIENT, *words(nano, *files)])
    wait_until(lambda: nano.pressure_MPa >= 0.99 * HELD_MPA)
    assert nano.armed
    os.close(terminal)
    wait_until(lambda: not nano.armed)
    assert nano.code == 0 and nano.vents[-1] == "vent"
    os.waitpid(pid, 0)
    assert stop_of(tmp_path)["reason"] == "hung up"


def test_ctrl_c_while_the_port_does_not_answer_leaves_at_once_or_soon(nano: SmallNano, files) -> None:
    nano.deaf_to = (1, 2, 3, 4, 5)
    running = subprocess.Popen(
        [sys.executable, "-m", "benchlab", *words(nano, *files)], stderr=subprocess.PIPE, text=True
    )
    wait_until(lambda: nano.heard)
    running.send_signal(signal.SIGINT)
    assert running.wait(LONG_S) in (5, 130)
    assert nano.highest_code == 0
