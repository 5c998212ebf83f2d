"""A recording in, its curvature series out: the measurement without the files."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from benchlab.errors import InputError, UsageError
from benchlab.io.lens_file import read_lens
from benchlab.io.pressure import PressureRecord, Ramp, read_pressure
from benchlab.io.pressure import ramp as parse_ramp
from benchlab.io.recording import Recording, RecordingInfo, open_recording
from benchlab.vision.aruco import find_aruco
from benchlab.vision.curvature import Body, measure_curvature
from benchlab.vision.finder import MarkerFinder
from benchlab.vision.lens import Lens
from benchlab.vision.linking import Tracks, link
from benchlab.vision.markers import Region
from benchlab.vision.onset import find_onset
from benchlab.vision.picture import FloatArray, Planes
from benchlab.vision.scale import (
    Scale,
    scale_from_corners,
    scale_from_reference,
    scale_given,
)
from benchlab.vision.series import CurvatureSeries
from benchlab.vision.steadiness import Steadiness, find_shakes
from benchlab.workflows.settings import AnalyzeSettings

Progress = Callable[[int, int | None], None]
ARUCO_TRIES = 60  # pictures
OTHER_LENGTH = 0.2  # relative difference between the marked length and al that is asked about


@dataclass(frozen=True)
class Analysis:
    """One analysed recording: what was measured, and where it was written."""

    source: Path
    info: RecordingInfo
    series: CurvatureSeries
    scale: Scale
    warnings: tuple[str, ...]
    partial: bool


def measure(source: Path, settings: AnalyzeSettings, progress: Progress | None = None) -> Analysis:
    """The measurement without the files. Raises InputError where no frame shows an actuator."""
    lens = read_lens(Path(settings.lens)) if settings.lens else None
    pressure = read_pressure(Path(settings.pressure)) if settings.pressure else None
    ramp = parse_ramp(settings.ramp) if settings.ramp else None
    with open_source(source, settings) as recording:
        seen = _look(recording, settings, progress)
        info = recording.info
        warnings = [*recording.warnings, *seen.steadiness.warnings()]
    if lens:
        lens = lens.for_size(info.width, info.height)
    tracks = _in_picture(link(seen.candidates, settings.markers, stills=info.kind == "stills"), info, lens)
    for t, reason in enumerate(seen.reasons):
        if reason:
            tracks = replace(tracks, reason=(*tracks.reason[:t], reason, *tracks.reason[t + 1 :]))
    body = Body(settings.length_mm, settings.marker_span_mm, _known_scale(settings, seen, info, lens))
    time_s = np.array(seen.time_s)
    names = tuple(seen.names) if info.kind == "stills" else ()
    if tracks.xy.shape[1] == 0 or not (np.isfinite(tracks.xy[..., 0]).sum(axis=1) >= 3).any():
        raise _nothing_found(source, settings, seen)
    series, scale = measure_curvature(
        tracks, time_s, body, settings.fit, settings.flip, stills=info.kind == "stills", names=names
    )
    series = _with_pressure(series, pressure or ramp, settings)
    if pressure is not None:
        warnings += pressure.warnings
    warnings += _doubts(series, scale, settings, tracks)
    missing = 1 - series.measured.mean()
    if missing > settings.max_missing:
        raise InputError(
            f"{missing:.0%} of the frames could not be measured, more than --max-missing {settings.max_missing:.0%}",
            file=source,
            hint="look at the flag column without --max-missing, or set --roi",
        )
    return Analysis(source, info, series, scale, tuple(dict.fromkeys(warnings)), seen.interrupted)


def open_source(source: Path, settings: AnalyzeSettings) -> Recording:
    """The recording, opened as the settings say."""
    return open_recording(
        source,
        stream=settings.stream,
        fps=settings.fps,
        capture_fps=settings.capture_fps,
        fast=settings.fast,
        allow_partial=settings.allow_partial,
        max_pixels=settings.max_pixels,
    )


class _Seen:
    """What one pass over a recording leaves: candidates, times and reasons a frame, and the first good picture."""

    def __init__(self) -> None:
        self.candidates: list[Any] = []
        self.time_s: list[float] = []
        self.reasons: list[str] = []
        self.names: list[str] = []
        self.aruco_px: FloatArray | None = None
        self.aruco_missed: InputError | None = None
        self.steadiness = Steadiness()
        self.threshold: float | None = None
        self.interrupted = False


def _look(recording: Recording, settings: AnalyzeSettings, progress: Progress | None) -> _Seen:
    seen, info = _Seen(), recording.info
    finder: MarkerFinder | None = None
    # The decoder keeps all cores busy; OpenCV's own threads would only wait for each other.
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        for frame in recording:
            planes = frame.planes
            if planes is not None:
                if finder is None:
                    region = _region(settings.roi_px, info, planes)
                    finder = MarkerFinder(
                        settings.colour, settings.threshold, region, settings.markers, each=info.kind == "stills"
                    )
                if settings.aruco_mm is not None and seen.aruco_px is None:
                    _look_for_aruco(seen, planes, settings.aruco_dictionary)
                seen.candidates.append(finder.find(planes))
                if info.kind == "video":
                    seen.steadiness.look(planes.luma, frame.time_s)
            else:
                seen.candidates.append(None)
            seen.time_s.append(frame.time_s)
            seen.reasons.append(frame.reason)
            seen.names.append(frame.name)
            if progress:
                progress(len(seen.time_s), info.frame_count)
    except KeyboardInterrupt:
        if len(seen.time_s) < 2:
            raise
        seen.interrupted = True
    finally:
        cv2.setNumThreads(threads)
    seen.threshold = finder.threshold if finder else None
    return seen


def _region(roi: tuple[float, float, float, float] | None, info: RecordingInfo, planes: Planes) -> Region | None:
    """The chroma samples of a region of interest given in displayed pixels."""
    if roi is None:
        return None
    left, top, width, height = roi
    if not (
        width > 0 and height > 0 and 0 <= left < left + width <= info.width and 0 <= top < top + height <= info.height
    ):
        raise UsageError(
            f"--roi {left:g},{top:g},{width:g},{height:g} does not lie in the picture",
            file=info.path,
            hint=f"give LEFT,TOP,WIDTH,HEIGHT inside {info.width}x{info.height} pixels",
        )
    corners = info.from_display(np.array([[left, top], [left + width - 1, top + height - 1]]))
    low, high = corners.min(axis=0), corners.max(axis=0)
    step, offset = np.array(planes.chroma_step), np.array(planes.chroma_offset)
    first = np.clip(np.floor((low - offset) / step), 0, None).astype(int)
    last = np.ceil((high - offset) / step).astype(int) + 1
    rows, columns = planes.cb.shape
    return Region(int(first[0]), int(first[1]), int(min(last[0], columns)), int(min(last[1], rows)))


def _in_picture(tracks: Tracks, info: RecordingInfo, lens: Lens | None) -> Tracks:
    """Tracks in displayed pixels, freed of the lens's distortion."""
    xy = info.to_display(tracks.xy)
    return replace(tracks, xy=lens.undistort(xy) if lens else xy)


