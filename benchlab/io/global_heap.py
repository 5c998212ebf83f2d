"""HDF5's global heaps, walked before the library walks them.

Texts of free length and the references of dimension scales lie in these heaps. They are the one structure of the format
without a checksum, and the HDF5 library can loop for ever on a damaged one: free space whose size has become 0 never
comes to its end (seen with HDF5 2.0 after one flipped bit).

Layout (HDF5 File Format Specification, III.E): "GCOL", version 1, three zeros, size of the collection (8 bytes); then
objects: index (2), references (2), zeros (4), size (8), data padded to 8 bytes. Index 0 is free space, up to the end.
"""

from __future__ import annotations

import mmap
import struct
from pathlib import Path

_SIGNATURE = b"GCOL\x01\x00\x00\x00"
_HEADER = 16
_OBJECT = struct.Struct("<HHIQ")


def global_heaps_are_sound(path: Path) -> bool:
    """Whether every global heap in a file comes to its end where it says it does."""
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        start = data.find(_SIGNATURE)
        while start >= 0:
            size = int.from_bytes(data[start + 8 : start + _HEADER], "little")
            if size < _HEADER or start + size > len(data) or not _ends(data, start + _HEADER, start + size):
                return False
            start = data.find(_SIGNATURE, start + size)
    return True


def _ends(data: mmap.mmap, at: int, end: int) -> bool:
    while end - at >= _OBJECT.size:
        index, _, zeros, size = _OBJECT.unpack_from(data, at)
        if index == 0:
            return bool(size == end - at)
        at += _OBJECT.size + (size + 7) // 8 * 8
        if at > end or zeros:
            return False
    return True
