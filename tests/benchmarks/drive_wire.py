"""What the line to the bench and the firmware reach: `python tests/benchmarks/drive_wire.py [pty] [killed] [noise] [lockstep]` prints a table.

pty: a loop at 100 Hz with the emulated firmware in real time, and at 500 Hz; as root, the emulator does not wait for other work
(decision 0015). killed: hosts killed or stopped in mid run, and how long the DAC held. noise: random bytes and damaged frames in lockstep.
lockstep: how much faster than real time. Each gives rows of bar, figure, and whether it is met (None: measured, no bar).
"""

from __future__ import annotations

import os
import random
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
Row = tuple[str, str, bool | None]


def pty(seconds: float = 60.0) -> list[Row]:
    """Absolute deadlines, on whatever machine this is."""
    rows = []
    for rate_Hz, seconds_, bar in ((100, seconds, 0.995), (500, min(seconds, 20.0), None)):
        answered, late, trips = _loop(rate_Hz, seconds_)
        share, (p50, p99, worst) = answered / len(trips), 1000 * np.percentile(trips, (50, 99, 100))
        rows.append(
            (
                f"emulated firmware on the pty, {rate_Hz} Hz, {seconds_:g} s"
                + (": ≥ 99.5 % answered in their period" if bar else ""),
                f"{100 * share:.2f} % of {len(trips)}; round trip p50 {p50:.2f}, p99 {p99:.2f}, worst {worst:.1f} ms; "
                f"ticks begun over 1 ms late: {late}",
                None if bar is None else share >= bar,
            )
        )
    return rows


def _loop(rate_Hz: int, seconds: float) -> tuple[int, int, list[float]]:
    """How many of the exchanges were answered within a period, how many began late, and the time that each took."""
    from benchlab.bench import Bench
    from benchlab.devices.emulated import open_emulated
    from benchlab.devices.interface import Status

    device = open_emulated(Bench("pty", calibrated=True), lockstep=False)
    device.arm()
    answered, late, trips = 0, 0, []
    began = time.monotonic()
    for tick in range(round(rate_Hz * seconds)):
        due = began + tick / rate_Hz
        while (left := due - time.monotonic()) > 0.0002:
            time.sleep(left - 0.0002)
        while (now := time.monotonic()) < due:
            pass
        late += now - due > 0.001
        reading = device.exchange(now - began, 0.1 + 0.1 * np.sin(now - began))
        trips.append(time.monotonic() - now)
        answered += not reading.status & Status.NO_ANSWER and trips[-1] <= 1 / rate_Hz
    device.vent()
    device.close()
    return answered, late, trips


def killed(times: int = 50) -> list[Row]:
    from tests.unit.devices.killed_host import vented_after_s

    with tempfile.TemporaryDirectory() as folder:
        took = list(vented_after_s(Path(folder), times))
    within, seconds = sum(s <= 0.25 for _, s, _ in took), [s for _, s, _ in took]
    figure = f"{within} of {times}, {1000 * min(seconds):.0f} to {1000 * max(seconds):.0f} ms"
    return [
        (f"host killed (SIGKILL) or stopped (SIGSTOP) {times} times: vented within 250 ms", figure, within == times)
    ]


def noise(millions: float = 1.0, faults: int = 600) -> list[Row]:
    return [_noise(round(1e6 * millions)), _single_faults(faults), _storm(10_000)]


def _armed(folder: Path):
    """A bench in lockstep, its faulty line, its emulator and the highest code so far."""
    from benchlab.devices.emulated import LockstepTransport
    from benchlab.devices.emulator import Emulator
    from benchlab.devices.serial_bench import SerialBench
    from tests.unit.devices.faulty_line import FaultyLine
    from tests.unit.devices.nano import BENCH

    log = folder / "events.txt"
    emulator = Emulator(BENCH, lockstep=True, log=log)
    line = FaultyLine(LockstepTransport(emulator))
    device = SerialBench(line, BENCH)
    device.arm()

    def highest_code() -> int:
        return max(int(row.split()[3]) for row in log.read_text().splitlines() if " dac " in row)

    return device, line, BENCH, highest_code


