"""A line between bench and Nano that does to their frames what lines do."""

from __future__ import annotations

import random
import typing
from collections import deque

from benchlab.devices.transport import Transport


class FaultyLine:
    """Around another line. `down`, `up`: what is done to the next writes and reads, one word each, then nothing.

    ok, lose, double, flip (a bit), cut (half of it), noise (before it), late (with the next), swap (after the next).
    """

    def __init__(self, line: Transport, seed: int = 0) -> None:
        self.line, self.name, self.rng = line, line.name, random.Random(seed)
        self.down: deque[str] = deque()
        self.up: deque[str] = deque()
        self._kept = {"down": b"", "up": b""}
        self._swapped = {"down": b"", "up": b""}
        self.about, self.clock_s, self.advance, self.close = line.about, line.clock_s, line.advance, line.close

    def write(self, data: bytes) -> None:
        if changed := self._change("down", self.down, data):
            self.line.write(changed)

    def read(self, timeout_s: float) -> bytes:
        data = self.line.read(timeout_s)
        return self._change("up", self.up, data) if data else data

    def _change(self, way: str, faults: deque[str], data: bytes) -> bytes:
        fault = faults.popleft() if faults else "ok"
        before, self._kept[way] = self._kept[way], b""
        after, self._swapped[way] = self._swapped[way], b""
        if fault == "late":
            self._kept[way] = data
        if fault == "swap":
            self._swapped[way] = data
        at = self.rng.randrange(8 * len(data))
        flipped = bytearray(data)
        flipped[at // 8] ^= 1 << at % 8
        done: dict[str, typing.Callable[[], bytes]] = {
            "ok": lambda: data,
            "lose": lambda: b"",
            "double": lambda: data + data,
            "flip": lambda: bytes(flipped),
            "cut": lambda: data[: len(data) // 2],
            "noise": lambda: self.rng.randbytes(30).replace(b"\xb5", b"") + data,
            "late": lambda: b"",
            "swap": lambda: b"",
        }
        return before + done[fault]() + after
