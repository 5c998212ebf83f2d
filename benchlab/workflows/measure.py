"""A recording in, its curvature series out: the measurement without the files."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

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
from benchlab.vision.onset import find_onset
from benchlab.vision.picture import FloatArray, Planes
from benchlab.vision.scale import (
    Scale,
    scale_from_corners,
    scale_from_reference,
    scale_given,
)
from benchlab.vision.series import CurvatureSeries
from benchlab.vision.spots import Region
from benchlab.vision.steadiness import Steadiness
from benchlab.workflows.doubts import doubts, nothing_found
from benchlab.workflows.settings import AnalyzeSettings

Progress = Callable[[int, int | None], None]
ARUCO_TRIES = 60  # pictures
LEAST_MOTION_DEG = 1.0


@dataclass(frozen=True)
class Analysis:
    """One analysed recording: what was measured, and in which recording."""

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
    with open_source(source, settings) as recording, _one_thread():
        seen = _look(recording, settings, progress)
        info = recording.info
        warnings = [*recording.warnings, *seen.steadiness.warnings()]
    if lens:
        lens = lens.for_size(info.width, info.height)
    candidates = seen.candidates
    tracks = _in_picture(link(candidates, settings.markers, stills=info.kind == "stills"), info, lens)
    tracks = replace(tracks, reason=tuple(mine or theirs for mine, theirs in zip(seen.reasons, tracks.reason)))
    body = Body(settings.length_mm, settings.marker_span_mm, _known_scale(settings, seen, info, lens))
    time_s = np.array(seen.time_s)
    names = tuple(seen.names) if info.kind == "stills" else ()
    if tracks.xy.shape[1] == 0 or not (np.isfinite(tracks.xy[..., 0]).sum(axis=1) >= 3).any():
        raise nothing_found(source, settings, [len(c) for c in candidates if c is not None])
    series, scale = measure_curvature(
        tracks, time_s, body, settings.fit, settings.flip, stills=info.kind == "stills", names=names
    )
    series = _with_pressure(series, pressure or ramp, settings)
    if pressure is not None:
        warnings += [*pressure.warnings, *_synchronised(pressure, settings)]
    warnings += doubts(series, scale, settings, tracks.rival)
    missing = 1 - series.measured.mean()
    if missing > settings.max_missing:
        raise InputError(
            f"{missing:.0%} of the frames could not be measured, more than --max-missing {settings.max_missing:.0%}",
            file=source,
            hint="look at the flag column without --max-missing, or set --roi",
        )
    return Analysis(source, info, series, scale, tuple(dict.fromkeys(warnings)), seen.interrupted)


@contextmanager
def _one_thread() -> Iterator[None]:
    """OpenCV and BLAS on one thread: the decoder keeps all cores busy, and their threads would wait by spinning."""
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        with threadpool_limits(1):
            yield
    finally:
        cv2.setNumThreads(threads)


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
    """What one pass over a recording leaves: times, reasons and names of its frames, and what was found in them."""

    def __init__(self, finder: MarkerFinder) -> None:
        self.finder = finder
        self.steadiness = Steadiness()
        self.time_s: list[float] = []
        self.reasons: list[str] = []
        self.names: list[str] = []
        self.aruco_px: FloatArray | None = None
        self.aruco_missed: InputError | None = None
        self.interrupted = False

    @property
    def candidates(self) -> list[NDArray[np.void] | None]:
        """Of the frames that were looked at to the end, should Ctrl-C have come in the middle of one."""
        return self.finder.candidates()[: len(self.names)]


def _look(recording: Recording, settings: AnalyzeSettings, progress: Progress | None) -> _Seen:
    info = recording.info
    stills = info.kind == "stills"
    region = _region(settings.roi_px, info)
    seen = _Seen(MarkerFinder(settings.colour, settings.threshold, region, settings.markers, each=stills))
    try:
        for frame in recording:
            planes = frame.planes
            if planes is None:
                seen.finder.pass_over()
            else:
                seen.finder.look(planes)
                if settings.aruco_mm is not None and seen.aruco_px is None and frame.index < ARUCO_TRIES:
                    _look_for_aruco(seen, planes, settings.aruco_dictionary)
                if not stills:
                    seen.steadiness.look(planes.luma, frame.time_s)
            seen.time_s.append(frame.time_s)
            seen.reasons.append(frame.reason)
            seen.names.append(frame.name)
            if progress:
                progress(len(seen.names), info.frame_count)
    except KeyboardInterrupt:
        if len(seen.names) < 2:
            raise
        seen.interrupted = True
    del seen.time_s[len(seen.names) :], seen.reasons[len(seen.names) :]
    return seen


def _region(roi: tuple[float, float, float, float] | None, info: RecordingInfo) -> Region | None:
    """A region of interest given in displayed pixels, in pixels as stored."""
    if roi is None:
        return None
    left, top, width, height = roi
    across, down = 0 <= left < left + width <= info.width, 0 <= top < top + height <= info.height
    if not (across and down):
        raise UsageError(
            f"--roi {left:g},{top:g},{width:g},{height:g} does not lie in the picture",
            file=info.path,
            hint=f"give LEFT,TOP,WIDTH,HEIGHT inside {info.width}x{info.height} pixels",
        )
    corners = info.from_display(np.array([[left, top], [left + width - 1, top + height - 1]]))
    return Region(*corners.min(axis=0), *corners.max(axis=0))


def _in_picture(tracks: Tracks, info: RecordingInfo, lens: Lens | None) -> Tracks:
    """Tracks in displayed pixels, freed of the lens's distortion."""
    xy = info.to_display(tracks.xy)
    return replace(tracks, xy=lens.undistort(xy) if lens else xy)


