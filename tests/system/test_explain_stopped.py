"""`benchlab explain` that is stopped while cells are simulated: at once, with its exit code, and nothing is left."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")


def started(folder: Path) -> subprocess.Popen[str]:
    """An explanation of two designs without kept curves, as the leader of its own group, when it has begun to simulate."""
    with (folder / "loops.csv").open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(["design", "sample", "run", "time_s", "pressure_MPa", "angle_deg"])
        for design in ("tw3_slw10", "tw5_slw10", "tw9_slw10"):
            for sample in range(3):
                table.writerows([design, sample, "a", i, 0.005 * i, i + 0.1 * sample] for i in range(60))
    command = ("explain", "loops.csv", "--out", "explained", "--jobs", "2")
    process = subprocess.Popen(
        [sys.executable, "-m", "benchlab", *command],
        cwd=folder, env={**os.environ, "BENCHLAB_CACHE": str(folder / "kept")},
        stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    assert process.stderr is not None
    for line in process.stderr:
        if line.startswith("simulating designs (0 of 3)"):
            break
    time.sleep(1)
    return process


@pytest.mark.parametrize(
    ("send", "number", "code"),
    [(os.killpg, signal.SIGINT, 130), (os.kill, signal.SIGINT, 130), (os.kill, signal.SIGTERM, 143)],
    ids=["Ctrl-C", "SIGINT", "SIGTERM"],
)
def test_stopped_while_cells_are_simulated_it_ends_at_once_and_leaves_nothing(tmp_path, send, number, code):
    process = started(tmp_path)
    send(process.pid, number)
    said = process.communicate(timeout=120)[1]
    assert process.returncode == code, said
    assert "Traceback" not in said and ("interrupted" in said) == (code == 130)
    with pytest.raises(ProcessLookupError):
        for _ in range(600):  # its workers are gone as well
            os.killpg(process.pid, 0)
            time.sleep(0.1)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["loops.csv"]
