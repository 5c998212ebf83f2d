"""How long `benchlab explain` takes: a drawn study of 5 designs × 5 samples × 3 runs, as a user's tables, with nothing simulated before and again.

`python -m tests.benchmarks.explain_speed [--hidden viscoelasticity] [--repeats 3]` prints one row a case: seconds of the whole command with an empty cache, of
the same with the curves kept (median of repeats), without a report (--json alone), and peak memory. One thread a process, as many processes as cores.
The study is one of the card `tune`'s own kind (tests/blind), drawn, not measured.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from datetime import date
from pathlib import Path

from tests.blind.cards import FIRST_SEED
from tests.blind.generator.study import study

HIDDEN = ("", "viscoelasticity", "seam_margin", "camera_scale")
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hidden", nargs="*", default=HIDDEN, help="names of effects; '' hides nothing")
    parser.add_argument("--repeats", type=int, default=3)
    asked = parser.parse_args(arguments)
    print(f"{date.today()}, {os.cpu_count()} cores, {platform.machine()}, Python {platform.python_version()}\n")
    print("| hidden (2×) | verdict | nothing kept, s | curves kept, s | without report, s |")
    print("|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for number, name in enumerate(asked.hidden):
            print(
                _row(Path(folder) / str(number), name, FIRST_SEED["tune"] + 950_000 + number, asked.repeats), flush=True
            )
    print(f"\npeak memory of a process: {resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024:.0f} MB")


def _row(folder: Path, name: str, seed: int, repeats: int) -> str:
    drawn = study(seed, *(((name,), (2.0,)) if name else ()))
    folder.mkdir()
    drawn.frame.to_csv(folder / "measured.csv", index=False)
    drawn.designs.to_csv(folder / "designs.csv", index=False)
    cold, answer = _timed(folder, "--out", "cold")
    warm = statistics.median(_timed(folder, "--out", f"warm{each}")[0] for each in range(repeats))
    bare = statistics.median(_timed(folder)[0] for _ in range(repeats))
    return f"| {name or 'nothing'} | {answer['verdict']} | {cold:.1f} | {warm:.1f} | {bare:.1f} |"


def _timed(folder: Path, *more: str) -> tuple[float, dict[str, object]]:
    """Of the command as a user gives it, with a cache of this study's own."""
    begun = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-m", "benchlab", "explain", "measured.csv", "--designs", "designs.csv", "--json", *more],
        cwd=folder,
        env={**os.environ, **ONE_THREAD, "BENCHLAB_CACHE": str(folder / "cache")},
        capture_output=True,
        text=True,
        check=True,
    )
    return time.perf_counter() - begun, json.loads(done.stdout)


if __name__ == "__main__":
    main()
