"""Bench files for tests."""

from __future__ import annotations

import math
from pathlib import Path

from benchlab.bench import Bench
from benchlab.io.bench_file import BenchFile, write_bench_file
from benchlab.io.gauge_readings import GaugeReading

VOLTS = (0.5, 1.0, 2.0, 3.0, 2.0, 1.0)


def readings_of(bench: Bench) -> tuple[GaugeReading, ...]:
    """Exact readings on the lines of a bench, so that its file can be read; at whole codes."""
    found = []
    for index, wanted in enumerate(VOLTS):
        code = round(wanted / bench.supply_V * 4096)
        pressure = bench.regulator.of(bench.volts(code))
        monitor = math.nan if bench.monitor is None else bench.monitor.inverse(pressure)
        found.append(GaugeReading(bench.volts(code), pressure, monitor, index < 4, code))
    return tuple(found)


def write_bench(path: Path, bench: Bench) -> None:
    """A calibrated bench as a file."""
    write_bench_file(path, BenchFile(bench, readings_of(bench), flex_from="a test" if bench.flex else ""))
