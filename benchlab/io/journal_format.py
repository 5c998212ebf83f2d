"""The bytes of a journal, laid out in docs/runs.md.

    line     {"schema":"benchlab-journal","schema_version":1,"crc32":"0123abcd","header":{...}}\\n
    record   mark (2) · length of the content (4) · number of the record, from 0 (4) · content · CRC-32 (4)

All little-endian. The mark is F5 53 for a sample and F5 45 for an event; F5 is no byte of UTF-8, so that no event can hold one.
The CRC of a record goes over everything before it and begins with that of the header: what a disk has left of another
journal is no record of this one.
"""

from __future__ import annotations

import json
import re
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchlab.errors import InputError

SCHEMA, VERSION = "benchlab-journal", 1
SAMPLE_MARK, EVENT_MARK = b"\xf5S", b"\xf5E"
HEAD = struct.Struct("<2sII")
CRC = struct.Struct("<I")
MAX_HEADER, MAX_EVENT = 16_000_000, 1_000_000
"""Most bytes of the line and of an event's content."""

MAX_SEARCH = 200_000_000
"""Bytes that are gone over in search of the next whole record, before the rest is given up."""

_LINE = re.compile(rb'\{"schema":"benchlab-journal","schema_version":(\d{1,6}),"crc32":"([0-9a-f]{8})","header":')
_MARKS = re.compile(rb"\xf5[SE]")


@dataclass(frozen=True)
class Loss:
    """What could not be read. at: byte of the file. bytes: how many. records: how many, None where nobody can know. why: in words."""

    at: int
    bytes: int
    records: int | None
    why: str


@dataclass(frozen=True)
class Record:
    """A whole record: its mark, its number and its content."""

    mark: bytes
    number: int
    content: bytes
    end: int


def header_line(header: dict[str, Any]) -> tuple[bytes, int]:
    """The first line of a journal, and the CRC that all its records begin with. InputError for a header that is too large."""
    body = json.dumps(header, separators=(",", ":"), allow_nan=False).encode()
    crc = zlib.crc32(body)
    line = b'{"schema":"%s","schema_version":%d,"crc32":"%08x","header":%s}\n' % (SCHEMA.encode(), VERSION, crc, body)
    if len(line) > MAX_HEADER:
        what = f"the head of a journal would have {len(line)} bytes, more than the limit of {MAX_HEADER}"
        raise InputError(what, hint="is the protocol that large?")
    return line, crc


def read_header_line(path: Path, data: bytes) -> tuple[dict[str, Any], int, int]:
    """The header, its CRC, and where the records begin. InputError for anything but a whole, undamaged first line."""
    found = _LINE.match(data)
    if found is None:
        raise InputError("not a benchlab journal", file=path, where="first line", hint="give the .journal of a run")
    if (version := int(found[1])) != VERSION:
        newer = version > VERSION
        what = f"made by a {'newer' if newer else 'foreign'} benchlab (journal {version}, this one reads {VERSION})"
        raise InputError(what, file=path, hint="update benchlab" if newer else None)
    end = data.find(b"\n", found.end(), MAX_HEADER)
    body = data[found.end() : end - 1]
    crc = int(found[2], 16)
    if end < 0 or data[end - 1 : end] != b"}" or zlib.crc32(body) != crc:
        what = "the head of the journal is " + ("cut" if end < 0 else "damaged: its checksum does not fit")
        raise InputError(what, file=path, where="first line", hint="copy it again; without its head it says nothing")
    try:
        header: dict[str, Any] = json.loads(body)
    except (ValueError, RecursionError) as error:
        raise InputError("the head of the journal is no JSON", file=path, where="first line") from error
    return header, crc, end + 1


def packed(mark: bytes, number: int, content: bytes, seed: int) -> bytes:
    """One record."""
    record = HEAD.pack(mark, len(content), number) + content
    return record + CRC.pack(zlib.crc32(record, seed))


def records(data: bytes, start: int, seed: int) -> Iterator[Record | Loss]:
    """All whole records in their order, and what was lost between and after them."""
    at, number, searched = start, 0, 0
    while at < len(data):
        record = _record(data, at, seed, number)
        if record is None:
            record, searched = _next_record(data, at, seed, number, searched)
            if record is None:
                yield Loss(at, len(data) - at, None, _why(data, at, searched))
                return
        begin = record.end - len(record.content) - HEAD.size - CRC.size
        if begin > at or record.number > number:
            why = "damaged" if begin > at else "missing"
            yield Loss(at, begin - at, record.number - number, why)
        yield record
        at, number = record.end, record.number + 1


def _record(data: bytes, at: int, seed: int, number: int) -> Record | None:
    """The record at a place, numbered at least `number`; None where there is no whole one."""
    if at + HEAD.size + CRC.size > len(data):
        return None
    mark, length, found = HEAD.unpack_from(data, at)
    end = at + HEAD.size + length
    if mark not in (SAMPLE_MARK, EVENT_MARK) or length > MAX_EVENT or found < number or end + CRC.size > len(data):
        return None
    if zlib.crc32(data[at:end], seed) != CRC.unpack_from(data, end)[0]:
        return None
    return Record(mark, found, data[at + HEAD.size : end], end + CRC.size)


def _next_record(data: bytes, at: int, seed: int, number: int, searched: int) -> tuple[Record | None, int]:
    """The first whole record after a place, and the bytes gone over so far."""
    for found in _MARKS.finditer(data, at + 1, len(data) - HEAD.size):
        if record := _record(data, found.start(), seed, number):
            return record, searched
        _, length, _ = HEAD.unpack_from(data, found.start())
        searched += min(length, MAX_EVENT)
        if searched > MAX_SEARCH:
            break
    return None, searched


def _why(data: bytes, at: int, searched: int) -> str:
    rest = data[at:]
    if not rest.strip(b"\0"):
        return "zeros: the computer went down before the disk had them"
    if searched > MAX_SEARCH:
        return "damaged, and no whole record found within reach"
    whole = HEAD.size + CRC.size
    if len(rest) < whole or (rest[:2] in (SAMPLE_MARK, EVENT_MARK) and HEAD.unpack_from(rest)[1] + whole > len(rest)):
        return "the last record is cut"
    return "damaged"
