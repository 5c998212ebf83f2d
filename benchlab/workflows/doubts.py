"""What the user should know before using the numbers: one plain sentence for each doubt."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from benchlab.errors import InputError
from benchlab.vision.scale import Scale
from benchlab.vision.series import CurvatureSeries
from benchlab.vision.steadiness import find_shakes
from benchlab.workflows.settings import AnalyzeSettings

OTHER_LENGTH = 0.2  # relative difference between the marked length and al that is asked about


def nothing_found(source: Path, settings: AnalyzeSettings, spots: list[int]) -> InputError:
    """The refusal of a recording without an actuator; spots: candidates of each frame."""
    colour, row = settings.colour, f"row of {settings.markers or 'three or more'} markers"
    most = max(spots, default=0)
    if most == 0:
        what = f"no actuator found in any of {len(spots)} frames: no {colour} {row} stands out"
    else:
        what = f"no actuator found in any of {len(spots)} frames: at most {most} {colour} spots, in no {row}"
    return InputError(what, file=source, hint="check --colour, or set --threshold, --markers or --roi")


def doubts(series: CurvatureSeries, scale: Scale, settings: AnalyzeSettings, rival: int) -> list[str]:
    """The warnings that a series and its scale give cause to. rival: markers of a second row in view."""
    found = []
    if rival:
        found.append(f"a second row of {rival} markers is in view: say which one with --roi")
    frames = len(series.time_s)
    chords = np.hypot(*np.moveaxis(np.diff(series.markers_px, axis=1), -1, 0)).sum(axis=1)
    chords = chords[np.isfinite(chords)]
    marked = float(np.median(chords)) * scale.mm_per_px if len(chords) else settings.length_mm
    if not scale.assumed and settings.marker_span_mm is None and abs(marked / settings.length_mm - 1) > OTHER_LENGTH:
        found.append(
            f"the markers span {marked:.0f} mm, the angle is for {settings.length_mm:g} mm: is that the length (--length-mm)?"
        )
    if scale.assumed:
        inside = " inside --roi" if settings.roi_px else ""
        found.append(f"no scale given: the markers{inside} are assumed to span {settings.length_mm:g} mm (--length-mm)")
    if scale.span_variation > 0.03:
        found.append(
            f"the marked length varies by {scale.span_variation:.0%}: the body stretches or leaves the picture plane, "
            "or not all markers are found (--markers)"
        )
    if frames == 1:
        found.append("1 frame: no curvature against time")
    missing = int((~series.measured).sum())
    if missing:
        found.append(f"{missing} of {frames} frames could not be measured")
    for words in ("markers left out", "outlier left out"):
        if short := sum(words in flag for flag in series.flag):
            found.append(f"{words} in {short} of {frames} frames")
    odd = sum("not constant curvature" in f for f in series.flag)
    if odd:
        found.append(f"not of constant curvature in {odd} of {frames} frames (see fit_rms_px)")
    degrees = np.degrees(series.angle_rad[series.measured])
    if len(degrees) and degrees.min() < -10 and degrees.max() > 10:
        found.append(
            "bends both ways: angles are positive towards the side of the largest angle (--flip turns that round)"
        )
    shakes = find_shakes(series.markers_px, series.time_s)
    if len(shakes) and not series.names:
        found.append(
            f"all markers jerk together in {len(shakes)} frames, first at {shakes[0]:.2f} s: was the camera knocked?"
        )
    found += _of_pressure(series)
    if not math.isfinite(scale.mm_per_px):
        found.append("no frame shows both end markers")
    return found


def _of_pressure(series: CurvatureSeries) -> list[str]:
    """Doubts about the pressure beside the angle."""
    pressure = series.pressure_MPa
    if pressure is None:
        return []
    known = np.isfinite(pressure)
    found = []
    if not known.all():
        found.append(f"the pressure record does not cover {int((~known).sum())} of {len(known)} frames")
    if known.sum() > 1 and np.ptp(pressure[known]) == 0:
        found.append("the pressure does not change during the recording: check --sync")
    return found
