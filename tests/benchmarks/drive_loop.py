"""What the loop of `benchlab run` reaches: `python tests/benchmarks/drive_loop.py [late] [killed] [fast]` prints a table.

late: the whole command at 100 Hz on the twin in real time beside a busy core, without a terminal and on one. killed: kill -9 of a
run at random times; the twin counts its exchanges into memory that outlives it, so that what the journal lacks is known. fast: a run in
virtual time against its real one. Each gives rows of bar, figure, and whether it is met (None: measured, no bar).
"""

from __future__ import annotations

import ctypes
import json
import mmap
import os
import pty
import random
import resource
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
Row = tuple[str, str, bool | None]

COUNT = struct.Struct("<q")
CPU_HEAVY = "while True: pass"


def protocol(folder: Path, seconds: float) -> Path:
    """Ramps and holds, again and again, for so long."""
    path = folder / "loop.yaml"
    turn = "\n".join(
        (
            "  - repeat:",
            f"      times: {round(seconds / 10)}",
            "      segments:",
            "        - ramp: {to_MPa: 0.3, duration_s: 2.5}",
            "        - hold: {duration_s: 2.5}",
            "        - vent: {duration_s: 5}",
        )
    )
    path.write_text(f"title: Loop\nlimit_MPa: 0.35\nsegments:\n{turn}\n")
    return path


def command(path: Path, *options: str) -> list[str]:
    return [sys.executable, "-m", "benchlab", "run", str(path), "--out", str(path.parent), "--json", *options]


def late(seconds: float = 60.0) -> list[Row]:
    """Beside one process that keeps a core busy, and whatever else runs here; as whoever calls this, and without the right to go first."""
    ways = (
        ("without a terminal", _plain, False),
        ("drawing on a terminal", _on_terminal, False),
        ("drawing on a terminal, without the right to SCHED_FIFO", _on_terminal, True),
    )
    busy = subprocess.Popen([sys.executable, "-c", CPU_HEAVY])
    try:
        return [_late(seconds, *way) for way in ways]
    finally:
        busy.kill()
        busy.wait()


def _late(seconds: float, words: str, call: Callable[..., dict[str, Any]], ordinary: bool) -> Row:
    with tempfile.TemporaryDirectory() as folder:
        path = protocol(Path(folder), seconds)
        found = call(command(path, "--name", "a"), preexec_fn=_ordinary if ordinary else None)
    ms, planned = found["late_ms"], found["ticks_planned"]
    met = ms["p50"] <= 0.2 and ms["p99"] <= 4 and found["ticks"] == planned and found["reason"] == "completed"
    first = "before other programs" if found["went_first"] else "among other programs"
    return (
        f"100 Hz on the twin, {seconds:g} s, beside a busy core, {words}: late p50 ≤ 0.2 ms, p99 ≤ 4 ms, no tick skipped",
        f"p50 {ms['p50']:.3f}, p99 {ms['p99']:.2f}, worst {ms['max']:.1f} ms; {found['ticks']} of {planned} ticks; {first}; "
        f"load of the machine {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores",
        met,
    )


def _ordinary() -> None:
    """Give up CAP_SYS_NICE, as a user has it not, and the limit of real-time priorities."""
    ctypes.CDLL(None).prctl(24, 23, 0, 0, 0)
    resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))


def _plain(run: list[str], **popen: Any) -> dict[str, Any]:
    done = subprocess.run(run, capture_output=True, text=True, check=True, **popen)
    return dict(json.loads(done.stdout))


def _on_terminal(run: list[str], **popen: Any) -> dict[str, Any]:
    """The same with standard input and error on a terminal that somebody reads."""
    ours, theirs = pty.openpty()
    env = {**os.environ, "TERM": "xterm-256color"}
    process = subprocess.Popen(run, stdin=theirs, stdout=subprocess.PIPE, stderr=theirs, text=True, env=env, **popen)
    os.close(theirs)
    reader = threading.Thread(target=_read_all, args=(ours,), daemon=True)
    reader.start()
    out, _ = process.communicate()
    return dict(json.loads(out))


def _read_all(terminal: int) -> None:
    try:
        while os.read(terminal, 65536):
            pass
    except OSError:
        pass


