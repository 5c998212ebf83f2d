"""A host in mid run that is killed or stopped, and when the emulated Nano's DAC went to 0 after that."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchlab.bench import Bench
from benchlab.devices.emulator import Emulator

HOST = """
import sys, time
from benchlab.bench import Bench
from benchlab.devices.serial_bench import open_serial
device = open_serial(sys.argv[1], Bench("host", calibrated=True))
device.arm()
began, tick = time.monotonic(), 0
while True:
    if device.exchange(tick / 100, min(0.2, tick / 200)).code > 1000:
        print(time.monotonic(), flush=True)
    tick += 1
    time.sleep(max(0.0, began + tick / 100 - time.monotonic()))
"""


def vented_after_s(folder: Path, times: int, seed: int = 1) -> Iterator[tuple[str, float, float]]:
    """For each of so many hosts: how it went, KILL or STOP by turns; the seconds from then to code 0; and those from its last
    answer to code 0 by the Nano's own clock, which stands still where the computer is busy elsewhere.

    A host that the computer held up so long that its bench had vented already is left out, and another takes its place.
    """
    rng, log, index = random.Random(seed), folder / "events.txt", 0
    while index < times:
        # Each a Nano of its own: unlike a port, a pty stays closed to others when the host that closed it is killed.
        emulator = Emulator(Bench("host", calibrated=True), lockstep=False, log=log)
        try:
            how = (signal.SIGKILL, signal.SIGSTOP)[index % 2]
            host = subprocess.Popen([sys.executable, "-c", HOST, emulator.greeting], stdout=subprocess.PIPE, text=True)
            assert host.stdout is not None
            if not host.stdout.readline():
                raise RuntimeError("the host ended before it was killed")
            time.sleep(0.3 * rng.random())
            at = time.monotonic()
            host.send_signal(how)
            while (zero := first_zero(log)) == float("inf") and time.monotonic() < at + 60:
                time.sleep(0.02)
            host.kill()
            last = float(host.stdout.read().split()[-1])
            host.wait()
            host.stdout.close()
            if zero > at:
                index += 1
                yield how.name[3:], zero - at, device_s(log, zero) - device_s(log, last)
        finally:
            emulator.close()


def events(log: Path) -> list[tuple[float, float, str, str]]:
    """Seconds of the computer's clock, of the Nano's own, what, and its value; a line that is half written left out."""
    found = (line.split() for line in log.read_text().splitlines(keepends=True) if line.endswith("\n"))
    return [(float(at), float(micros) / 1e6, what, value) for at, micros, what, value in found]


def first_zero(log: Path) -> float:
    """When the DAC was first told 0 after it had been told more; infinity where it was not."""
    given = False
    for at_s, _, what, value in events(log):
        given = given or (what == "dac" and value != "0")
        if given and what == "dac" and value == "0":
            return at_s
    return float("inf")


def device_s(log: Path, at_s: float) -> float:
    """The Nano's own clock at a time of the computer's."""
    clocks = np.array([event[:2] for event in events(log)])
    return float(np.interp(at_s, *clocks.T))
