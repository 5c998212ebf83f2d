"""Width and height from the first bytes of a picture, so that nothing large is decoded before it was allowed."""

from __future__ import annotations

from collections.abc import Callable

PNG = b"\x89PNG\r\n\x1a\n"
JPEG_SIZE_MARKERS = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}  # SOF0–15 (ITU-T T.81 table B.1)
JPEG_BARE_MARKERS = frozenset({0x01, *range(0xD0, 0xD9)})


def picture_size(data: bytes) -> tuple[int, int] | None:
    """(width, height) of a PNG, JPEG or TIFF, None where its header does not tell.

    >>> picture_size(PNG + bytes([0, 0, 0, 13]) + b"IHDR" + bytes([0, 0, 0, 3, 0, 0, 0, 2]))
    (3, 2)
    """
    readers: dict[bytes, Callable[[bytes], tuple[int, int] | None]] = {
        PNG: _png,
        b"\xff\xd8\xff": _jpeg,
        b"II*\x00": _tiff,
        b"MM\x00*": _tiff,
    }
    return next((read(data) for magic, read in readers.items() if data.startswith(magic)), None)


def _png(data: bytes) -> tuple[int, int] | None:
    if len(data) < 24:
        return None
    return int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")


def _jpeg(data: bytes) -> tuple[int, int] | None:
    at = 2
    while at + 9 <= len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if marker in JPEG_SIZE_MARKERS:
            return int.from_bytes(data[at + 7 : at + 9], "big"), int.from_bytes(data[at + 5 : at + 7], "big")
        if marker == 0xFF:
            at += 1
        elif marker in JPEG_BARE_MARKERS:
            at += 2
        else:
            at += 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return None


def _tiff(data: bytes) -> tuple[int, int] | None:
    order = "little" if data.startswith(b"II") else "big"

    def number(at: int, size: int) -> int:
        return int.from_bytes(data[at : at + size], "little" if order == "little" else "big")

    directory = number(4, 4)
    found: dict[int, int] = {}
    for entry in range(directory + 2, directory + 2 + 12 * number(directory, 2), 12):
        tag, kind = number(entry, 2), number(entry + 2, 2)
        if tag in {256, 257}:  # ImageWidth, ImageLength
            found[tag] = number(entry + 8, 2 if kind == 3 else 4)
    return (found[256], found[257]) if len(found) == 2 else None
