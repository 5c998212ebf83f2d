"""One body of checks over all benches: the firmware in lockstep, the same over a real serial port, the twin, and a replay."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import replace

import numpy as np
import pytest

from benchlab.devices.emulated import open_emulated
from benchlab.devices.emulator import Emulator
from benchlab.devices.interface import Device, Reading
from benchlab.devices.replay import Replay
from benchlab.devices.serial_bench import open_serial
from benchlab.devices.twin.bench import twin_bench
from benchlab.devices.twin.twin import Twin
from benchlab.errors import BenchError
from benchlab.io.journal import SAMPLE
from benchlab.io.twin_file import read_twin
from tests.unit.devices.device_body import CHECKS, Bed
from tests.unit.devices.nano import BENCH, needs_emulator


@contextmanager
def lockstep() -> Iterator[Bed]:
    device = open_emulated(BENCH, lockstep=True)
    yield Bed(device, BENCH)
    device.close()


@contextmanager
def serial() -> Iterator[Bed]:
    """pyserial, a pty, and the firmware in real time."""
    emulator = Emulator(BENCH, lockstep=False)
    device = open_serial(emulator.greeting, BENCH)
    yield Bed(device, BENCH, live=True)
    device.close()
    emulator.close()


@contextmanager
def twin() -> Iterator[Bed]:
    bench = twin_bench()
    device = Twin(read_twin(None), bench)
    yield Bed(device, bench)
    device.close()


class Recorded:
    """Any device, with a row of SAMPLE for each exchange that it answered."""

    def __init__(self, device: Device) -> None:
        self.device, self.kind, self.rows = device, device.kind, []
        self.about, self.arm, self.vent, self.faults = device.about, device.arm, device.vent, device.faults
        self.close = device.close

    def exchange(self, time_s: float, pressure_MPa: float, trigger: bool = False) -> Reading:
        reading = self.device.exchange(time_s, pressure_MPa, trigger)
        row = np.zeros((), SAMPLE)
        row["tick"], row["command_MPa"], row["status"] = len(self.rows), pressure_MPa, int(reading.status)
        for name in ("pressure_MPa", "flex_V", "code", "device_time_s", "monitor_V"):
            row[name] = getattr(reading, name)
        self.rows.append(row)
        return reading

    def samples(self) -> np.ndarray:
        return np.array(self.rows, SAMPLE)


def over_replay(check: Callable[[Bed], None]) -> None:
    """Recorded on the twin, then played back. A replay knows what was recorded, and no limit of its own."""
    with twin() as bed:
        recorded = Recorded(bed.device)
        check(replace(bed, device=recorded))
        device = Replay(recorded.samples(), bed.device.about())
        check(Bed(device, bed.bench, over_limit=BenchError))


def over(bed: Callable[[], AbstractContextManager[Bed]]) -> Callable[[Callable[[Bed], None]], None]:
    def run(check: Callable[[Bed], None]) -> None:
        with bed() as made:
            check(made)

    return run


BENCHES = [
    pytest.param(over(lockstep), marks=needs_emulator, id="lockstep"),
    pytest.param(over(serial), marks=needs_emulator, id="serial"),
    pytest.param(over(twin), id="twin"),
    pytest.param(over_replay, id="replay"),
]


@pytest.mark.parametrize("bench", BENCHES)
@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_device(check: Callable[[Bed], None], bench: Callable[[Callable[[Bed], None]], None]) -> None:
    bench(check)