def counted_run(path: str, count: str) -> None:
    """In a process of its own: a run whose twin writes how often it was asked into the file `count`, at once and for good."""
    from benchlab.devices.twin.twin import Twin
    from benchlab.runner.stop import Stop
    from benchlab.workflows.run import drive
    from benchlab.workflows.run_prepare import RunSettings, prepare

    with Path(count).open("r+b") as file:
        memory = mmap.mmap(file.fileno(), COUNT.size)
    exchange, asked = Twin.exchange, 0

    def counting(self: Twin, *arguments: Any) -> Any:
        nonlocal asked
        reading = exchange(self, *arguments)
        asked += 1
        COUNT.pack_into(memory, 0, asked)
        return reading

    Twin.exchange = counting
    drive(prepare(path, RunSettings(out=Path(path).parent, name="a")), Stop())


def killed(times: int = 50) -> list[Row]:
    from benchlab.io.journal import read_journal

    rng = random.Random(1)
    lost, readable, recovered, ticks = [], 0, 0, []
    for _ in range(times):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            path, count, journal = protocol(folder, 60), folder / "count", folder / "a.journal"
            count.write_bytes(COUNT.pack(0))
            process = subprocess.Popen([sys.executable, __file__, "--counted", str(path), str(count)])
            while not COUNT.unpack(count.read_bytes())[0]:
                time.sleep(0.005)
            time.sleep(rng.uniform(0, 2))
            process.send_signal(signal.SIGKILL)
            process.wait()
            asked = COUNT.unpack(count.read_bytes())[0]
            found = read_journal(journal)
            whole = found.samples["tick"].tolist() == list(range(len(found.samples)))
            readable += whole and not found.complete
            lost.append(asked - len(found.samples))
            ticks.append(asked)
            if len(found.samples):
                done = subprocess.run(
                    [sys.executable, "-m", "benchlab", "recover", str(journal)], capture_output=True, check=False
                )
                recovered += done.returncode == 0 and (folder / "a.h5").exists()
    return [
        (
            f"kill -9 of the runner, {times} random times: {times} readable journals, at most 1 sample lost, run files recovered",
            f"{readable} readable; samples lost: {lost.count(0)} × 0, {lost.count(1)} × 1, {sum(n > 1 for n in lost)} × more; "
            f"{recovered} recovered; killed after {min(ticks)} to {max(ticks)} ticks",
            readable == recovered == times and max(lost) <= 1,
        )
    ]


def fast(seconds: float = 600.0, rounds: int = 3) -> list[Row]:
    whole, alone = [], []
    with tempfile.TemporaryDirectory() as folder:
        path = protocol(Path(folder), seconds)
        for index in range(rounds):
            began = time.perf_counter()
            _plain(command(path, "--fast", "--quiet", "--name", f"w{index}"))
            whole.append(seconds / (time.perf_counter() - began))
            alone.append(seconds / _loop_seconds(path, f"l{index}"))
        began = time.perf_counter()
        _plain(command(Path("linear_ramp"), "--fast", "--quiet", "--out", folder))
        shortest = time.perf_counter() - began
    return [
        (
            f"--fast on the twin, the loop alone, {seconds:g} s at 100 Hz: ≥ 50 × real time",
            f"{statistics.median(alone):.0f} ×",
            statistics.median(alone) >= 50,
        ),
        (
            f"--fast on the twin, the whole command with start, table, file and picture, {seconds:g} s: ≥ 50 × real time",
            f"{statistics.median(whole):.0f} ×",
            statistics.median(whole) >= 50,
        ),
        ("--fast, the whole command on the 5 s of linear_ramp", f"{shortest:.2f} s, {5 / shortest:.1f} ×", None),
    ]


def _loop_seconds(path: Path, name: str) -> float:
    from benchlab.runner.stop import Stop
    from benchlab.workflows.run import drive
    from benchlab.workflows.run_prepare import RunSettings, prepare

    prepared = prepare(str(path), RunSettings(out=path.parent, name=name, fast=True))
    began = time.perf_counter()
    driven = drive(prepared, Stop())
    took = time.perf_counter() - began
    assert driven.end.completed, driven.end
    return took


def main() -> None:
    arguments = sys.argv[1:]
    if arguments[:1] == ["--counted"]:
        counted_run(*arguments[1:])
        return
    for name in arguments or ["late", "killed", "fast"]:
        for bar, figure, met in {"late": late, "killed": killed, "fast": fast}[name]():
            print(f"| {bar} | {figure} | {'–' if met is None else 'yes' if met else 'NO'} |", flush=True)


if __name__ == "__main__":
    main()
