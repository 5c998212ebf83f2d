"""What the camera of a twin sees, as a film: drawn by benchlab, not filmed."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchlab.errors import InputError
from benchlab.twin.effects.camera_scale import CameraScale
from benchlab.twin.effects.clock_offset import ClockOffset
from benchlab.twin.settings import TwinSettings
from benchlab.twin.truth import Truth
from benchlab.units import FloatArray
from benchlab.vision.synthetic import Scene
from benchlab.workflows.drawn_film import TWIN_CAMERA, Progress, write_drawn_film

STREAM = 3
"""Of the seed's random numbers: 1 and 2 are the sensors'."""


@dataclass(frozen=True)
class TwinFilm:
    """A film that was drawn. start_s: time of the run at its first frame. scale_mm_per_px: as it is told, wrong with `camera_scale`."""

    path: Path
    start_s: float
    frames: int
    frames_per_s: float
    scale_mm_per_px: float


def write_twin_film(
    path: Path, truth: Truth, settings: TwinSettings, start_s: float | None = None, progress: Progress | None = None
) -> TwinFilm:
    """Draw what the twin's camera saw, from start_s, the first trigger, or the first exchange, to the last exchange.

    path: an .mp4, replaced if there. truth: of the run. The same truth, settings and seed draw the same pictures. Raises InputError for a
    run without an exchange, a start outside of the run, or where the disk refuses.
    """
    times = frame_times_s(truth, settings, start_s, path)
    clock = settings.effect(ClockOffset)
    world = times if clock is None else times - clock.ahead_s
    angles = np.radians(np.interp(world, truth.time_s, truth.camera_deg))
    scene = twin_scene(settings)
    scale = settings.effect(CameraScale)
    told = settings.length_mm / scene.length_px * (1.0 if scale is None else scale.factor)
    comment = f"{TWIN_CAMERA}, seed {settings.seed}; starts at {times[0]:.6f} s of the run; {told:.6g} mm per pixel"
    rng = np.random.default_rng([settings.seed, STREAM])
    write_drawn_film(path, scene, angles, rng, settings.camera.frames_per_s, comment, progress, TWIN_CAMERA)
    return TwinFilm(path, float(times[0]), len(times), settings.camera.frames_per_s, told)


def frame_times_s(
    truth: Truth, settings: TwinSettings, start_s: float | None = None, path: Path | None = None
) -> FloatArray:
    """(F,) time of the run at each frame, by the camera's clock."""
    if not len(truth.time_s):
        raise InputError("nothing happened that could be drawn: the run has no tick", file=path)
    first, last = float(truth.time_s[0]), float(truth.time_s[-1])
    start = start_s if start_s is not None else truth.triggers_s[0] if truth.triggers_s else first
    if not first <= start <= last:
        raise InputError(f"a film cannot start at {start:g} s", file=path, hint=f"give {first:g} to {last:g} s")
    rate = settings.camera.frames_per_s
    return start + np.arange(int((last - start) * rate + 1e-6) + 1) / rate


def twin_scene(settings: TwinSettings) -> Scene:
    """An actuator that leaves its clamp to the right and bends down, and stays in the picture at any angle up to a full turn."""
    camera = settings.camera
    length_px = min(0.8 * camera.height_px, 0.6 * camera.width_px)
    return Scene(
        width=camera.width_px,
        height=camera.height_px,
        markers=camera.markers,
        marker_radius_px=0.0105 * length_px,
        length_px=length_px,
        base_px=(0.24 * camera.width_px, 0.2 * camera.height_px),
        heading_rad=0.05,
        body_width_px=0.045 * length_px,
        noise_sd=1.5,
        focal_px=1.5 * camera.width_px,
    )