def _look_for_aruco(seen: _Seen, planes: Planes, dictionary: str) -> None:
    """Corners of the ArUco markers in this picture; the first pictures are tried until one shows them."""
    if len(seen.candidates) < ARUCO_TRIES:
        try:
            _, seen.aruco_px = find_aruco(planes.luma, dictionary)
        except InputError as error:
            seen.aruco_missed = error


def _known_scale(settings: AnalyzeSettings, seen: _Seen, info: RecordingInfo, lens: Lens | None) -> Scale | None:
    """The scale that the settings ask for, or None where the markers' span is to give it."""

    def straight(xy: FloatArray) -> FloatArray:
        return lens.undistort(xy) if lens else xy

    if settings.scale_mm_per_px is not None:
        return scale_given(settings.scale_mm_per_px)
    if settings.reference_mm is not None and settings.reference_px is not None:
        first, second = straight(np.array(settings.reference_px).reshape(2, 2))
        return scale_from_reference(first, second, settings.reference_mm)
    if settings.aruco_mm is not None:
        if seen.aruco_px is None:
            missed = seen.aruco_missed or InputError("no picture to look for an ArUco marker in")
            raise InputError(missed.what, file=info.path, hint=missed.hint)
        corners = straight(info.to_display(seen.aruco_px))
        return scale_from_corners(corners, settings.aruco_mm, f"ArUco marker of {settings.aruco_dictionary}")
    return None


