"""What `benchlab force` and its reader reach: `python tests/benchmarks/measure.py [speed] [peaks] [rates]` prints tables.

speed: reading against pandas. peaks: cycles found and peaks against drawn truth. rates: how often the test of linearity rejects a true
line, and its interval holds the slope, in drawn sets of actuators. The export is drawn into --cache and kept. Speeds are ratios within one run: each round times pandas and benchlab one after another,
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

from benchlab.force.line import fit_line
from benchlab.force.peaks import peaks_of
from benchlab.force.synthetic import CycleShape, draw_trace
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


PRESSURES_MPa = 0.035 * np.arange(1, 11)
SLOPE_N_PER_MPa = 107.77
"""37.72 N at 0.35 MPa, the paper's blocked force, on a line through zero."""


DRAWN = ((0.0, 100, 0.03), (0.05, 100, 0.03), (0.3, 100, 0.03), (0.8, 100, 0.03), (0.3, 100, 0.0), (0.0, 20, 0.03), (0.3, 20, 0.03),
         (0.3, 20, 0.0))  # fmt: skip
"""Noise in N, readings a second, and the share by which the force relaxes while the pressure is held."""


def peaks(records: int) -> None:
    """Cycles found and error of their peaks: ten pressures with five cycles, uneven, over a zero that drifts."""
    levels = np.repeat(PRESSURES_MPa, 5)
    print(
        f"\n| noise, N | readings/s | relaxes in a hold by | cycles found in {records} records of 50 | mean error, N | SD, N | largest reading, mean error, N |"
    )
    print("|---|---|---|---|---|---|---|")
    for noise, rate, relaxation in DRAWN:
        found, errors, largest = 0, [], []
        for seed in range(records):
            truth = draw_trace(SLOPE_N_PER_MPa * levels, levels, np.random.default_rng(seed), rate_Hz=rate, noise_N=noise, offset_N=1.5,
                               drift_N_per_s=0.005, uneven=0.3, shape=CycleShape(dip=0.3, relaxation=relaxation))  # fmt: skip
            record = peaks_of(truth.force_N, truth.time_s)
            found += len(record.peaks)
            if len(record.peaks) == len(truth.peaks_N):
                errors += [peak.peak_N - true for peak, true in zip(record.peaks, truth.peaks_N)]
                largest += [peak.raw_N - peak.baseline_N - true for peak, true in zip(record.peaks, truth.peaks_N)]
        print(
            f"| {noise:g} | {rate} | {relaxation:.0%} | {found} of {50 * records} | {np.mean(errors):+.3f} | {np.std(errors):.3f} | {np.mean(largest):+.3f} |"
        )


def rates(sets: int) -> None:
    """Three actuators, ten pressures, true lines that differ by actuator: rejections at 0.05, and the slope in its 95 % interval."""
    print(
        f"\n| scatter about lines that differ by actuator, {sets} sets | lack of fit rejects | bow rejects | slope in its interval |"
    )
    print("|---|---|---|---|")
    kinds = {
        "alike at all pressures": (False, 0.0),
        "SD proportional to pressure": (True, 0.0),
        "neighbours correlated 0.6": (False, 0.6),
    }
    for name, (grows, correlation) in kinds.items():
        rng = np.random.default_rng(1)
        counts = np.zeros(3)
        for _ in range(sets):
            scatter = rng.normal(0, 0.3, (3, 10))
            for j in range(1, 10):
                scatter[:, j] = correlation * scatter[:, j - 1] + (1 - correlation**2) ** 0.5 * scatter[:, j]
            if grows:
                scatter *= PRESSURES_MPa / PRESSURES_MPa.mean()
            lines = rng.normal(0, 0.5, (3, 1)) + rng.normal(SLOPE_N_PER_MPa, 5, (3, 1)) * PRESSURES_MPa
            line = fit_line(PRESSURES_MPa, lines + scatter)
            assert line.linearity is not None
            slope = line.slope_N_per_MPa
            counts += [line.linearity.p < 0.05, line.linearity.bow_p < 0.05, slope.low < SLOPE_N_PER_MPa < slope.high]
        print(f"| {name} | {' | '.join(f'{count / sets:.3f}' for count in counts)} |")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "what", nargs="*", choices=[[], "speed", "peaks", "rates"], help="what to measure [default: all]"
    )
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "benchlab-measure")
    parser.add_argument("--rounds", type=int, default=21)
    parser.add_argument("--records", type=int, default=20)
    parser.add_argument("--sets", type=int, default=20_000)
    options = parser.parse_args()
    print(f"{date.today()}, {platform.platform()}, {os.cpu_count()} cores, Python {platform.python_version()}, "
          f"pandas {pandas.__version__}, numpy {np.__version__}, load {os.getloadavg()[0]:.1f}")  # fmt: skip
    os.environ |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    if not options.what or "speed" in options.what:
        with threadpool_limits(1):
            speed(options.cache, options.rounds)
    if not options.what or "peaks" in options.what:
        peaks(options.records)
    if not options.what or "rates" in options.what:
        rates(options.sets)


if __name__ == "__main__":
    main()