def _noise(size: int) -> Row:
    """Random bytes both ways before each frame, 50 at a time, while a bench is driven at 0.1 MPa; then a vent that is confirmed."""
    from benchlab.devices.interface import Status

    rng, told, answered = random.Random(1), Counter[str](), 0
    with tempfile.TemporaryDirectory() as folder:
        device, line, bench, highest_code = _armed(Path(folder))
        ticks, longest = size // 100, 0.0
        read, write = line.line.read, line.line.write

        def noisy_read(timeout_s: float) -> bytes:
            data = read(timeout_s)
            return rng.randbytes(50) + data if data else data

        line.line.read = noisy_read
        line.line.write = lambda data: write(rng.randbytes(50) + data)
        for tick in range(ticks):
            before = line.clock_s()
            reading = device.exchange(tick / 100, 0.1)
            longest = max(longest, line.clock_s() - before)
            answered += not reading.status & Status.NO_ANSWER
            told.update({fault.cause: fault.count for fault in device.faults()})
        line.line.write, line.line.read = write, read
        device.vent()
        ok = highest_code() == bench.code(0.1)
        device.close()
    figure = (
        f"highest code {'never' if ok else 'ABOVE'} over what was asked; {100 * answered / ticks:.1f} % of {ticks} commands answered; "
        f"longest exchange {1000 * longest:.0f} ms; {sum(told.values())} faults told"
    )
    return (
        f"{size / 1e6:g} MB of random bytes on the wire: no pressure above the limit, no hang",
        figure,
        ok and longest < 0.05,
    )


CAUSES = {
    ("down", "lose"): "no answer",
    ("down", "flip"): "wrong checksum",
    ("down", "cut"): "unfinished",
    ("down", "double"): "twice",
    ("down", "late"): "no answer",
    ("down", "swap"): "old, unfinished",
    ("up", "lose"): "no answer",
    ("up", "flip"): "wrong checksum",
    ("up", "cut"): "wrong checksum",
    ("up", "double"): "twice",
    ("up", "late"): "late",
    ("up", "swap"): "late",
}
"""Way and fault, and the words that its cause must be told with."""


def _single_faults(count: int) -> Row:
    """One fault at a time, of each kind by turns, five quiet ticks after each. A bit flipped in the sync or the size makes a frame that
    cannot be read, which is told so."""
    missed = Counter[str]()
    with tempfile.TemporaryDirectory() as folder:
        device, line, bench, highest_code = _armed(Path(folder))
        tick = 0
        for index in range(count):
            (way, fault), words = list(CAUSES.items())[index % len(CAUSES)]
            getattr(line, way).append(fault)
            causes = ""
            for _ in range(6):
                device.exchange(tick / 100, 0.2)
                tick += 1
                causes += " | ".join(each.cause for each in device.faults())
            also = ("unreadable", "no frame", "wrong checksum") if fault == "flip" else (words,)
            if not any(each in causes for each in (words, *also)):
                missed[f"{way} {fault}: {causes or 'nothing'}"] += 1
        device.vent()
        ok = highest_code() == bench.code(0.2)
        device.close()
    figure = f"{count - sum(missed.values())} of {count} told with their cause, no pressure above what was asked: {ok}"
    if missed:
        figure += f"; missed: {dict(missed)}"
    return (
        f"{count} lost, doubled, cut, flipped, delayed, reordered frames: each told with its cause",
        figure,
        ok and not missed,
    )


def _storm(ticks: int) -> Row:
    """More than half of all frames wrong, pressures at random: never more than was asked."""
    rng = random.Random(2)
    words = ["ok"] * 8 + ["lose", "double", "flip", "cut", "noise", "late", "swap"]
    with tempfile.TemporaryDirectory() as folder:
        device, line, bench, highest_code = _armed(Path(folder))
        for tick in range(ticks):
            line.down.append(rng.choice(words))
            line.up.append(rng.choice(words))
            device.exchange(tick / 100, bench.ceiling_MPa * rng.random())
        told = sum(fault.count for fault in device.faults())
        line.down.clear()
        line.up.clear()
        device.vent()
        ok = highest_code() <= bench.ceiling_code
        device.close()
    return (
        f"{ticks} commands, 7 of 15 frames each way wrong: no pressure above the limit, vented at the end",
        f"{told} faults told",
        ok,
    )


def lockstep(seconds: float = 120.0) -> list[Row]:
    """By the clock on the wall, and by the processors' time of both processes, which other work on the machine moves less."""
    from benchlab.bench import Bench
    from benchlab.devices.emulated import open_emulated

    def used_s() -> float:
        times = os.times()
        return times.user + times.system + times.children_user + times.children_system

    began, used = time.monotonic(), used_s()
    device = open_emulated(Bench("lockstep", calibrated=True), lockstep=True)
    device.arm()
    for tick in range(round(100 * seconds)):
        device.exchange(tick / 100, 0.1)
    device.close()
    times, by_processor = seconds / (time.monotonic() - began), seconds / (used_s() - used)
    figure = f"{times:.0f} ×; {by_processor:.0f} × by processor time"
    return [("emulated firmware in lockstep, 100 Hz: ≥ 50 × real time", figure, times >= 50)]


PARTS = {"pty": pty, "killed": killed, "noise": noise, "lockstep": lockstep}


def main() -> None:
    for name in sys.argv[1:] or list(PARTS):
        for bar, figure, met in PARTS[name]():
            print(f"{'–' if met is None else 'met' if met else 'NOT MET':8}{bar}\n        {figure}", flush=True)


if __name__ == "__main__":
    main()