def _look_for_aruco(seen: _Seen, planes: Planes, dictionary: str) -> None:
    """Corners of the ArUco markers in this picture, if it shows any."""
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


def _check_moves(series: CurvatureSeries) -> None:
    """Raises InputError where the angle moves too little to tell when the motion starts."""
    moved = float(np.degrees(np.ptp(series.angle_rad[series.measured])))
    least = max(LEAST_MOTION_DEG, 10 * float(np.degrees(np.nanmedian(series.angle_sd_rad))))
    if moved < least:
        raise InputError(
            f"the angle moves by {moved:.2g} deg, less than the {least:.2g} deg that an onset of motion takes",
            hint="give --sync SECONDS",
        )


def _synchronised(record: PressureRecord, settings: AnalyzeSettings) -> list[str]:
    """Where the record itself tells when the film began, that it was believed."""
    if record.trigger_s is None or settings.sync is not None or settings.sync_onset:
        return []
    at = f"{record.trigger_s:.3f} s of {Path(record.source).name}, when the camera was triggered"
    return [f"the film is taken to begin at {at}; --sync SECONDS or onset says otherwise"]


def _with_pressure(
    series: CurvatureSeries, record: PressureRecord | Ramp | None, settings: AnalyzeSettings
) -> CurvatureSeries:
    """The series with the pressure at the time of each frame."""
    if record is None:
        return series
    if not np.isfinite(series.time_s).any():
        raise UsageError("stills have no time to look the pressure up by", hint="give --fps")
    if settings.sync is None and (settings.sync_onset or isinstance(record, Ramp)):
        _check_moves(series)
    if settings.sync is not None:
        start = settings.sync
    elif isinstance(record, Ramp):
        start = find_onset(series.time_s, series.angle_rad)
    elif settings.sync_onset:
        start = find_onset(series.time_s, series.angle_rad) - find_onset(record.time_s, record.pressure_MPa)
    else:
        start = -(record.trigger_s or 0.0)
    return replace(series, pressure_MPa=record.at(series.time_s, -start))
