"""What `benchlab force` and its reader reach: `python tests/benchmarks/measure.py [speed]` prints tables.

The export is drawn into --cache and kept. Speeds are ratios within one run: each round times pandas and benchlab one after another,
and the ratio of their medians is shown. Threads of BLAS are pinned to one.
"""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from datetime import date
from pathlib import Path

import numpy as np
import pandas
from threadpoolctl import threadpool_limits

from benchlab.io.machine_export import read_machine_export

ROWS = 1_000_000
BAR = 1.5


def drawn_export(cache: Path) -> Path:
    """A clean export of ROWS rows: a name and a unit over each of time, extension and force, which repeats ten cycles."""
    path = cache / f"export_{ROWS}.csv"
    if not path.exists():
        cache.mkdir(parents=True, exist_ok=True)
        rng = np.random.default_rng(4)
        time_s = np.arange(ROWS) / 1000
        extension = 0.01 * time_s + rng.normal(0, 1e-4, ROWS)
        force = 20 * np.abs(np.sin(np.pi * time_s / 100)) + rng.normal(0, 0.02, ROWS)
        table = pandas.DataFrame({"Time (s)": time_s, "Extension (mm)": extension, "Load (N)": force})
        table.to_csv(path, index=False, float_format="%.5f")
    return path


def seconds(call: Callable[[], object]) -> float:
    started = time.perf_counter()
    call()
    return time.perf_counter() - started


def command(path: Path) -> float:
    """The whole command with its start and its files."""
    with tempfile.TemporaryDirectory() as out:
        run = [sys.executable, "-m", "benchlab", "force", path, "--out", out, "--json"]
        return seconds(lambda: subprocess.run(run, check=True, capture_output=True))


def bare(path: Path) -> float:
    """A bare pandas.read_csv in a process of its own, its start included."""
    run = [sys.executable, "-c", "import sys, pandas; pandas.read_csv(sys.argv[1])", path]
    return seconds(lambda: subprocess.run(run, check=True, capture_output=True))


def speed(cache: Path, rounds: int) -> None:
    """Reading an export against a bare pandas.read_csv of it."""
    path = drawn_export(cache)
    calls = {
        "pandas.read_csv": lambda: seconds(lambda: pandas.read_csv(path)),
        "read_machine_export": lambda: seconds(lambda: read_machine_export(path)),
        "python -c pandas.read_csv": lambda: bare(path),
        "benchlab force, files written": lambda: command(path),
    }
    for call in calls.values():
        call()
    times: dict[str, list[float]] = {name: [] for name in calls}
    for index in range(rounds):
        for name, call in calls.items():
            if "read_machine" in name or name.startswith("pandas") or index < 3:
                times[name].append(call())
    median = {name: statistics.median(values) for name, values in times.items()}
    export = read_machine_export(path)
    assert export.rows == ROWS and not export.warnings, export.warnings
    print(f"\n| {ROWS:,} rows, {path.stat().st_size / 1e6:.0f} MB | median, s | quartiles, s | against bare pandas |")
    print("|---|---|---|---|")
    for name, values in times.items():
        low, _, high = statistics.quantiles(values, n=4)
        base = median[
            "python -c pandas.read_csv" if values is times["benchlab force, files written"] else "pandas.read_csv"
        ]
        ratio = "" if name.startswith("python") else f"**{median[name] / base:.2f}**"
        print(f"| {name} | {median[name]:.3f} | {low:.3f} to {high:.3f} | {ratio} |")
    met = median["read_machine_export"] <= BAR * median["pandas.read_csv"]
    print(f"\nbar: reading at most {BAR} times a bare pandas.read_csv: {'met' if met else 'NOT met'}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", nargs="*", choices=[[], "speed"], help="what to measure [default: all]")
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "benchlab-measure")
    parser.add_argument("--rounds", type=int, default=21)
    options = parser.parse_args()
    print(f"{date.today()}, {platform.platform()}, {os.cpu_count()} cores, Python {platform.python_version()}, "
          f"pandas {pandas.__version__}, numpy {np.__version__}, load {os.getloadavg()[0]:.1f}")  # fmt: skip
    os.environ |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    if not options.what or "speed" in options.what:
        with threadpool_limits(1):
            speed(options.cache, options.rounds)


if __name__ == "__main__":
    main()
