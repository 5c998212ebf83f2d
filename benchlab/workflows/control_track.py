"""`benchlab control track`: how well a closed-loop run followed its reference, as figures and a figure."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.control.tracking import Tracking, track
from benchlab.errors import InputError, UsageError
from benchlab.io.files import cannot_write, check_new_file, written_whole
from benchlab.io.nexus import plain
from benchlab.report.figures import save_png
from benchlab.report.tracking_figure import TrackedRun, draw_tracking_figure
from benchlab.units import FloatArray
from benchlab.workflows.driven import DrivenRun, read_driven, truth_of


def track_run(
    source: Path, out: Path, settle_s: float, length_mm: float, truth: Path | None = None, overwrite: bool = False
) -> dict[str, Any]:
    """Write NAME.tracking.json and NAME.tracking.png into the folder `out`, which is made. truth: the true angle of a simulated bench.

    Returns what was found, as `--json` shows it. Raises UsageError and InputError; then nothing was written.
    """
    if settle_s < 0:
        raise UsageError(f"--settle-s is {settle_s:g}", hint="give 0 s or more")
    if not 1 <= length_mm <= 10_000:
        raise UsageError(f"--length-mm is {length_mm:g}", hint="give the length of the arc, 1 to 10000 mm")
    run = read_driven(source)
    tracked = _closed_loop(run, truth)
    try:
        found = _track(tracked, tracked.angle_deg, settle_s, length_mm)
    except InputError as error:
        raise InputError(error.what, file=source, hint=error.hint) from error
    true = None if tracked.true_deg is None else _track(tracked, tracked.true_deg, settle_s, length_mm)
    paths = _paths(out, source.stem, overwrite)
    note = f"{run.bench_words}; {_gains(run)}"
    figure = draw_tracking_figure(tracked, found, f"{run.title} ({source.name})", note, length_mm, true)
    with written_whole(paths[1]) as temporary:
        try:
            save_png(figure, temporary)
        except OSError as error:
            raise cannot_write(error, paths[1]) from error
    summary: Any = plain(
        {
            "run": str(source),
            "simulated": run.simulated,
            "control": run.header.get("control"),
            "length_mm": length_mm,
            "measured": asdict(found),
            "true": None if true is None else asdict(true),
            "outputs": paths,
        }
    )
    with written_whole(paths[0]) as temporary:
        temporary.write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    return dict(summary)


def _paths(out: Path, stem: str, overwrite: bool) -> list[Path]:
    """The JSON file and the picture."""
    paths = [out / f"{stem}.tracking{suffix}" for suffix in (".json", ".png")]
    for path in paths:
        check_new_file(path, overwrite)
    return paths


def _closed_loop(run: DrivenRun, truth: Path | None) -> TrackedRun:
    """The ticks with a reference."""
    reference = run.column("reference_deg")
    used = np.isfinite(reference)
    if not used.any():
        hint = "only steps of kind `curvature` are tracked"
        raise InputError("no step of this run is closed-loop", file=run.path, hint=hint)
    true = truth_of(truth, run)
    return TrackedRun(
        time_s=run.column("time_s")[used],
        reference_deg=reference[used],
        angle_deg=run.column("angle_deg")[used],
        command_MPa=run.column("command_MPa")[used],
        pressure_MPa=run.column("pressure_MPa")[used],
        ceiling_MPa=run.ceiling_MPa,
        true_deg=None if true is None else true[used],
    )


def _track(run: TrackedRun, angle_deg: FloatArray, settle_s: float, length_mm: float) -> Tracking:
    return track(run.time_s, run.reference_deg, angle_deg, run.command_MPa, run.ceiling_MPa, settle_s, length_mm)


def _gains(run: DrivenRun) -> str:
    control = run.header.get("control")
    if not control:
        return "gains not told"
    words = f"PI kp {control['kp_MPa_per_deg']:.3g} MPa/°, ki {control['ki_MPa_per_deg_s']:.3g} MPa/(°·s)"
    if not control.get("feed_forward"):
        return f"{words}, no feed-forward"
    by = f" by {str(control['curve']).partition(',')[0]}" if control.get("curve") else ""
    return f"{words}; feed-forward{by}, lead {control['lead_s']:.2g} s"
