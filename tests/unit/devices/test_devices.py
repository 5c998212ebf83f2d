"""One body of checks over all benches: the firmware in lockstep, the same over a real serial port, the twin, and a replay."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from benchlab.devices.emulated import open_emulated
from benchlab.devices.emulator import Emulator
from benchlab.devices.serial_bench import open_serial
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


BEDS = [pytest.param(lockstep, marks=needs_emulator), pytest.param(serial, marks=needs_emulator)]


@pytest.mark.parametrize("bed", BEDS, ids=lambda bed: bed.__name__)
@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_device(check: Callable[[Bed], None], bed) -> None:
    with bed() as made:
        check(made)
