"""A film: one video stream of a container, opened, its frames in order with times from their presentation stamps."""

from __future__ import annotations

import os
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

from av.container import InputContainer
from av.stream import Disposition
from av.video.frame import VideoFrame
from av.video.stream import VideoStream

from benchlab.errors import InputError, UsageError
from benchlab.io.container import missing_bytes, read_head
from benchlab.io.decoder import (
    RAW_FORMATS,
    Decoder,
    chroma_location,
    claimed_size,
    decoder_limit,
    open_container,
    translated,
)
from benchlab.io.files import check_regular_file
from benchlab.io.film_checks import DAMAGED, NOT_ADVANCING, Account, check_rates, check_size
from benchlab.io.orientation import frame_orientation
from benchlab.io.planes import PlaneReader, read_tags
from benchlab.io.recording_base import Recording, RecordingInfo, displayed_size
from benchlab.vision.picture import Frame

THREADS_PER_CORE, MOST_THREADS = 3, 16

REORDERING = frozenset({"h264", "hevc"})  # AVI has stamps of decoding only; for these they are no presentation times
_Start = tuple[list[tuple[int | None, None]], tuple[int | None, VideoFrame]]


class Film(Recording):
    """A video file as a Recording. See `open_recording` for the options and what is refused."""

    def __init__(
        self,
        path: Path,
        *,
        stream: int = 0,
        fps: float | None = None,
        capture_fps: float | None = None,
        fast: bool = False,
        allow_partial: bool = False,
        max_pixels: int = 64_000_000,
    ) -> None:
        check_rates(fps, capture_fps)
        self._path, self._stream, self._fps, self._fast = path, stream, fps, fast
        self._capture_fps, self._allow_partial, self._max_pixels = capture_fps, allow_partial, max_pixels
        self.warnings = []
        self._before = check_regular_file(path)
        self._container: InputContainer | None = None
        self._started = False
        self._frames = self._open()
        try:
            first = self._first_frame()
            self.info, self._reader = self._describe(*first)
            self._first: _Start | None = first
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Let go of the file and of the decoder's threads."""
        if self._container is not None:
            self._container.close()
            self._container = None

    def __iter__(self) -> Iterator[Frame]:
        if self._started:
            self.close()
            self._frames = self._open()
        self._started = True
        account = Account(self.info, self._allow_partial, tick_s=0.0 if self._fps else float(self._time_base))
        width, height = self.info.stored_width, self.info.stored_height
        clock, reader = self._clock(), self._reader
        with translated(self._path, "while reading"):
            for stamp, picture in self._with_first():
                index = account.frames
                time_s = index / self._fps if self._fps else self._time(stamp, index, clock)
                if picture is None or picture.is_corrupt:
                    account.damaged(time_s)
                    yield Frame(index, time_s, None, DAMAGED)
                    continue
                if picture.width != width or picture.height != height:
                    self._refuse_size(picture, index)
                reason = account.good(time_s, picture)
                yield Frame(index, time_s, None if reason == NOT_ADVANCING else reader(picture), reason)
        self._finish(account)

    def _open(self) -> Decoder:
        """The container, its stream and the decoder, not yet started."""
        self._container = open_container(self._path, self._max_pixels)
        stream = self._choose(self._container)
        context = stream.codec_context
        size = (context.width, context.height)
        if 0 in size:  # FFmpeg forgets the size of a picture beyond its limit
            size = claimed_size(self._path, stream.index)
        check_size(self._path, *size, self._max_pixels)
        # Frame threads conceal damage differently from run to run; slice threads give the same pixels each time.
        context.thread_type = "SLICE" if self._allow_partial else "AUTO"
        if not self._allow_partial:
            # FFmpeg's own choice, one more than there are cores, lets them idle while the caller looks at a frame.
            context.thread_count = min(THREADS_PER_CORE * (os.cpu_count() or 1), MOST_THREADS)
        context.options = decoder_limit(self._max_pixels) | ({"skip_loop_filter": "all"} if self._fast else {})
        self._video = stream
        return Decoder(self._container, stream, self._path)

    def _choose(self, container: InputContainer) -> VideoStream:
        streams = [s for s in container.streams.video if not s.disposition & Disposition.attached_pic]
        if not streams:
            kinds = "audio only" if container.streams.audio else "no stream that can be seen"
            raise InputError(f"no video stream ({kinds})", file=self._path, hint="give the recording of the camera")
        if not 0 <= self._stream < len(streams):
            raise UsageError(
                f"no video stream {self._stream}: there are {len(streams)}",
                file=self._path,
                hint="--stream counts from 0",
            )
        chosen = streams[self._stream]
        if len(streams) > 1:
            self.warn(f"{len(streams)} video streams: stream {self._stream} is read (--stream chooses)")
        if chosen.codec_context is None:
            raise InputError("its codec cannot be decoded", file=self._path, hint="convert it to H.264")
        return chosen

    def _first_frame(self) -> _Start:
        """What was lost before the first frame, and the first frame."""
        lost: list[tuple[int | None, None]] = []
        self._rest = iter(self._frames)
        with translated(self._path, "frame 0"):
            for stamp, picture in self._rest:
                if picture is not None:
                    return lost, (stamp, picture)
                lost.append((stamp, None))
        hint = "it is damaged or holds no picture; copy it again from the camera"
        raise InputError("no frames decoded", file=self._path, hint=hint)

    def _describe(
        self, lost: list[tuple[int | None, None]], start: tuple[int | None, VideoFrame]
    ) -> tuple[RecordingInfo, PlaneReader]:
        stamp, picture = start
        stream, container = self._video, self._frames.container
        raw = container.format.name in RAW_FORMATS
        reordered = container.format.name == "avi" and stream.codec_context.has_b_frames
        if self._fps is None and (stamp is None or raw or (reordered and stream.codec_context.name in REORDERING)):
            raise UsageError("has no time stamps", file=self._path, hint="give its frame rate with --fps")
        if self._fps is not None and stamp is not None and not raw:
            self.warn(f"time from --fps {self._fps:g}; the stamps of the file are not used")
        first_stamp = stamp if not lost or lost[0][0] is None else lost[0][0]
        time_base = stream.time_base or Fraction(1)
        rate = float(stream.average_rate or stream.guessed_rate or 0) or None
        self._first_stamp, self._time_base = first_stamp or 0, time_base
        self._scale = self._slow_motion(rate)
        tags = read_tags(picture, chroma_location(container, stream.index), self._path)
        if any(component.bits > 8 for component in picture.format.components):
            self.warn(f"{max(c.bits for c in picture.format.components)}-bit pictures are read as 8-bit")
        rotation, mirrored = frame_orientation(picture, self._path)
        aspect = stream.sample_aspect_ratio or Fraction(1)
        width, height = displayed_size(picture.width, picture.height, aspect, rotation)
        duration = float(stream.duration * time_base) if stream.duration else None
        if duration is None and container.duration:
            duration = container.duration / 1e6
        info = RecordingInfo(
            path=self._path,
            kind="video",
            width=width,
            height=height,
            stored_width=picture.width,
            stored_height=picture.height,
            codec=stream.codec_context.name,
            pixel_format=picture.format.name,
            frame_count=stream.frames or None,
            duration_s=None if duration is None else duration * self._scale,
            rotation_deg=rotation,
            sample_aspect=aspect,
            full_range=tags.full_range,
            matrix=tags.matrix,
            start_s=float(self._first_stamp * time_base),
            title=str(container.metadata.get("title", "")),
            mirrored=mirrored,
            fps=rate,
        )
        return info, PlaneReader(tags)

    def _slow_motion(self, rate: float | None) -> float:
        """Seconds of the scene per second of the file."""
        if self._capture_fps is None:
            return 1.0
        if rate is None:
            raise UsageError("has no frame rate to compare --capture-fps with", file=self._path, hint="use --fps")
        self.warn(f"slow motion: tagged {rate:g} fps, captured at {self._capture_fps:g} fps; time is rescaled")
        return rate / self._capture_fps

    def _with_first(self) -> Iterator[tuple[int | None, VideoFrame | None]]:
        if self._first is not None:
            lost, first = self._first
            self._first = None
            yield from lost
            yield first
            yield from self._rest
        else:
            yield from self._frames

    def _clock(self) -> tuple[int, float]:
        return self._first_stamp, float(self._time_base) * self._scale

    def _time(self, stamp: int | None, index: int, clock: tuple[int, float]) -> float:
        if stamp is None:
            raise UsageError(
                "has no time stamp", file=self._path, where=f"frame {index}", hint="give the frame rate with --fps"
            )
        return (stamp - clock[0]) * clock[1]

    def _refuse_size(self, picture: VideoFrame, index: int) -> None:
        raise InputError(
            f"frame size changes at frame {index}, from {self.info.stored_width}×{self.info.stored_height} "
            f"to {picture.width}×{picture.height}",
            file=self._path,
            hint="cut it there into two recordings",
        )

    def _finish(self, account: Account) -> None:
        """Settle the account: warnings, and the refusals that only the whole file can tell."""
        after = self._path.stat()
        if (after.st_size, after.st_mtime_ns) != (self._before.st_size, self._before.st_mtime_ns):
            raise InputError("file changed while reading", file=self._path, hint="wait until the recording is complete")
        short = self._frames.cut or missing_bytes(self._path, read_head(self._path)) > 0
        account.settle(self.warn, truncated=short, decode_errors=self._frames.decode_errors)
