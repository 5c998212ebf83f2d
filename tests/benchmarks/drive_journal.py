"""What the journal stands: `python tests/benchmarks/drive_journal.py [cut] [flipped] [cost] [large]` prints a table.

cut: power lost at every byte of its last 4 kB. flipped: random bits of a journal that lies on a disk. cost: of one sample to the loop, while
the disk is asked to have everything and another program writes. large: an hour at 500 Hz read and made into files. Each gives rows of
bar, figure, and whether it is met (None: measured, no bar).
"""

from __future__ import annotations

import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
Row = tuple[str, str, bool | None]

HEAVY = "import sys\nwhile True:\n    with open(sys.argv[1], 'wb') as f:\n        [f.write(bytes(1 << 20)) for _ in range(200)]"


def cut(last: int = 4096) -> list[Row]:
    """Cut at each byte: all whole records before the cut are there, and nothing else."""
    from benchlab.io.journal import SAMPLE, read_journal
    from tests.unit.io.journals import write_journal

    with tempfile.TemporaryDirectory() as folder:
        path = write_journal(Path(folder, "a.journal"))
        whole = read_journal(path)
        size, right = path.stat().st_size, 0
        record = SAMPLE.itemsize + 14
        stop = size - _last_event(path.read_bytes())
        for gone in range(1, last + 1):
            os.truncate(path, size - gone)
            read = read_journal(path)
            lost = -(-max(0, gone - stop) // record)  # samples that the cut goes into
            wanted = whole.samples[: len(whole.samples) - lost]
            right += (
                read.samples.tobytes() == wanted.tobytes() and not read.complete and read.lost_bytes < max(record, stop)
            )
    bar = f"journal cut at every byte of its last {last}: recovered up to the last whole record"
    return [(bar, f"{right} of {last}", right == last)]


def flipped(times: int = 2000) -> list[Row]:
    """One to a hundred bits of the records at random: no number that was not written, and what is lost is told."""
    from benchlab.io.journal import read_journal
    from tests.unit.io.journals import write_journal

    rng = random.Random(1)
    with tempfile.TemporaryDirectory() as folder:
        path = write_journal(Path(folder, "a.journal"))
        clean = path.read_bytes()
        known = {int(row["tick"]): row.tobytes() for row in read_journal(path).samples}
        start, wrong, untold, kept = clean.index(b"\n") + 1, 0, 0, []
        for _ in range(times):
            data = bytearray(clean)
            for _ in range(rng.randint(1, 100)):
                data[rng.randrange(start, len(data))] ^= 1 << rng.randrange(8)
            path.write_bytes(data)
            read = read_journal(path)
            wrong += any(known.get(int(row["tick"])) != row.tobytes() for row in read.samples)
            untold += not read.losses and data != clean
            kept.append(len(read.samples) / len(known))
    bar = f"1 to 100 bits flipped, {times} times: no wrong number, all losses told"
    figure = f"{wrong} wrong, {untold} not told; {100 * np.mean(kept):.0f} % of the samples kept on the average"
    return [(bar, figure, not wrong and not untold)]


def cost(seconds: float = 20.0, rate_Hz: int = 500) -> list[Row]:
    """A sample at a time at the largest rate of a run, in the working directory's file system."""
    from benchlab.io.journal import JournalWriter
    from tests.unit.io.journals import samples_of

    rows: list[Row] = []
    values = samples_of().tolist()[0]
    for shown, heavy in (("alone", False), ("beside a program that writes without end", True)):
        with tempfile.TemporaryDirectory(dir=".", prefix=".drive_journal-") as folder:
            writer = JournalWriter(Path(folder, "a.journal"), {})
            other = subprocess.Popen([sys.executable, "-c", HEAVY, str(Path(folder, "heavy"))]) if heavy else None
            try:
                costs = [_timed(writer, values, rate_Hz) for _ in range(round(seconds * rate_Hz))]
            finally:
                if other:
                    other.kill()
                    other.wait()
            writer.close()
        p50, p99, worst = 1e6 * np.percentile(costs, (50, 99, 100))
        figure = f"p50 {p50:.1f}, p99 {p99:.0f}, worst {worst:.0f} µs"
        rows.append((f"cost of a sample at {rate_Hz} Hz, {shown}: p50 ≤ 30 µs", figure, bool(p50 <= 30)))
    return rows


def large(hours: float = 1.0, rate_Hz: int = 500) -> list[Row]:
    """The longest run at the largest rate, from journal to files."""
    from benchlab.io.journal import JournalWriter, read_journal
    from benchlab.workflows.drive_outputs import write_results
    from tests.unit.io.journals import header_of, samples_of

    samples = samples_of()
    with tempfile.TemporaryDirectory() as folder:
        writer = JournalWriter(Path(folder, "a.journal"), header_of(samples))
        values = [row[1:] for row in samples.tolist()]
        for tick in range(round(3600 * hours * rate_Hz)):
            writer.sample(tick, *values[tick % len(values)][:1], tick / rate_Hz, *values[tick % len(values)][2:])
        writer.close()
        began = time.perf_counter()
        count = len(read_journal(writer.path).samples)
        read_s = time.perf_counter() - began
        write_results(writer.path)
        made_s = time.perf_counter() - began - read_s
        size = writer.path.stat().st_size
    return [
        (
            f"{hours:g} h at {rate_Hz} Hz",
            f"{count} samples, {size / 1e6:.0f} MB; read in {read_s:.1f} s, files in {made_s:.1f} s",
            None,
        )
    ]


def _last_event(data: bytes) -> int:
    """Where the stop record begins: the last mark of an event."""
    return data.rindex(b"\xf5E")


def _timed(writer, values, rate_Hz: int) -> float:
    time.sleep(1 / rate_Hz)
    began = time.perf_counter()
    writer.sample(*values)
    return time.perf_counter() - began


def main() -> None:
    chosen = sys.argv[1:] or ["cut", "flipped", "cost", "large"]
    for name in chosen:
        for bar, figure, met in {"cut": cut, "flipped": flipped, "cost": cost, "large": large}[name]():
            print(f"| {bar} | {figure} | {'-' if met is None else 'met' if met else 'NOT MET'} |")


if __name__ == "__main__":
    main()
