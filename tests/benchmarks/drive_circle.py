"""The closed loop, through the command line: protocol → twin → drawn film → `benchlab analyze` → angle against the twin's truth.

`python tests/benchmarks/drive_circle.py` prints what is reached. The film starts at the camera's trigger, whose time is in the journal: a frame at t of the film is at trigger + t of the run. No fit of any offset.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchlab.devices.twin.bench import twin_bench
from benchlab.devices.twin.twin import Twin
from benchlab.io.angle_series import read_angle_series
from benchlab.io.journal import read_journal
from benchlab.io.twin_file import read_twin
from benchlab.units import FloatArray

Row = tuple[str, str, bool | None]

CYCLES = """\
title: Cycles at two rates
limit_MPa: 0.35
segments:
  - hold: {duration_s: 0.733}
  - trigger: camera
  - triangle: {low_MPa: 0, high_MPa: 0.35, rate_MPa_per_s: 0.14, cycles: 2}
  - ramp: {to_MPa: 0.05, duration_s: 0.2}
  - triangle: {low_MPa: 0.05, high_MPa: 0.3, rate_MPa_per_s: 0.35, cycles: 3}
  - vent: {duration_s: 1}
"""
BAR_DEG = 0.5


@dataclass(frozen=True)
class Circle:
    """error_deg: (F,) found less true angle of each frame, NaN where none was found. truth_deg: (F,)."""

    error_deg: FloatArray
    truth_deg: FloatArray
    start_s: float

    @property
    def p95_deg(self) -> float:
        return float(np.nanquantile(np.abs(self.error_deg), 0.95))


def benchlab(*words: object) -> str:
    done = subprocess.run(
        [sys.executable, "-m", "benchlab", *map(str, words)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise RuntimeError(f"benchlab {words[0]}: {done.stderr}")
    return done.stdout


def circle(protocol: str | Path, folder: Path, twin: str = "twin") -> Circle:
    """Run, film and analyze as a user would."""
    benchlab("run", protocol, "--bench", twin, "--fast", "--video", "--out", folder, "--name", "run", "--quiet")
    events = read_journal(folder / "run.journal").events
    start_s = next(event["time_s"] for event in events if event["kind"] == "trigger")
    benchlab(
        "analyze",
        folder / "run.film.mp4",
        "--pressure",
        folder / "run.h5",
        f"--sync={-start_s}",
        "--out",
        folder / "seen",
    )
    found = read_angle_series(folder / "seen" / "run.film.csv")
    truth = read_angle_series(folder / "run.truth.csv")
    true_deg = np.interp(found.time_s + start_s, truth.time_s, truth.angle_deg)
    return Circle(found.angle_deg - true_deg, true_deg, start_s)


def circles() -> Iterator[Row]:
    for name, text in (("linear_ramp", None), ("cycles at 0.14 and 0.35 MPa/s", CYCLES)):
        with tempfile.TemporaryDirectory() as parent:
            folder = Path(parent)
            protocol: str | Path = name
            if text is not None:
                protocol = folder / "cycles.yaml"
                protocol.write_text(text)
            found = circle(protocol, folder)
        error = np.abs(found.error_deg)
        figure = (
            f"p50 {np.nanmedian(error):.3f}°, p95 {found.p95_deg:.3f}°, largest {np.nanmax(error):.2f}°, {np.isnan(error).sum()} of "
            f"{len(error)} frames without an angle, up to {found.truth_deg.max():.0f}°"
        )
        met = found.p95_deg <= BAR_DEG and not np.isnan(error).any()
        yield f"closed loop, {name}: angle against the twin's truth, p95 ≤ {BAR_DEG}°", figure, met


def speed(ticks: int = 20_000) -> Iterator[Row]:
    """One exchange at 100 Hz, of the twin alone."""
    twin, bench = read_twin(None), twin_bench()
    best = min(_microseconds(Twin(twin, bench), ticks) for _ in range(3))
    yield "exchange with the twin, default effects, 100 Hz: ≤ 60 µs", f"{best:.0f} µs", best <= 60


def fast() -> Iterator[Row]:
    """`benchlab run --fast`, by its own clock: start of Python and writing of files are not in it."""
    with tempfile.TemporaryDirectory() as folder:
        protocol = Path(folder) / "long.yaml"
        protocol.write_text(
            "title: Long\nlimit_MPa: 0.35\nsegments:\n  - triangle: {low_MPa: 0, high_MPa: 0.35, rate_MPa_per_s: 0.14, cycles: 40}\n"
        )
        took = []
        for name in ("a", "b", "c"):
            began = time.perf_counter()
            told = json.loads(
                benchlab("run", protocol, "--bench", "twin", "--fast", "--out", folder, "--name", name, "--json")
            )
            took.append(time.perf_counter() - began)
        seconds = 40 * 2 * 0.35 / 0.14
        rate = seconds / min(took)
        yield (
            "`benchlab run --fast` on the twin, whole command with all files: ≥ 50 × real time",
            f"{rate:.0f} × ({told['ticks']} ticks in {min(took):.1f} s)",
            rate >= 50,
        )


def _microseconds(device: Twin, ticks: int) -> float:
    device.arm()
    began = time.perf_counter()
    for i in range(ticks):
        device.exchange(i / 100, 0.34 * abs(1 - i % 500 / 250))
    return (time.perf_counter() - began) / ticks * 1e6


def rows() -> list[Row]:
    return [*circles(), *speed(), *fast()]


def main() -> None:
    for bar, figure, met in rows():
        print(f"{'met' if met else 'NOT MET' if met is False else '':8} {bar}: {figure}")


if __name__ == "__main__":
    main()
