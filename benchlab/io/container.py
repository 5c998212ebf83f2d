"""What a file is by its bytes, before and beside FFmpeg: text, playlists, pictures, containers that were cut short."""

from __future__ import annotations

from pathlib import Path

from benchlab.errors import InputError
from benchlab.io.files import reason_of

HEAD_BYTES = 4096
PICTURE_MAGIC: dict[bytes, str] = {
    b"\xff\xd8\xff": "mjpeg",
    b"\x89PNG\r\n\x1a\n": "png",
    b"II*\x00": "tiff",
    b"MM\x00*": "tiff",
}
FILM_MAGIC: dict[bytes, str] = {
    b"\x1aE\xdf\xa3": "matroska",
    b"OggS": "ogg",
    b"GIF8": "gif",
    b"FLV\x01": "flv",
    b"\x00\x00\x01\xba": "mpeg",
}
TS_PACKET, TS_SYNC = 188, 0x47
TEXT_BYTES = frozenset(b"\t\n\r\f\x1b") | frozenset(range(0x20, 0x100))
UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
MP4_BOXES = frozenset(
    {b"ftyp", b"moov", b"mdat", b"free", b"skip", b"wide", b"pnot", b"moof", b"styp", b"sidx", b"uuid"}
)
EBML_SEGMENT = b"\x18\x53\x80\x67"


def read_head(path: Path) -> bytes:
    """The first 4 kB."""
    try:
        with path.open("rb") as file:
            return file.read(HEAD_BYTES)
    except OSError as error:
        raise InputError(f"reading failed: {reason_of(error)}", file=path) from error


def picture_codec(head: bytes) -> str | None:
    """FFmpeg's decoder for a still picture that begins like this, None for anything else.

    >>> picture_codec(b"\\xff\\xd8\\xff\\xe0")
    'mjpeg'
    """
    return next((codec for magic, codec in PICTURE_MAGIC.items() if head.startswith(magic)), None)


def film_format(head: bytes) -> str | None:
    """FFmpeg's demuxer for a film that begins like this, None to let FFmpeg find out.

    Stated where the bytes tell, because FFmpeg's own guess also weighs the name: `a%03d.jpg` would be a pattern.

    >>> film_format(b"\\x00\\x00\\x00\\x20ftypisom")
    'mov'
    """
    if head[4:8] in MP4_BOXES:
        return "mov"
    if head.startswith(b"RIFF") and head[8:12] == b"AVI ":
        return "avi"
    if len(head) > 2 * TS_PACKET and head[0] == head[TS_PACKET] == head[2 * TS_PACKET] == TS_SYNC:
        return "mpegts"
    return next((name for magic, name in FILM_MAGIC.items() if head.startswith(magic)), None)


def check_not_text(path: Path, head: bytes) -> None:
    """Raises InputError for text, and so for every playlist that would lead FFmpeg to another file."""
    start = head.removeprefix(b"\xef\xbb\xbf").lstrip().lower()
    if start.startswith((b"ffconcat", b"#extm3u", b"<mpd", b"[playlist")):
        raise InputError("not a video file: a playlist", file=path, hint="give the recording itself")
    if head.startswith(UTF16_MARKS) or all(byte in TEXT_BYTES for byte in head):
        raise InputError("not a video: looks like text", file=path, hint="give the recording itself")


def refusal(path: Path, head: bytes) -> InputError:
    """Why FFmpeg could not open this file, as far as its bytes tell."""
    if not any(head):
        return InputError("not a video benchlab can read: only zero bytes", file=path, hint="copy the recording again")
    boxes, missing = mp4_boxes(path)
    if boxes and b"moov" not in boxes:
        return InputError(
            "truncated: index (moov) missing; the recording was cut", file=path, hint="copy it again from the camera"
        )
    if boxes:
        what = "truncated in its index (moov)" if missing else "damaged index (moov)"
        return InputError(what, file=path, hint="copy it again from the camera")
    if head.startswith((b"\x1aE\xdf\xa3", b"RIFF", b"OggS", b"GIF8", b"FLV")):
        return InputError(
            "damaged or truncated: its header cannot be read", file=path, hint="copy it again from the camera"
        )
    return InputError(
        "not a video benchlab can read", file=path, hint="give mp4, mov, mkv, webm, avi or ts, or a folder of stills"
    )


def mp4_boxes(path: Path) -> tuple[list[bytes], int]:
    """Types of the outermost boxes of an ISO media file, none for others, and how many bytes the last one lacks."""
    size = path.stat().st_size
    boxes: list[bytes] = []
    position = 0
    with path.open("rb") as file:
        while position + 8 <= size and len(boxes) < 100_000:
            file.seek(position)
            header = file.read(16)
            length, kind = int.from_bytes(header[:4], "big"), header[4:8]
            if kind not in MP4_BOXES and (not boxes or not kind.isalnum()):
                break
            if length == 1:
                length = int.from_bytes(header[8:16], "big")
            boxes.append(kind)
            if length == 0:
                return boxes, 0
            if length < 8:
                break
            position += length
    return boxes, max(0, position - size)


def missing_bytes(path: Path, head: bytes) -> int:
    """How many bytes the container says it has beyond the end of the file: 0 for a whole one, or one that does not say.

    AVI: the RIFF chunk. Matroska, WebM: the segment. MP4, MOV: the outermost boxes.
    """
    size = path.stat().st_size
    if head.startswith(b"RIFF"):
        return max(0, 8 + int.from_bytes(head[4:8], "little") - size)
    if head.startswith(b"\x1aE\xdf\xa3"):
        return _missing_in_matroska(head, size)
    return mp4_boxes(path)[1]


def _missing_in_matroska(head: bytes, size: int) -> int:
    at = head.find(EBML_SEGMENT)
    if at < 0 or at + 5 > len(head) or head[at + 4] == 0:
        return 0
    octets = 9 - head[at + 4].bit_length()
    field = int.from_bytes(head[at + 4 : at + 4 + octets], "big")
    length = field & ((1 << 7 * octets) - 1)
    if length == (1 << 7 * octets) - 1:  # unknown, as in a live stream
        return 0
    return max(0, at + 4 + octets + length - size)
