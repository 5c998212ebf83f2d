"""Films written frame by frame, with times of their own and colour tags that say what the planes are."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from types import TracebackType
from typing import Self

import av
import numpy as np
from av.error import FFmpegError
from av.video.frame import VideoFrame
from av.video.reformatter import ColorRange, VideoReformatter
from av.video.stream import VideoStream

from benchlab.errors import InputError
from benchlab.io.planes import COLORSPACE, EXACT, plane_view
from benchlab.vision.picture import Planes, UInt8Array

TIME_BASE = Fraction(1, 90_000)
TAG_BY_MATRIX = {"bt601": 6, "bt709": 1, "bt2020": 9}  # AVColorSpace, AVColorPrimaries alike (ITU-T H.273)
FORMAT_BY_STEP = {(2, 2): "yuv420p", (2, 1): "yuv422p", (1, 1): "yuv444p"}


class VideoWriter:
    """A context manager that encodes BGR pictures or planes, all of one size, into a new file.

    path: where to write, usually a temporary name; its suffix chooses the container (mp4, mkv, webm, avi, mov, ts).
    width, height: of all pictures. 4:2:0 needs even sides: an odd side is refused.
    fps: frame rate for frames added without a time. full_range, matrix: of the planes; BGR is converted to them.
    codec: "libx264", "libx265", "libvpx-vp9", "libsvtav1", "mjpeg", ... with crf or bitrate_bps, preset and options.
    Raises InputError where the codec refuses or the disk fails.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with VideoWriter(Path(folder) / "a.mp4", 64, 48, fps=30) as writer:
    ...         writer.write(np.zeros((48, 64, 3), np.uint8))
    ...     (Path(folder) / "a.mp4").stat().st_size > 0
    True
    """

    def __init__(
        self,
        path: Path,
        width: int,
        height: int,
        *,
        fps: float = 30.0,
        codec: str = "libx264",
        crf: int | None = None,
        bitrate_bps: int | None = None,
        preset: str | None = None,
        pixel_format: str = "yuv420p",
        full_range: bool = False,
        matrix: str = "bt709",
        gop: int | None = None,
        options: dict[str, str] | None = None,
        threads: int = 0,
    ) -> None:
        self.path = path
        self.size = width, height
        if pixel_format in {"yuv420p", "yuvj420p"} and (width % 2 or height % 2):
            hint = "4:2:0 needs even sides; pad the picture"
            raise InputError(f"{width}×{height} has an odd side", file=path, hint=hint)
        self.full_range = full_range or pixel_format.startswith("yuvj")
        self.matrix, self.frames = matrix, 0
        self._rate = Fraction(fps).limit_denominator(100_000)
        self._reformatter = VideoReformatter()
        named = {"crf": crf, "preset": preset}
        chosen = {key: str(value) for key, value in named.items() if value is not None} | (options or {})
        try:
            self._container = av.open(f"file:{path.absolute()}", "w")
            stream = self._container.add_stream(codec, rate=self._rate, options=chosen)
        except (FFmpegError, ValueError, OSError) as error:
            raise InputError(f"cannot be written with {codec}: {error}", file=path) from error
        assert isinstance(stream, VideoStream)
        context = stream.codec_context
        context.width, context.height, context.pix_fmt, context.time_base = width, height, pixel_format, TIME_BASE
        context.color_range = ColorRange.JPEG if self.full_range else ColorRange.MPEG
        context.colorspace = context.color_primaries = context.color_trc = TAG_BY_MATRIX[matrix]
        context.thread_count = threads
        if bitrate_bps is not None:
            context.bit_rate = bitrate_bps
        if gop is not None:
            context.gop_size = gop
        self._stream = stream

    def write(self, picture: UInt8Array | Planes, time_s: float | None = None) -> None:
        """Append one picture: (height, width, 3) BGR, or planes of the writer's range and matrix.

        Without a time, it follows at the writer's rate.
        """
        frame = self._from_planes(picture) if isinstance(picture, Planes) else self._from_bgr(picture)
        if (frame.width, frame.height) != self.size:
            what = f"frame {self.frames} is {frame.width}×{frame.height}, the film {self.size[0]}×{self.size[1]}"
            raise InputError(what, file=self.path)
        seconds = self.frames / self._rate if time_s is None else Fraction(time_s)
        frame.time_base = TIME_BASE
        frame.pts = round(seconds / TIME_BASE)
        self.frames += 1
        self._encode(frame)

    def _from_bgr(self, picture: UInt8Array) -> VideoFrame:
        frame = VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="bgr24")
        return self._reformatter.reformat(
            frame,
            format=self._stream.codec_context.pix_fmt,
            dst_colorspace=COLORSPACE[self.matrix],
            src_color_range=ColorRange.JPEG,
            dst_color_range=ColorRange.JPEG if self.full_range else ColorRange.MPEG,
            interpolation=EXACT,
        )

    def _from_planes(self, planes: Planes) -> VideoFrame:
        if (planes.full_range, planes.matrix) != (self.full_range, self.matrix):
            raise ValueError("planes must have the writer's range and matrix")
        height, width = planes.luma.shape
        frame = VideoFrame(width, height, FORMAT_BY_STEP[planes.chroma_step])
        for target, source in zip(frame.planes, (planes.luma, planes.cb, planes.cr), strict=True):
            plane_view(target)[:] = source
        frame.color_range = ColorRange.JPEG if self.full_range else ColorRange.MPEG
        frame.colorspace = TAG_BY_MATRIX[self.matrix]
        return frame

    def _encode(self, frame: VideoFrame | None) -> None:
        try:
            self._container.mux(self._stream.encode(frame))
        except (FFmpegError, ValueError, OSError) as error:
            raise InputError(f"writing failed: {error}", file=self.path, where=f"frame {self.frames}") from error

    def close(self) -> None:
        """Write what the encoder still holds, and the index. Raises InputError for a film without frames."""
        if not self.frames:
            self._container.close()
            raise InputError("a film without frames cannot be written", file=self.path)
        self._encode(None)
        try:
            self._container.close()
        except (FFmpegError, ValueError, OSError) as error:
            raise InputError(f"writing failed: {error}", file=self.path) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.close()
        else:
            self._container.close()
