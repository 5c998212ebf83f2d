"""The door to recordings: films, folders of stills and single pictures, recognised by content."""

from __future__ import annotations

from pathlib import Path

from benchlab.io.container import picture_codec, read_head
from benchlab.io.decoder import RAW_SUFFIXES
from benchlab.io.files import check_regular_file
from benchlab.io.film import Film
from benchlab.io.recording_base import Recording, RecordingInfo
from benchlab.io.stills import Stills

__all__ = ["Recording", "RecordingInfo", "open_recording"]


def open_recording(
    path: Path,
    *,
    stream: int = 0,
    fps: float | None = None,
    capture_fps: float | None = None,
    fast: bool = False,
    allow_partial: bool = False,
    max_pixels: int = 64_000_000,
) -> Recording:
    """A film, a picture, or a folder of pictures in natural order, recognised by content, opened for reading.

    stream: which video stream, where there are several.
    fps: frame rate where there are no stamps (raw streams, stills); it replaces stamps where there are some.
    capture_fps: the rate at which a slow-motion film was taken; its time is rescaled by tagged rate / capture rate.
    fast: leave out the decoder's deblocking filter. Faster, and pixels differ slightly (block edges stay visible).
    allow_partial: keep what is whole of a damaged or truncated film; lost frames have no planes, and a warning says so.
        Slower, without frame threads, so that the same damage gives the same pixels each time.
    max_pixels: limit on width × height, checked before anything is decoded.

    Frame times are presentation stamps less the first one. A damaged frame and one whose stamp does not advance have
    planes None and say why; those after a damaged one, to the next key frame, have planes and a reason to doubt them.
    Without `allow_partial`, iteration ends in InputError if anything was lost.
    Raises UsageError for a path that is no file or folder, for a stream that is not there and where `fps` is needed,
    and InputError for whatever is not a whole, coloured, moderately sized recording, with the reason.
    """
    path = Path(path)
    if path.is_dir():
        return Stills(path, fps=fps, max_pixels=max_pixels)
    check_regular_file(path)
    if picture_codec(read_head(path)) and path.suffix.lower() not in RAW_SUFFIXES:
        return Stills(path, fps=fps, max_pixels=max_pixels)
    return Film(
        path,
        stream=stream,
        fps=fps,
        capture_fps=capture_fps,
        fast=fast,
        allow_partial=allow_partial,
        max_pixels=max_pixels,
    )
