"""Films that are drawn: encoded from a scene and its angles, with a title that says that nobody filmed them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import av
import numpy as np
from av.error import FFmpegError

from benchlab.errors import InputError
from benchlab.io.files import written_whole
from benchlab.io.video_writer import VideoWriter
from benchlab.vision.picture import FloatArray
from benchlab.vision.synthetic import Scene, draw_frames

TITLE = "drawn by benchlab, not filmed"
TWIN_CAMERA = "camera of a simulated bench (twin)"
"""What is drawn of a twin, by which studies know it."""

CRF = 18

Progress = Callable[[int, int | None], None]


def write_drawn_film(
    path: Path,
    scene: Scene,
    angles_rad: FloatArray,
    rng: np.random.Generator,
    fps: float,
    comment: str,
    progress: Progress | None = None,
    shows: str = "",
) -> None:
    """Draw a scene at the bending angles (T,) of its frames and encode it, whole or not at all.

    On one thread, so that one encoder version gives one file. comment: stands in the file after the title. shows: what it is of, in the
    title. progress: called with
    frames drawn and frames in all. Raises InputError where the disk refuses.
    """
    with written_whole(path) as temporary:
        encoded = temporary.with_name(f"{temporary.stem}-untitled.mp4")
        try:
            with VideoWriter(encoded, scene.width, scene.height, fps=fps, crf=CRF, preset="medium", threads=1) as film:
                for done, planes in enumerate(draw_frames(scene, angles_rad, rng), start=1):
                    film.write(planes)
                    if progress:
                        progress(done, len(angles_rad))
            title = f"{TITLE}: {shows}" if shows else TITLE
            _copy_with_title(encoded, temporary, title, f"{TITLE}: {comment}")
        finally:
            encoded.unlink(missing_ok=True)


def _copy_with_title(source: Path, target: Path, title: str, comment: str) -> None:
    """The same film, its index in front, with a title and a comment that say what it is."""
    try:
        with (
            av.open(f"file:{source.absolute()}") as film,
            av.open(f"file:{target.absolute()}", "w", options={"movflags": "+faststart"}) as copy,
        ):
            copy.metadata.update(title=title, comment=comment)
            stream = copy.add_stream_from_template(film.streams.video[0])
            for packet in film.demux(video=0):
                if packet.dts is not None:
                    packet.stream = stream
                    copy.mux(packet)
    except (FFmpegError, OSError) as error:
        raise InputError(f"writing failed: {error}", file=target) from error
