"""The emulated bench: the firmware itself, on an emulated Nano. Nothing here is measured."""

from __future__ import annotations

import typing
from pathlib import Path

from benchlab.bench import Bench
from benchlab.devices.emulator import NOMINAL_COUNTS, NOMINAL_FLEX, NOMINAL_MONITOR, Emulator
from benchlab.devices.serial_bench import SerialBench
from benchlab.devices.transport import SerialTransport


class LockstepTransport:
    """A line to an emulator whose time moves only here: every run gives the same bytes at the same microsecond."""

    name = "emulated"

    def __init__(self, emulator: Emulator) -> None:
        self.emulator = emulator
        self._now_us = 0
        self._asked = b""

    def about(self) -> dict[str, typing.Any]:
        return {"emulator": "simavr", "lockstep": True}

    def clock_s(self) -> float:
        return self._now_us / 1e6

    def advance(self, time_s: float) -> None:
        self._now_us = max(self._now_us, round(1e6 * time_s))

    def write(self, data: bytes) -> None:
        self._asked += data

    def read(self, timeout_s: float) -> bytes:
        until_us = self._now_us + max(1, round(1e6 * timeout_s))
        state = self.emulator.tell(f"ask {self._now_us} {until_us} {self._asked.hex() or '-'}")
        self._asked = b""
        self._now_us = max(self._now_us, state.time_us)
        return state.data

    def close(self) -> None:
        self.emulator.close()


class PtyTransport(SerialTransport):
    """The pty of an emulator in real time, which ends with it."""

    def __init__(self, emulator: Emulator) -> None:
        self.emulator = emulator
        super().__init__(emulator.greeting)

    def about(self) -> dict[str, typing.Any]:
        return {"emulator": "simavr", "lockstep": False, **super().about()}

    def close(self) -> None:
        super().close()
        self.emulator.close()


def emulated_bench() -> Bench:
    """The calibration of the emulation where none is given: exact, as its regulator and sensors are made after it.

    >>> bench = emulated_bench()
    >>> bench.code(0.35), bench.monitor.of(5.0), bench.flex.of(2.6)
    (2986, 0.48, 110.0)
    """
    return Bench(
        "emulated",
        monitor=NOMINAL_MONITOR,
        flex=NOMINAL_FLEX,
        reference_counts=NOMINAL_COUNTS,
        gauge="none: simulated",
        calibrated=True,
    )


def open_emulated(bench: Bench, lockstep: bool, log: Path | None = None) -> SerialBench:
    """The firmware with this bench's ceiling on an emulated Nano, with a regulator that lags by 0.1 s and an actuator that bends in a
    straight line. lockstep: time follows `exchange`, as fast as it can; else it is real, over a pty. log: file for the emulator's events.

    BenchError with the packages to install where it cannot be compiled here.
    """
    emulator = Emulator(bench, lockstep, log)
    try:
        line = LockstepTransport(emulator) if lockstep else PtyTransport(emulator)
        return SerialBench(line, bench, kind="emulated")
    except BaseException:
        emulator.close()
        raise
