"""Stills as a recording: a folder of JPEG, PNG and TIFF pictures in natural order, or one picture alone."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import av
from av.error import FFmpegError
from av.packet import Packet
from av.video.codeccontext import VideoCodecContext
from av.video.frame import VideoFrame

from benchlab.errors import InputError, UsageError
from benchlab.io.container import picture_codec, read_head
from benchlab.io.decoder import decoder_limit
from benchlab.io.files import check_regular_file, reason_of
from benchlab.io.film_checks import check_rates, check_size
from benchlab.io.picture_header import picture_orientation, picture_size
from benchlab.io.planes import PlaneReader, read_tags
from benchlab.io.recording_base import Recording, RecordingInfo, displayed_size
from benchlab.vision.picture import Frame

SUFFIXES = frozenset({".jpg", ".jpeg", ".png", ".tif", ".tiff"})
MAX_FILE_BYTES = 1 << 30


def natural_key(name: str) -> list[tuple[int, int, str]]:
    """Sorting key that puts img2 before img10.

    >>> sorted(["img10.png", "img2.png", "img1.png"], key=natural_key)
    ['img1.png', 'img2.png', 'img10.png']
    """
    parts = re.split(r"(\d+)", name.casefold())
    return [(0, int(part), "") if part.isdecimal() else (1, 0, part) for part in parts if part] + [(2, 0, name)]


def list_stills(folder: Path) -> tuple[list[Path], int]:
    """The pictures of a folder in natural order, and how many other files are there.

    Raises InputError for a folder without pictures.
    """
    files = [entry for entry in folder.iterdir() if not entry.is_dir()]
    pictures = [f for f in files if f.suffix.lower() in SUFFIXES and not f.name.startswith(".")]
    if not pictures:
        raise InputError("no pictures in this folder", file=folder, hint="JPEG, PNG and TIFF are read")
    return sorted(pictures, key=lambda f: natural_key(f.name)), len(files) - len(pictures)


@dataclass(frozen=True)
class Still:
    """One decoded picture, its codec, and how it is to be turned: clockwise, mirrored before."""

    frame: VideoFrame
    codec: str
    rotation_deg: int
    mirrored: bool


def read_still(path: Path, max_pixels: int) -> Still:
    """One picture, decoded.

    Raises InputError for a file that is no JPEG, PNG or TIFF, or is damaged, or has more pixels than the limit.
    """
    if check_regular_file(path).st_size > MAX_FILE_BYTES:
        raise InputError("picture file larger than 1 GB", file=path)
    codec = picture_codec(read_head(path))
    if codec is None:
        raise InputError("not a JPEG, PNG or TIFF picture", file=path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"reading failed: {reason_of(error)}", file=path) from error
    size = picture_size(data)
    if size is not None:
        check_size(path, *size, max_pixels)
    context = av.CodecContext.create(codec, "r")
    assert isinstance(context, VideoCodecContext)
    context.options = decoder_limit(max_pixels) | ({"err_detect": "explode"} if codec == "mjpeg" else {})
    try:
        frames = context.decode(Packet(data)) or context.decode(None)
    except (FFmpegError, ValueError, RuntimeError) as error:
        raise InputError("damaged picture", file=path, hint="copy it again from the camera") from error
    if not frames or frames[0].is_corrupt:
        raise InputError("damaged picture", file=path, hint="copy it again from the camera")
    return Still(frames[0], codec, *picture_orientation(data))


class Stills(Recording):
    """Stills in order as a Recording. Times are i/fps where a rate is given, else NaN."""

    def __init__(self, path: Path, *, fps: float | None = None, max_pixels: int = 64_000_000) -> None:
        check_rates(fps, None)
        self._fps, self._max_pixels = fps, max_pixels
        self.warnings = []
        if path.is_dir():
            self._files, others = list_stills(path)
            if others:
                self.warn(f"{others} other files in the folder are ignored")
        else:
            self._files = [path]
        self._path = path
        self.info = self._describe()

    def close(self) -> None:
        """Nothing stays open between stills."""

    def _describe(self) -> RecordingInfo:
        refused: InputError | None = None
        for file in self._files:
            try:
                still = read_still(file, self._max_pixels)
            except (InputError, UsageError) as error:
                if len(self._files) == 1:
                    raise
                refused = refused or InputError(error.what, file=file, hint="none of the pictures can be read")
                continue
            return self._facts(still, file)
        raise refused or InputError("no readable picture", file=self._path)

    def _facts(self, still: Still, file: Path) -> RecordingInfo:
        frame, count = still.frame, len(self._files)
        tags = read_tags(frame, "center", file, still=True)
        width, height = displayed_size(frame.width, frame.height, Fraction(1), still.rotation_deg)
        return RecordingInfo(
            path=self._path,
            kind="stills",
            width=width,
            height=height,
            stored_width=frame.width,
            stored_height=frame.height,
            codec=still.codec,
            pixel_format=frame.format.name,
            frame_count=count,
            duration_s=count / self._fps if self._fps else None,
            rotation_deg=still.rotation_deg,
            full_range=tags.full_range,
            matrix=tags.matrix,
            mirrored=still.mirrored,
            fps=self._fps,
        )

    def __iter__(self) -> Iterator[Frame]:
        unreadable = 0
        for index, file in enumerate(self._files):
            time_s = index / self._fps if self._fps else math.nan
            try:
                still = read_still(file, self._max_pixels)
            except (InputError, UsageError) as error:
                unreadable += 1
                yield Frame(index, time_s, None, error.what, file.name)
                continue
            self._check_alike(still, file)
            frame = still.frame
            if any(component.bits > 8 for component in frame.format.components):
                self.warn("16-bit pictures are read as 8-bit")
            planes = PlaneReader(read_tags(frame, "center", file, still=True))(frame)
            yield Frame(index, time_s, planes, "", file.name)
        if unreadable:
            self.warn(f"{unreadable} of {len(self._files)} pictures could not be read")

    def _check_alike(self, still: Still, file: Path) -> None:
        info, frame = self.info, still.frame
        if (frame.width, frame.height) != (info.stored_width, info.stored_height):
            raise InputError(
                f"is {frame.width}×{frame.height}, the first picture {info.stored_width}×{info.stored_height}",
                file=file,
                hint="all pictures of a folder must have one size",
            )
        if (still.rotation_deg, still.mirrored) != (info.rotation_deg, info.mirrored):
            raise InputError("is turned differently from the first picture", file=file, hint="turn them alike")
