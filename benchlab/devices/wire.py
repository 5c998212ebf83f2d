"""Frames and bytes, without a port: what is asked, what is heard, and what on the line was none of it.

A frame: sync 0xB5 · size of the payload · number (2 bytes) · command · payload · CRC (2 bytes); low bytes first. The CRC is
CRC-16 with the polynomial 0x1021 from 0xFFFF (CRC-16/IBM-3740) over all between sync and itself. An answer has the number of
its command, and the command's high bit set.
"""

from __future__ import annotations

import binascii
import struct
from dataclasses import dataclass

SYNC = 0xB5
HEAD = struct.Struct("<BBHB")
CRC = struct.Struct("<H")
MOST_PAYLOAD = 23
ANSWER = 0x80
NUMBERS = 1 << 16


@dataclass(frozen=True, slots=True)
class Frame:
    """number: 0 to 65535, of the command that it is or answers."""

    number: int
    command: int
    payload: bytes = b""


def encode(frame: Frame) -> bytes:
    """The bytes of a frame.

    >>> encode(Frame(7, 5)).hex()
    'b500070005f551'
    """
    body = HEAD.pack(SYNC, len(frame.payload), frame.number, frame.command) + frame.payload
    return body + CRC.pack(binascii.crc_hqx(body[1:], 0xFFFF))


class Decoder:
    """From bytes, in whatever pieces, to frames; keeps at most one unfinished frame.

    crc_errors: what looked like a frame and was damaged. garbage: bytes that belonged to no frame.

    >>> decoder = Decoder()
    >>> decoder.feed(b"noise" + encode(Frame(7, 5))[:4]), decoder.feed(encode(Frame(7, 5))[4:])
    ([], [Frame(number=7, command=5, payload=b'')])
    >>> decoder.garbage, decoder.crc_errors
    (5, 0)
    """

    def __init__(self) -> None:
        self.crc_errors = self.garbage = 0
        self._left = b""

    def feed(self, data: bytes) -> list[Frame]:
        """The frames that these bytes finish, in their order."""
        data, at, found = self._left + data, 0, []
        while True:
            sync = data.find(SYNC, at)
            if sync < 0:
                sync = len(data)
            self.garbage += sync - at
            at = sync
            if len(data) - at < 2:
                break
            size = data[at + 1]
            end = at + HEAD.size + size + CRC.size
            if size > MOST_PAYLOAD:
                self.garbage += 1
                at += 1
            elif end > len(data):
                break
            elif CRC.pack(binascii.crc_hqx(data[at + 1 : end - CRC.size], 0xFFFF)) != data[end - CRC.size : end]:
                self.crc_errors += 1
                self.garbage += 1
                at += 1
            else:
                _, _, number, command = HEAD.unpack_from(data, at)
                found.append(Frame(number, command, data[at + HEAD.size : end - CRC.size]))
                at = end
        self._left = data[at:]
        return found


class Wire:
    """One side of a conversation: numbers what is asked, and knows the answer to it from older ones.

    old: answers to earlier commands, or the same answer again; they are passed over.
    """

    def __init__(self, first: int = 1) -> None:
        self.decoder = Decoder()
        self.old = 0
        self.number = first - 1
        self._waiting = False
        self._command = 0

    def ask(self, command: int, payload: bytes = b"") -> bytes:
        """The bytes of the next command."""
        self.number = (self.number + 1) % NUMBERS
        self._command, self._waiting = command, True
        return encode(Frame(self.number, command, payload))

    def hear(self, data: bytes) -> bytes | None:
        """The payload of the answer to the last command, if these bytes finish it."""
        heard = None
        for frame in self.decoder.feed(data):
            if self._waiting and frame.number == self.number and frame.command == self._command | ANSWER:
                heard, self._waiting = frame.payload, False
            else:
                self.old += 1
        return heard
