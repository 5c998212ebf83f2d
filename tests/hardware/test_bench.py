"""A bench of metal: only with BENCHLAB_PORT set. Actuator off, outlet closed, relief valve on.

BENCHLAB_PORT=/dev/ttyUSB0 BENCHLAB_CALIBRATION=bench.yaml python -m pytest -n0 tests/hardware
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchlab.bench import Bench, LimitError
from benchlab.devices.interface import Status
from benchlab.devices.serial_bench import SerialBench, open_serial
from benchlab.errors import BenchError
from benchlab.io.bench_file import read_bench
from benchlab.runner.clock import RealClock

PORT = os.environ.get("BENCHLAB_PORT")
HARMLESS_MPA = 0.02

pytestmark = pytest.mark.skipif(PORT is None, reason="BENCHLAB_PORT is not set: no bench of metal is touched")


@pytest.fixture
def bench() -> Bench:
    told = os.environ.get("BENCHLAB_CALIBRATION")
    return read_bench(Path(told) if told else None)


@pytest.fixture
def device(bench: Bench) -> Iterator[SerialBench]:
    assert PORT is not None
    device = open_serial(PORT, bench)
    yield device
    device.close()


def test_it_says_hello_with_its_limits(device: SerialBench, bench: Bench) -> None:
    about = device.about()
    assert about["ceiling_code"] <= bench.ceiling_code, about["notes"]
    assert about["silence_s"] <= 0.2 and not about["notes"]


def test_it_gives_nothing_before_it_is_armed_and_nothing_above_its_limit(device: SerialBench, bench: Bench) -> None:
    with pytest.raises(BenchError, match="not armed"):
        device.exchange(0.0, HARMLESS_MPA)
    device.arm()
    for pressure in (bench.ceiling_MPa + 0.001, math.nan, -0.001):
        with pytest.raises(LimitError):
            device.exchange(0.0, pressure)
    device.vent()


def test_it_vents_and_says_so(device: SerialBench) -> None:
    device.arm()
    assert device.exchange(0.0, HARMLESS_MPA).status & Status.ARMED
    device.vent()
    reading = device.exchange(0.01, 0.0)
    assert reading.code == 0 and not reading.status & Status.ARMED


def test_it_vents_when_nobody_speaks(device: SerialBench) -> None:
    device.arm()
    device.exchange(0.0, HARMLESS_MPA)
    time.sleep(0.3)
    reading = device.exchange(0.3, 0.0)
    assert reading.code == 0 and reading.status & Status.SILENCE


def test_ten_seconds_at_100_Hz(device: SerialBench, bench: Bench) -> None:
    clock = RealClock()
    device.arm()
    clock.start()
    answered, codes = 0, set()
    for tick in range(1000):
        clock.wait_until(tick / 100)
        reading = device.exchange(clock.now_s(), HARMLESS_MPA)
        answered += not reading.status & Status.NO_ANSWER
        codes.add(reading.code)
    device.vent()
    assert answered >= 995, device.faults()
    assert max(codes) == bench.code(HARMLESS_MPA)
