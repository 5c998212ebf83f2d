"""The emulator of the Nano: compiled where it is needed, and run as a process of its own (decision 0015)."""

from __future__ import annotations

import atexit
import functools
import hashlib
import os
import shutil
import subprocess
import tempfile
import typing
from contextlib import suppress
from importlib.resources import files
from pathlib import Path

from benchlab.bench import ADC_STEPS, Bench, Line
from benchlab.devices.firmware import firmware_text
from benchlab.devices.interface import LostError
from benchlab.errors import BenchError

NEEDS = {"avr-gcc": "gcc-avr avr-libc", "cc": "gcc libc6-dev"}
HEADERS = {"libsimavr-dev": Path("simavr/sim_avr.h"), "libelf-dev": Path("libelf.h")}
AVR = ("avr-gcc", "-mmcu=atmega328p", "-DF_CPU=16000000UL", "-Os", "-x", "c++")
HOST = ("cc", "-O2")
LIBRARIES = ("-l:libsimavr.a", "-lelf", "-lm", "-lpthread")

NOMINAL_MONITOR = Line(0.12, -0.12)
"""Of a bench whose monitor is not wired: 1 to 5 V for 0 to 0.48 MPa, as the regulator of the paper has."""

NOMINAL_COUNTS = 225.0
"""Of the chip's reference, 1.1 V, on a supply of 5 V: where a bench's calibration does not say."""

NOMINAL_FLEX = Line(100.0, -150.0)
NOMINAL_DEG_PER_MPA = 314.0
"""The emulation's actuator: 110° at 0.35 MPa, in a straight line."""


class State(typing.NamedTuple):
    """time_us: virtual. code, memory: of the DAC, now and at power-on. triggers: pulses so far. data: bytes sent since last told."""

    time_us: int
    code: int
    memory: int
    triggers: int
    data: bytes


class Emulator:
    """A running emulation. `tell` gives it a line of emulator.c's language. greeting: what it said first, the name of its pty.

    log: a file for its events. BenchError with the packages to install where it cannot be compiled.
    """

    def __init__(self, bench: Bench, lockstep: bool, log: Path | None = None) -> None:
        program, firmware = build(bench)
        words = [str(program), str(firmware), "lockstep" if lockstep else "pty", *_sensors(bench)]
        self._process = subprocess.Popen(
            [*words, *([str(log)] if log else [])],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,  # Ctrl-C is for the host, which still has to vent
        )
        self._input = typing.cast(typing.TextIO, self._process.stdin)
        self._output = typing.cast(typing.TextIO, self._process.stdout)
        self._errors = typing.cast(typing.TextIO, self._process.stderr)
        self.greeting = self._line()

    def tell(self, line: str) -> State:
        """LostError where the emulator has ended."""
        try:
            self._input.write(line + "\n")
            self._input.flush()
        except (OSError, ValueError) as error:
            raise LostError(f"the emulator has ended: {error}") from error
        time_us, code, memory, triggers, data = self._line().split()
        return State(int(time_us), int(code), int(memory), int(triggers), bytes.fromhex(data.strip("-")))

    def close(self) -> None:
        """Idempotent. It ends as soon as nobody holds its input, so it ends with this process too."""
        for pipe in (self._input, self._output, self._errors):
            with suppress(OSError):
                pipe.close()
        self._process.kill()
        self._process.wait()

    def _line(self) -> str:
        line = "" if self._output.closed else self._output.readline()
        if not line:
            said = "" if self._errors.closed else self._errors.read().strip()
            raise LostError(f"the emulator has ended: {said or 'it did not say why'}")
        return line.strip()


def build(bench: Bench) -> tuple[Path, Path]:
    """The emulator, and this bench's firmware for it; compiled once for each text and kept in the user's cache.

    BenchError where compilers or simavr are missing or refuse.
    """
    missing = missing_packages()
    if missing:
        raise BenchError(
            f"the emulated bench needs {' '.join(missing)}, not found here",
            hint=f"on Debian or Ubuntu: sudo apt install {' '.join(missing)}",
        )
    source = (files("benchlab") / "firmware" / "emulator" / "emulator.c").read_text(encoding="utf-8")
    return _compiled("emulator", source, ".c", HOST, LIBRARIES), _compiled(
        "nano", firmware_text(bench), ".ino", AVR, ()
    )


def missing_packages() -> list[str]:
    """Debian's names of what the emulated bench needs and this computer has not got.

    >>> set(missing_packages()) <= {"gcc-avr", "avr-libc", "gcc", "libc6-dev", "libsimavr-dev", "libelf-dev"}
    True
    """
    missing = [
        package for tool, packages in NEEDS.items() if shutil.which(tool) is None for package in packages.split()
    ]
    places = [
        Path("/usr/include"),
        Path("/usr/local/include"),
        *map(Path, os.environ.get("CPATH", "").split(os.pathsep)),
    ]
    return missing + [p for p, header in HEADERS.items() if not any((place / header).exists() for place in places)]


def _compiled(name: str, source: str, suffix: str, compiler: tuple[str, ...], libraries: tuple[str, ...]) -> Path:
    key = hashlib.sha256("\0".join([source, *compiler, *libraries]).encode()).hexdigest()[:16]
    made = _cache() / f"{name}-{key}"
    if made.exists():
        return made
    with tempfile.TemporaryDirectory(dir=made.parent) as folder:
        text, fresh = Path(folder) / f"{name}{suffix}", Path(folder) / name
        text.write_text(source, encoding="utf-8")
        done = subprocess.run(
            [*compiler, str(text), "-o", str(fresh), *libraries], capture_output=True, text=True, check=False
        )
        if done.returncode:
            lines = done.stderr.splitlines()
            first = next(
                (line for line in lines if "error" in line or "cannot find" in line), done.stderr.strip()[:200]
            )
            raise BenchError(f"the {name} does not compile: {first}", hint="sudo apt install libsimavr-dev avr-libc")
        fresh.replace(made)
    return made


def _cache() -> Path:
    """The user's cache or, where it cannot be written, a folder for this process alone."""
    home = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    try:
        folder = Path(home).expanduser() / "benchlab"
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return folder
    except (OSError, RuntimeError):
        pass
    return _folder_of_this_process()


@functools.cache
def _folder_of_this_process() -> Path:
    folder = tempfile.mkdtemp(prefix="benchlab-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def _sensors(bench: Bench) -> list[str]:
    """The supply, the chip's reference, and each sensor's offset (mV) and gain (volts per volt at the DAC), so that the bench reads
    them as it is calibrated."""
    regulator = bench.regulator
    words = [f"{1000 * bench.supply_V:.0f}", f"{1000 * _reference_V(bench):.0f}"]
    for sensor, per_MPa in ((bench.monitor or NOMINAL_MONITOR, 1.0), (bench.flex or NOMINAL_FLEX, NOMINAL_DEG_PER_MPA)):
        gain = per_MPa * regulator.gain / sensor.gain
        words += [f"{1000 * sensor.inverse(per_MPa * regulator.offset):.6g}", f"{gain:.9g}"]
    return words


def _reference_V(bench: Bench) -> float:
    """So that the emulation counts what this bench did; half a count more, as simavr rounds down, to 1023 at the supply."""
    counts, supply_V = bench.reference_counts, bench.supply_V
    if counts is None:
        counts, supply_V = NOMINAL_COUNTS, 5.0
    return (counts + 0.5) / (ADC_STEPS - 1) * supply_V