def _with_pressure(
    series: CurvatureSeries, record: PressureRecord | Ramp | None, settings: AnalyzeSettings
) -> CurvatureSeries:
    """The series with the pressure at the time of each frame."""
    if record is None:
        return series
    if not np.isfinite(series.time_s).any():
        raise UsageError("stills have no time to look the pressure up by", hint="give --fps")
    if settings.sync is not None:
        start = settings.sync
    elif isinstance(record, Ramp):
        start = find_onset(series.time_s, series.angle_rad)
    elif settings.sync_onset:
        start = find_onset(series.time_s, series.angle_rad) - find_onset(record.time_s, record.pressure_MPa)
    else:
        start = 0.0
    return replace(series, pressure_MPa=record.at(series.time_s, -start))


def _nothing_found(source: Path, settings: AnalyzeSettings, seen: _Seen) -> InputError:
    spots = [len(c) for c in seen.candidates if c is not None]
    most = max(spots, default=0)
    if most == 0:
        what = f"no actuator found in any of {len(seen.candidates)} frames: nothing {settings.colour} stands out"
    else:
        what = f"no actuator found in any of {len(seen.candidates)} frames: at most {most} {settings.colour} spots, in no row of markers"
    return InputError(what, file=source, hint="check --colour, or set --threshold, --markers or --roi")


def _doubts(series: CurvatureSeries, scale: Scale, settings: AnalyzeSettings, tracks: Tracks) -> list[str]:
    """What the user should know before using the numbers, one plain sentence each."""
    doubts = []
    frames = len(series.time_s)
    chords = np.hypot(*np.moveaxis(np.diff(series.markers_px, axis=1), -1, 0)).sum(axis=1)
    chords = chords[np.isfinite(chords)]
    marked = float(np.median(chords)) * scale.mm_per_px if len(chords) else settings.length_mm
    if not scale.assumed and settings.marker_span_mm is None and abs(marked / settings.length_mm - 1) > OTHER_LENGTH:
        doubts.append(
            f"the markers span {marked:.0f} mm, the angle is for {settings.length_mm:g} mm: is that the length (--length-mm)?"
        )
    if scale.assumed:
        doubts.append(f"no scale given: the markers are assumed to span {settings.length_mm:g} mm (--length-mm)")
    if scale.span_variation > 0.03:
        doubts.append(
            f"the marked length varies by {scale.span_variation:.0%}: the body stretches or leaves the picture plane"
        )
    if frames == 1:
        doubts.append("1 frame: no curvature against time")
    missing = int((~series.measured).sum())
    if missing:
        doubts.append(f"{missing} of {frames} frames could not be measured")
    short = int((series.measured & (series.n_markers < tracks.xy.shape[1])).sum())
    if short:
        doubts.append(f"markers left out in {short} of {frames} frames")
    odd = sum("not constant curvature" in f for f in series.flag)
    if odd:
        doubts.append(f"not of constant curvature in {odd} of {frames} frames (see fit_rms_px)")
    degrees = np.degrees(series.angle_rad[series.measured])
    if len(degrees) and degrees.min() < -10 and degrees.max() > 10:
        doubts.append(
            "bends both ways: angles are positive towards the side of the largest angle (--flip turns that round)"
        )
    shakes = find_shakes(tracks, series.time_s)
    if len(shakes) and not series.names:
        doubts.append(
            f"all markers jerk together in {len(shakes)} frames, first at {shakes[0]:.2f} s: was the camera knocked?"
        )
    if series.pressure_MPa is not None and not np.isfinite(series.pressure_MPa).all():
        outside = int((~np.isfinite(series.pressure_MPa)).sum())
        doubts.append(f"the pressure record does not cover {outside} of {frames} frames")
    if not math.isfinite(scale.mm_per_px):
        doubts.append("no frame shows both end markers")
    return doubts
