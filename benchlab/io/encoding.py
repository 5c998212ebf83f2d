"""The encoding of a text file: by its byte order mark, by UTF-8's own grammar, or by words that only one code page spells."""

from __future__ import annotations

import codecs
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchlab.errors import InputError, UsageError, printable
from benchlab.io.export_words import COLUMN_WORDS, PREAMBLE_WORDS

_NOT_TEXT = (
    (b"PK\x03\x04", "an Excel file or a zip archive", "save it as CSV"),
    (b"\xd0\xcf\x11\xe0", "an Excel file of the old kind", "save it as CSV"),
    (b"\x1f\x8b", "compressed (gzip)", "unpack it first"),
    (b"BZh", "compressed (bzip2)", "unpack it first"),
    (b"\xfd7zXZ\x00", "compressed (xz)", "unpack it first"),
    (b"\x28\xb5\x2f\xfd", "compressed (zstandard)", "unpack it first"),
    (b"7z\xbc\xaf\x27\x1c", "compressed (7z)", "unpack it first"),
    (b"\x89HDF", "an HDF5 file", None),
    (b"%PDF", "a PDF", None),
    (b"\x89PNG", "a picture", None),
    (b"\xff\xd8\xff", "a picture", None),
    (b"\x1a\x45\xdf\xa3", "a video", None),
    (b"OggS", "a video or sound", None),
    (b"RIFF", "a video or sound", None),
)
_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_CODE_PAGES = ("cp1252", "cp1250", "gbk", "cp1251", "cp1254", "cp932", "cp949", "big5", "iso8859-2", "mac_roman")
"""Encodings that are tried on a file that is not UTF-8; where two give the same text, the first is named."""

_WORDS = [w for w in {w for words in COLUMN_WORDS.values() for w in words} | set(PREAMBLE_WORDS) if not w.isascii()]
_LINE_END = re.compile(rb"[\r\n]")
_CUT = ("unexpected end of data", "truncated data", "incomplete multibyte sequence")


@dataclass(frozen=True)
class Decoded:
    """A file's content as UTF-8 without a mark, the name of the encoding that it had, and what is not certain about it."""

    data: bytes
    encoding: str
    doubt: str | None = None


def check_text(path: Path, head: bytes) -> None:
    """Raises InputError where the first bytes of a file are those of something else than text."""
    for magic, kind, hint in _NOT_TEXT:
        if head.startswith(magic):
            raise InputError(f"this is {kind}, not a text table", file=path, hint=hint)
    if head[4:8] == b"ftyp":
        raise InputError("this is a video, not a text table", file=path)
    start = head.lstrip(codecs.BOM_UTF8 + b" \t\r\n")[:100].lower()
    if start.startswith((b"<!doctype html", b"<html", b"<?xml", b"<head")):
        raise InputError("this is a web page, not a text table", file=path, hint="was a login page saved instead?")


def unicode_encoding(head: bytes) -> str | None:
    """The encoding that a byte order mark or the zeros of plain UTF-16 give away; None without either."""
    for mark, name in _MARKS:
        if head.startswith(mark):
            return name
    sample = head[: len(head) // 2 * 2][:400]
    even, odd = (sample[i::2].count(0) / max(1, len(sample) // 2) for i in (0, 1))
    if len(sample) >= 4 and even == 0 and odd > 0.5:
        return "utf-16-le"
    return "utf-16-be" if len(sample) >= 4 and odd == 0 and even > 0.5 else None


def decoded(path: Path, data: bytes, encoding: str | None = None) -> Decoded:
    """Content of a file as UTF-8. encoding: as Python names it; None finds out.

    Raises InputError, with the line, where it is not text in its encoding; UsageError for an unknown encoding.
    """
    name = _checked(encoding) if encoding else unicode_encoding(data[:400])
    if name is None:
        if data.isascii():
            return Decoded(data, "ascii")
        try:
            return Decoded(data[: _utf8_end(data)], "utf-8")
        except UnicodeDecodeError:
            return _by_words(data)
    if name == "utf-8-sig" and data.isascii():
        return Decoded(data, "ascii")
    try:
        text = data.decode(name)
    except UnicodeDecodeError as error:
        if error.reason not in _CUT or error.start < len(data) - 8:
            line = data.count(b"\n", 0, error.start) + 1
            hint = "name another with --encoding" if encoding else "export it again, or say --encoding"
            raise InputError(f"not {name} text", file=path, where=f"line {line}", hint=hint) from error
        text = data[: error.start].decode(name)
    return Decoded(text.removeprefix("\ufeff").encode("utf-8", "replace"), encoding or name)


def _checked(encoding: str) -> str:
    try:
        "a".encode(encoding)
    except (LookupError, ValueError, TypeError):
        hint = "give one as utf-8, utf-16, cp1250, cp1252, gbk"
        raise UsageError(f"--encoding: {printable(encoding)!r} is not known", hint=hint) from None
    name = codecs.lookup(encoding).name
    return "utf-8-sig" if name == "utf-8" else name


def _utf8_end(data: bytes) -> int:
    """Length of the data without a last character that was cut. UnicodeDecodeError where it is not UTF-8."""
    try:
        data.decode("utf-8")
    except UnicodeDecodeError as error:
        if error.reason in _CUT and error.start >= len(data) - 4:
            return error.start
        raise
    return len(data)


def _by_words(data: bytes) -> Decoded:
    """The code page in which most known words appear; CP1252, with a doubt, where none tells."""
    foreign = _foreign_lines(data)
    sample = b"\n".join(foreign)
    found: dict[str, tuple[int, str]] = {}
    for name in _CODE_PAGES:
        try:
            text = sample.decode(_codec(name)).lower()
        except UnicodeDecodeError:
            continue
        found[name] = (sum(word in text for word in _WORDS), text)
    best = max((score for score, _ in found.values()), default=0)
    for name, (score, _) in found.items():
        if score == best > 0:
            try:
                return Decoded(data.decode(_codec(name)).encode("utf-8"), name)
            except UnicodeDecodeError:
                continue
    name = "cp1252" if "cp1252" in found else "latin-1"
    shown = printable(foreign[0].decode(name, "replace").strip()[:40])
    doubt = f"not UTF-8 and no word tells its encoding: read as {name}, as in {shown!r}; --encoding settles it"
    return Decoded(data.decode(name, "replace").encode("utf-8"), name, doubt)


def _foreign_lines(data: bytes, most: int = 500) -> list[bytes]:
    """The first lines that are not ASCII."""
    lines, end = [], 0
    for at in np.flatnonzero(np.frombuffer(data, np.uint8) > 127).tolist():
        if at >= end:
            start = max(data.rfind(b"\n", 0, at), data.rfind(b"\r", 0, at)) + 1
            found = _LINE_END.search(data, at)
            end = found.start() if found else len(data)
            lines.append(data[start:end])
        if len(lines) == most:
            break
    return lines


def _codec(name: str) -> str:
    return "gb18030" if name == "gbk" else name
