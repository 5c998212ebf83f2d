"""FFmpeg's demuxer and decoder behind one strict door: what may be opened, and what was lost on the way."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import av
from av.container import InputContainer
from av.error import FFmpegError
from av.packet import Packet
from av.video.codeccontext import VideoCodecContext
from av.video.frame import VideoFrame
from av.video.stream import VideoStream

from benchlab.errors import InputError
from benchlab.io.container import check_not_text, film_format, read_head, refusal
from benchlab.io.files import reason_of

FORMATS = (
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpegts,mpeg,ogg,gif,flv,asf,mjpeg,h264,hevc,m4v,mpegvideo,ivf,obu,"
    "mxf,dv,apng,nut"
)
RAW_SUFFIXES = {".mjpeg": "mjpeg", ".mjpg": "mjpeg"}
RAW_FORMATS = frozenset({"h264", "hevc", "mjpeg", "m4v", "mpegvideo", "obu"})
ONE_FRAME_PER_PACKET = frozenset(
    {"h264", "hevc", "av1", "libdav1d", "vp9", "libvpx-vp9", "mjpeg", "prores", "png", "ffv1"}
)
MAX_READ_ERRORS = 10_000
PENDING_LIMIT = 256
VERBOSE, INFO = 40, 32


def decoder_limit(max_pixels: int) -> dict[str, str]:
    """The guard inside the decoder; looser than the check of the header, since decoders round sizes up to blocks."""
    return {"max_pixels": str(min(max_pixels + max_pixels // 4 + 1_000_000, 2**31 - 1))}


def open_container(path: Path, max_pixels: int) -> InputContainer:
    """A real container in a regular file, opened; nothing else is reachable from here: no network, no second file.

    Raises InputError for text, playlists, unknown bytes, and damaged or cut indices.
    """
    head = read_head(path)
    check_not_text(path, head)
    try:
        return _open(path, decoder_limit(max_pixels))
    except (FFmpegError, ValueError, OSError, IndexError, RuntimeError) as error:
        raise refusal(path, head) from error


def claimed_size(path: Path, index: int) -> tuple[int, int]:
    """(width, height) that the header claims for a stream, read without decoding a picture."""
    try:
        with _open(path, {}, codec_whitelist="none") as container:
            context = container.streams[index].codec_context
            return (context.width, context.height) if isinstance(context, VideoCodecContext) else (0, 0)
    except (FFmpegError, ValueError, OSError, IndexError, RuntimeError):
        return 0, 0


def _open(path: Path, options: dict[str, str], **container_options: str) -> InputContainer:
    return av.open(
        f"file:{path.absolute()}",  # so that neither a dash, a percent sign nor a colon in the name means anything
        format=RAW_SUFFIXES.get(path.suffix.lower()) or film_format(read_head(path)),
        options=options,
        container_options={"protocol_whitelist": "file", "format_whitelist": FORMATS} | container_options,
        metadata_errors="replace",
    )


def chroma_location(container: InputContainer, index: int) -> str:
    """AVChromaLocation of a stream by its name, "left" where it does not say.

    PyAV has no attribute for it; FFmpeg tells it in its verbose description of the container.
    """
    describe: Callable[[], str] = getattr(container, "dumps_format", str)
    level = av.logging.get_level()
    av.logging.set_libav_level(VERBOSE)
    av.logging.set_level(VERBOSE)
    try:
        description = describe()
    finally:
        av.logging.set_libav_level(INFO)
        av.logging.set_level(level)
    for line in description.splitlines():
        if line.strip().startswith(f"Stream #0:{index}") and ": Video:" in line:
            words = line.replace("(", " ").replace(")", " ").replace(",", " ").split()
            return next((w for w in words if w in {"left", "center", "topleft", "top", "bottomleft", "bottom"}), "left")
    return "left"


@contextmanager
def translated(path: Path, where: str) -> Iterator[None]:
    """Errors of the file system below FFmpeg, as InputError."""
    try:
        yield
    except OSError as error:
        reason = reason_of(error)
        raise InputError(
            f"reading failed: {reason}", file=path, where=where, hint="copy the recording to this machine"
        ) from error


class Decoder:
    """Every frame of one stream in the decoder's order, with those that were lost to damage in their places.

    Iterating gives (stamp, frame): frame is None where a packet of that stamp was there and could not be decoded.
    read_errors: how often the file could not be read on. decode_errors: how many packets were refused.
    cut: nothing could be read after the last of the read errors.
    """

    def __init__(self, container: InputContainer, stream: VideoStream, path: Path) -> None:
        self.container = container
        self.stream = stream
        self.path = path
        self.read_errors = 0
        self.decode_errors = 0
        self.cut = False
        self._strict = stream.codec_context.name in ONE_FRAME_PER_PACKET
        self._pending: set[int] = set()
        self._suspect: set[int] = set()
        self._last: int | None = None

    def __iter__(self) -> Iterator[tuple[int | None, VideoFrame | None]]:
        decode = self.stream.codec_context.decode
        for packet in self._packets():
            self._note(packet)
            try:
                frames = decode(packet)
            except FFmpegError as error:
                if isinstance(error, OSError):
                    raise
                self.decode_errors += 1
                if packet.pts is None and packet.size:
                    yield None, None
                continue
            for frame in frames:
                stamp = frame.pts
                if stamp is None:
                    yield None, frame
                    continue
                yield from self._lost_before(stamp)
                self._last = stamp
                damaged = stamp in self._suspect
                yield stamp, None if damaged else frame
        if self._strict or self.damaged:
            yield from self._lost_before(None)

    @property
    def damaged(self) -> bool:
        """Whether anything could not be read or decoded so far."""
        return bool(self.read_errors or self.decode_errors)

    def _note(self, packet: Packet[Any]) -> None:
        stamp = packet.pts
        if stamp is None or packet.is_discard:
            return
        self._pending.add(stamp)
        if packet.is_corrupt:
            self._suspect.add(stamp)

    def _lost_before(self, stamp: int | None) -> Iterator[tuple[int, None]]:
        """Packets whose turn has passed without a frame; those before the first frame led up to it and are no loss."""
        pending, last = self._pending, self._last
        if stamp is not None:
            pending.discard(stamp)
        if last is not None and (self.damaged or stamp is None):
            lost = sorted(p for p in pending if (stamp is None or p < stamp) and p > last)
            pending.difference_update(lost)
            yield from ((p, None) for p in lost)
        if stamp is not None and (last is None or len(pending) > PENDING_LIMIT):
            pending.difference_update([p for p in pending if p < stamp])

    def _packets(self) -> Iterator[Packet[Any]]:
        """Packets to the end of the file, over unreadable places; the last one is empty and flushes the decoder."""
        in_a_row = 0
        while in_a_row < MAX_READ_ERRORS:
            try:
                for packet in self.container.demux(self.stream):
                    if packet.size:
                        in_a_row = 0
                    yield packet
                self.cut = in_a_row > 0
                return
            except FFmpegError as error:
                if isinstance(error, OSError):
                    raise
                self.read_errors += 1
                in_a_row += 1
        self.cut = True
        yield Packet()  # empty: it flushes the decoder
