"""What the first bytes of a picture tell before it is decoded: width, height, and the EXIF orientation."""

from __future__ import annotations

from collections.abc import Callable, Iterator

PNG = b"\x89PNG\r\n\x1a\n"
EXIF = b"Exif\x00\x00"
JPEG_SIZE_MARKERS = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}  # SOF0–15 (ITU-T T.81 table B.1)
JPEG_BARE_MARKERS = frozenset({0x01, *range(0xD0, 0xD9)})
JPEG_SCAN, JPEG_APP1 = 0xDA, 0xE1
TIFF_WIDTH, TIFF_LENGTH, TIFF_ORIENTATION = 256, 257, 274
TIFF_SHORT = 3
MAX_ENTRIES = 4096
ORIENTATIONS = {  # EXIF 2.32 table 6: (clockwise degrees, mirrored first)
    1: (0, False),
    2: (0, True),
    3: (180, False),
    4: (180, True),
    5: (270, True),
    6: (90, False),
    7: (90, True),
    8: (270, False),
}


def picture_size(data: bytes) -> tuple[int, int] | None:
    """(width, height) of a PNG, JPEG or TIFF, None where its header does not tell.

    >>> picture_size(PNG + bytes([0, 0, 0, 13]) + b"IHDR" + bytes([0, 0, 0, 3, 0, 0, 0, 2]))
    (3, 2)
    """
    readers: dict[bytes, Callable[[bytes], tuple[int, int] | None]] = {
        PNG: _png_size,
        b"\xff\xd8": _jpeg_size,
        b"II*\x00": _tiff_size,
        b"MM\x00*": _tiff_size,
    }
    return next((read(data) for magic, read in readers.items() if data.startswith(magic)), None)


def picture_orientation(data: bytes) -> tuple[int, bool]:
    """(clockwise degrees, mirrored) of the EXIF orientation of a JPEG, PNG or TIFF; (0, False) where there is none."""
    if data.startswith(PNG):
        exif = next((body for kind, body in png_chunks(data) if kind == b"eXIf"), b"")
    elif data.startswith(b"\xff\xd8"):
        bodies = (body for marker, body in jpeg_segments(data) if marker == JPEG_APP1)
        exif = next((body[len(EXIF) :] for body in bodies if body.startswith(EXIF)), b"")
    else:
        exif = data
    return ORIENTATIONS.get(tiff_tags(exif).get(TIFF_ORIENTATION, 1), (0, False))


def png_chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """(type, content) of the chunks of a PNG."""
    at = len(PNG)
    while at + 8 <= len(data):
        length = int.from_bytes(data[at : at + 4], "big")
        yield data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        at += 12 + length


def jpeg_segments(data: bytes) -> Iterator[tuple[int, bytes]]:
    """(marker, content) of the segments of a JPEG before its first scan."""
    at = 2
    while at + 4 <= len(data) and data[at] == 0xFF and data[at + 1] != JPEG_SCAN:
        marker = data[at + 1]
        if marker == 0xFF:
            at += 1
        elif marker in JPEG_BARE_MARKERS:
            at += 2
        else:
            length = max(2, int.from_bytes(data[at + 2 : at + 4], "big"))
            yield marker, data[at + 4 : at + 2 + length]
            at += 2 + length


def tiff_tags(data: bytes) -> dict[int, int]:
    """The single whole numbers in the first directory of a TIFF block, by tag."""
    order = {b"II*\x00": False, b"MM\x00*": True}.get(data[:4])
    if order is None:
        return {}

    def number(at: int, size: int) -> int:
        return int.from_bytes(data[at : at + size], "big" if order else "little")

    directory = number(4, 4)
    count = min(number(directory, 2), MAX_ENTRIES)
    entries = range(directory + 2, directory + 2 + 12 * count, 12)
    return {number(e, 2): number(e + 8, 2 if number(e + 2, 2) == TIFF_SHORT else 4) for e in entries}


def _png_size(data: bytes) -> tuple[int, int] | None:
    if len(data) < 24:
        return None
    return int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")


def _jpeg_size(data: bytes) -> tuple[int, int] | None:
    frame = next((body for marker, body in jpeg_segments(data) if marker in JPEG_SIZE_MARKERS), b"")
    if len(frame) < 5:
        return None
    return int.from_bytes(frame[3:5], "big"), int.from_bytes(frame[1:3], "big")


def _tiff_size(data: bytes) -> tuple[int, int] | None:
    tags = tiff_tags(data)
    if TIFF_WIDTH not in tags or TIFF_LENGTH not in tags:
        return None
    return tags[TIFF_WIDTH], tags[TIFF_LENGTH]
