"""Clips for the benchmarks, drawn once and kept in a cache folder."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np

from benchlab.io.video_writer import VideoWriter
from benchlab.vision.synthetic import Scene, draw_frames

SCENES = {
    1080: Scene(noise_sd=4.5),
    2160: Scene(width=3840, height=2160, length_px=1800.0, base_px=(840.0, 440.0), marker_radius_px=18.0,
                body_width_px=76.0, focal_px=5600.0, blur_px=1.2, noise_sd=4.5),
}  # fmt: skip


def looped_clip(folder: Path, lines: int, fps: int, frames: int, megabits: float, unique: int = 300) -> Path:
    """A clip of `frames` frames at about `megabits` per second: a bending back and forth, drawn once and repeated."""
    path = folder / f"speed_{lines}p{fps}_{frames}_{megabits:g}Mb.mp4"
    if path.exists():
        return path
    folder.mkdir(parents=True, exist_ok=True)
    once = folder / f"once_{lines}_{unique}_{megabits:g}_{fps}.mp4"
    scene = SCENES[lines]
    phase = np.arange(unique) / unique
    angles = np.radians(60 * (1 - np.cos(2 * np.pi * phase)))
    if not once.exists():
        drawn = once.with_stem(once.stem + "_unfinished")
        rate = {"maxrate": f"{megabits:g}M", "bufsize": f"{megabits:g}M"}
        with VideoWriter(drawn, scene.width, scene.height, fps=fps, bitrate_bps=int(megabits * 1e6),
                         preset="veryfast", options=rate) as writer:  # fmt: skip
            for planes in draw_frames(scene, angles, np.random.default_rng(7)):
                writer.write(planes)
        drawn.rename(once)
    loops = -(-frames // unique) - 1
    loop = [
        "ffmpeg",
        "-v",
        "error",
        "-y",
        "-stream_loop",
        str(loops),
        "-i",
        once,
        "-frames:v",
        str(frames),
        "-c",
        "copy",
    ]
    subprocess.run(
        [*loop, path],
        check=True,
    )
    return path


def encoded(folder: Path, name: str, scene: Scene, angles_rad: np.ndarray, fps: float, crf: int = 18) -> Path:
    """A scene as an H.264 clip at a camera's quality."""
    path = folder / f"{name}_{len(angles_rad)}_{crf}.mp4"
    if not path.exists():
        folder.mkdir(parents=True, exist_ok=True)
        with VideoWriter(path, scene.width, scene.height, fps=fps, crf=crf, preset="veryfast",
                         full_range=scene.full_range, matrix=scene.matrix) as writer:  # fmt: skip
            for planes in draw_frames(scene, angles_rad, np.random.default_rng(11)):
                writer.write(planes)
    return path
