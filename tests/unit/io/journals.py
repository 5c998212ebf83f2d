"""Journals of runs that never were: their numbers are computed, and known."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from benchlab.io.journal import SAMPLE, JournalWriter

RATE_HZ = 50.0


def samples_of(cycles: int = 2, rise_s: float = 2.0, closed_loop: bool = False) -> np.ndarray:
    """Triangles of 0.2 MPa: the measured pressure lags by 0.1 s, the angle is 300 °/MPa of that and 4° more on the way down."""
    count = int(2 * cycles * rise_s * RATE_HZ)
    time_s = np.arange(count) / RATE_HZ
    samples = np.zeros(count, SAMPLE)
    samples["tick"] = np.arange(count)
    samples["step"] = (time_s / rise_s).astype(int)
    samples["time_s"] = time_s
    samples["late_s"], samples["answer_s"] = 2e-5, 2e-3
    samples["command_MPa"] = _triangle(time_s, rise_s)
    samples["command_V"] = samples["command_MPa"] / 0.096
    samples["code"] = np.floor(samples["command_V"] / 5 * 4096 + 1e-9)
    samples["pressure_MPa"] = _triangle(np.maximum(0, time_s - 0.1), rise_s)
    falling = samples["step"] % 2 == 1
    samples["angle_deg"] = 300 * samples["pressure_MPa"] + 4 * falling * (samples["pressure_MPa"] > 0)
    samples["flex_V"] = 1.5 + samples["angle_deg"] / 100
    samples["reference_deg"] = 300 * samples["command_MPa"] if closed_loop else np.nan
    samples["device_time_s"] = 7 + time_s
    samples["status"] = 1
    samples["monitor_V"] = 1 + samples["pressure_MPa"] / 0.12
    return samples


def _triangle(time_s: np.ndarray, rise_s: float) -> np.ndarray:
    phase = np.mod(time_s, 2 * rise_s) / rise_s
    return 0.2 * np.minimum(phase, 2 - phase)


def header_of(samples: np.ndarray, kind: str = "serial", rise_s: float = 2.0) -> dict[str, Any]:
    """A head as `benchlab run` writes it, with what readers look at."""
    count = int(samples["step"].max()) + 1 if len(samples) else 2
    steps = [
        {
            "kind": "ramp",
            "start_s": index * rise_s,
            "end_s": (index + 1) * rise_s,
            "label": f"ramp {'up' if index % 2 == 0 else 'down'} µ=1",
            "counts": [index // 2 + 1],
            "line": 3,
        }
        for index in range(count)
    ]
    return {
        "title": "Two triangles",
        "name": "trial",
        "protocol": {"name": "triangles.yaml", "text": "title: Two triangles\n", "sha256": "00"},
        "plan": {"rate_Hz": RATE_HZ, "ticks": len(samples), "duration_s": count * rise_s, "limit_MPa": 0.35, "steps": steps, "events": []},
        "bench_kind": kind,
        "bench": {
            "name": "a",
            "regulator": {"gain": 0.096, "offset": 0.0, "sd": None},
            "monitor": {"gain": 0.12, "offset": -0.12, "sd": 0.0005},
            "flex": {"gain": 100.0, "offset": -150.0, "sd": 0.8},
            "calibrated": True,
            "date": "2026-11-01",
        },
        "device": {"kind": kind},
        "provenance": {"argv": ["benchlab", "run"], "versions": {}},
    }  # fmt: skip


STOP = {"reason": "completed", "words": "all ticks of the plan", "vented": True, "time_s": 8.0}


def write_journal(
    path: Path,
    samples: np.ndarray | None = None,
    header: dict[str, Any] | None = None,
    events: dict[int, list[dict[str, Any]]] | None = None,
    stop: dict[str, Any] | None = STOP,
) -> Path:
    """events: by the sample that they come after. stop: None leaves the record of the end out."""
    samples = samples_of() if samples is None else samples
    journal = JournalWriter(path, header_of(samples) if header is None else header)
    for index, row in enumerate(samples.tolist()):
        journal.sample(*row)
        for event in (events or {}).get(index, []):
            journal.event(**event)
    if stop is not None:
        journal.event("stop", **stop)
    journal.close()
    return path
