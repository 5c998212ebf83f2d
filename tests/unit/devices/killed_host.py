"""A host in mid run that is killed or stopped, and when the emulated Nano's DAC went to 0 after that."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

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
    if device.exchange(tick / 100, min(0.2, tick / 200)).code > 1000 and tick % 20 == 0:
        print("running", flush=True)
    tick += 1
    time.sleep(max(0.0, began + tick / 100 - time.monotonic()))
"""


def vented_after_s(folder: Path, times: int, seed: int = 1) -> Iterator[tuple[str, float]]:
    """For each of so many hosts: how it went, KILL or STOP by turns, and the seconds from then to code 0."""
    rng, log = random.Random(seed), folder / "events.txt"
    for index in range(times):
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
            while (zero := first_zero(log, at)) == float("inf") and time.monotonic() < at + 2:
                time.sleep(0.02)
            yield how.name[3:], zero - at
            host.kill()
            host.wait()
            host.stdout.close()
        finally:
            emulator.close()


def first_zero(log: Path, after_s: float) -> float:
    """When the DAC was first told 0 after a moment; infinity where it was not."""
    for line in log.read_text().splitlines():
        at_s, _, what, value = line.split()
        if float(at_s) > after_s and what == "dac" and value == "0":
            return float(at_s)
    return float("inf")
