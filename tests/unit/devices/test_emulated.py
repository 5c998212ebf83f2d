"""The emulated bench in real time, on a pty: the true serial path. And that it ends with its host."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from benchlab.devices import emulator as emulator_module
from benchlab.devices.emulated import open_emulated
from benchlab.devices.emulator import Emulator, build
from benchlab.devices.interface import Status
from benchlab.errors import BenchError
from tests.pace import best_cpu_s, slowness
from tests.unit.devices.killed_host import vented_after_s
from tests.unit.devices.nano import BENCH, needs_emulator


@needs_emulator
def test_a_run_in_real_time() -> None:
    device = open_emulated(BENCH, lockstep=False)
    process = device._line.emulator._process
    assert os.getsid(process.pid) != os.getsid(0)  # Ctrl-C is for the host, which still has to vent
    about = device.about()
    assert about["kind"] == "emulated" and not about["lockstep"] and about["port"].startswith("/dev/")
    device.arm()
    began, answered, last, tick = time.monotonic(), 0, None, 0
    while answered < 130 and tick < 3000:  # some are late on a busy computer; the bar is measured by tests/benchmarks
        reading = device.exchange(tick / 100, min(0.1, 0.002 * tick))
        if not reading.status & Status.NO_ANSWER:
            answered, last = answered + 1, reading
        tick += 1
        time.sleep(max(0.0, began + tick / 100 - time.monotonic()))
    device.vent()
    device.close()
    assert process.poll() is not None
    assert answered == 130
    assert last is not None and last.code == BENCH.code(0.1)
    assert last.pressure_MPa == pytest.approx(0.1, abs=0.005)


@needs_emulator
def test_in_lockstep_it_is_far_faster_than_real_time() -> None:
    device = open_emulated(BENCH, lockstep=True)
    device.arm()

    def one_second() -> None:
        began = device._last_s
        for tick in range(100):
            device.exchange(max(0.0, began) + (tick + 1) / 100, 0.1)

    took_s = best_cpu_s(one_second, 5)
    device.close()
    # Of this process; the emulator's share is measured by tests/benchmarks.
    assert 1 / took_s > 50 / slowness()


@needs_emulator
def test_a_killed_or_stopped_host_is_vented(tmp_path: Path) -> None:
    for how, _, silent_s in vented_after_s(tmp_path, 2):
        assert 0.15 < silent_s < 0.4, how  # 0.2 s and a little; the bar, 50 times, is measured by tests/benchmarks


@needs_emulator
@pytest.mark.parametrize("lockstep", [True, False])
def test_the_emulator_ends_with_its_host(lockstep: bool) -> None:
    code = f"""
from benchlab.bench import Bench
from benchlab.devices.emulator import Emulator
import os, signal
emulator = Emulator(Bench("a"), lockstep={lockstep})
print(emulator._process.pid, flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""
    host = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    pid = int(host.stdout)
    until = time.monotonic() + 60
    while _runs(pid) and time.monotonic() < until:
        time.sleep(0.01)
    assert not _runs(pid)


def _runs(pid: int) -> bool:
    try:
        os.kill(pid, 0)
        return (
            Path(f"/proc/{pid}/stat").read_text().split()[2] != "Z"
        )  # ended, and whoever inherited it has not looked yet
    except (ProcessLookupError, FileNotFoundError):
        return False


def test_missing_packages_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(emulator_module.shutil, "which", lambda tool: None)
    monkeypatch.setattr(emulator_module, "HEADERS", {"libsimavr-dev": Path("nowhere.h")})
    with pytest.raises(
        BenchError, match=r"needs gcc-avr avr-libc gcc libc6-dev libsimavr-dev, .*sudo apt install gcc"
    ) as told:
        open_emulated(BENCH, lockstep=True)
    assert told.value.exit_code == 5


@needs_emulator
def test_what_does_not_compile_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(emulator_module, "LIBRARIES", ("-lnowhere",))
    with pytest.raises(BenchError, match=r"the emulator does not compile: .*nowhere"):
        Emulator(BENCH, lockstep=True)


@needs_emulator
def test_it_is_compiled_once_and_a_cache_is_not_needed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    program, firmware = build(BENCH)
    assert program.parent == firmware.parent == tmp_path / "cache" / "benchlab"
    made = program.stat().st_mtime_ns
    assert build(BENCH)[0].stat().st_mtime_ns == made
    assert len(list(program.parent.iterdir())) == 2
    monkeypatch.setenv("XDG_CACHE_HOME", "/proc/nowhere")
    assert build(BENCH)[0].is_file()
