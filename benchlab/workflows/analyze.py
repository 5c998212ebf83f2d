"""`benchlab analyze`: a recording in; its curvature and bending angle against time out, as files."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.errors import InputError
from benchlab.io.files import check_regular_file, sha256
from benchlab.io.run_file import write_run_file
from benchlab.io.table import write_series_csv
from benchlab.workflows.measure import Analysis, Progress, measure, open_source
from benchlab.workflows.outputs import Outputs, provenance
from benchlab.workflows.settings import AnalyzeSettings


def analyze(
    source: Path, settings: AnalyzeSettings, outputs: Outputs, progress: Progress | None = None
) -> dict[str, Any]:
    """Analyse one recording and write its results; returns its summary, as `--json` shows it.

    A recording whose result is current (same content, settings and version) is not analysed again.
    Raises UsageError and InputError; then nothing has been written. Ctrl-C ends the reading early: what was seen is
    written and marked partial.
    """
    settings.check()
    inputs = [source, *(Path(name) for name in (settings.lens, settings.pressure) if name)]
    for path in inputs:
        if path != source or not source.is_dir():
            check_regular_file(path)
    outputs.check(settings.overlay, inputs)
    with outputs.locked():
        current = outputs.current(source, asdict(settings))
        if current is not None:
            return current
        try:
            analysis = measure(source, settings, progress)
        except InputError as error:
            error.file = error.file or str(source)
            raise
        return save(analysis, settings, outputs)


def save(analysis: Analysis, settings: AnalyzeSettings, outputs: Outputs) -> dict[str, Any]:
    """Write table, figure, overlay and the run file that vouches for them, all or none; returns the summary."""
    from benchlab.report.figures import draw_curvature_figure, save_png

    series, chosen = analysis.series, asdict(settings)
    overlay = settings.overlay and not analysis.partial  # who interrupts does not want to wait for a second pass
    summary = summarise(analysis, outputs, overlay)
    with outputs.staged() as stage:
        write_series_csv(stage.table, series)
        notes = (
            analysis.info.title,
            analysis.scale.source,
            f"{settings.fit} fit",
            "PARTIAL, interrupted" * analysis.partial,
        )
        note = "; ".join(note for note in notes if note)
        save_png(draw_curvature_figure(series, analysis.source.name, note), stage.figure)
        if overlay:
            _write_overlay(analysis, settings, stage.overlay)
        written = [p for p in stage.paths(overlay) if p != stage.run_file]
        write_run_file(
            stage.run_file,
            series,
            settings=chosen,
            provenance={
                **provenance(analysis.source, chosen),
                "outputs_sha256": {p.name: sha256(p) for p in written},
                "summary": summary,
            },
            recording={**vars(analysis.info), "frames": len(series.time_s)},
            scale=vars(analysis.scale),
            warnings=list(analysis.warnings),
            partial=analysis.partial,
        )
    return summary


def summarise(analysis: Analysis, outputs: Outputs, overlay: bool) -> dict[str, Any]:
    """The recording in a few numbers, as `--json` prints them. Largest values over the frames without doubt, if any."""
    series = analysis.series
    rows = series.sure if series.sure.any() else series.measured
    angle = np.where(rows, series.angle_rad, -np.inf)
    peak = int(np.argmax(angle))
    known = series.time_s[np.isfinite(series.time_s)]
    summary = {
        "video": str(analysis.source),
        "status": "partial" if analysis.partial else "measured",
        "frames": len(series.time_s),
        "frames_measured": int(series.measured.sum()),
        "duration_s": round(float(known.max() - known.min()), 6) if len(known) else None,
        "markers": int(series.used.shape[1]),
        "scale_mm_per_px": float(analysis.scale.mm_per_px),
        "max_angle_deg": float(np.degrees(series.angle_rad[peak])),
        "max_angle_sd_deg": float(np.degrees(series.angle_sd_rad[peak])),
        "max_curvature_per_mm": float(series.curvature_per_mm[peak]),
        "fit_rms_px": float(np.sqrt(np.nanmean(series.fit_rms_px[series.measured] ** 2))),
        "warnings": list(analysis.warnings),
        "outputs": [str(p) for p in outputs.paths(overlay)],
    }
    return {k: None if isinstance(v, float) and not np.isfinite(v) else v for k, v in summary.items()}


def _write_overlay(analysis: Analysis, settings: AnalyzeSettings, path: Path) -> None:
    """A second pass over the recording, with what was found drawn in."""
    from benchlab.io.planes import display_bgr
    from benchlab.io.video_writer import VideoWriter
    from benchlab.report.overlay import draw_overlay

    info, series = analysis.info, analysis.series
    with open_source(analysis.source, settings) as recording:
        steps = np.diff(series.time_s)
        rate = 1 / np.median(steps) if np.isfinite(steps).any() else 2.0
        even = (info.width // 2 * 2, info.height // 2 * 2)
        with VideoWriter(path, *even, fps=float(rate), crf=20, preset="veryfast") as writer:
            for frame in recording:
                if frame.index >= len(series.time_s):
                    break
                if frame.planes is not None:
                    drawn = draw_overlay(display_bgr(frame.planes, info), series, frame.index)
                    writer.write(drawn[: even[1], : even[0]], frame.time_s if np.isfinite(frame.time_s) else None)
