"""Commands and their answers over a line: who waits how long, what is asked again, and the hello that a bench is opened with."""

from __future__ import annotations

import math
import typing

from benchlab.devices.interface import LostError
from benchlab.devices.messages import HELLO, PROTOCOL, Answer, Hello, answer_of, hello_of
from benchlab.devices.tally import Tally
from benchlab.devices.transport import BAUD, Transport
from benchlab.devices.wire import Wire
from benchlab.errors import BenchError

BOOT_S = 4.0
"""A Nano resets when its port is opened, and its bootloader waits up to 2 s for a new sketch."""

GARBAGE_S = 2.0
MUCH_GARBAGE = 200
"""Bytes; more than a bootloader says."""

HELLO_S = 0.2
TRY_S = 0.1
TRIES = 5

SUPPLY_S, SUPPLY_PAUSE_S = 0.5, 0.02
"""After a boot or a vent the firmware takes 0.07 s to measure its supply; it is waited for so long, and asked so often."""


SHOWN = 12
"""Bytes of what came instead of a frame."""


class Came(typing.NamedTuple):
    """What has come over a line so far that is no answer: bytes, frames with a wrong checksum, and frames that answer nothing asked."""

    bytes: int
    crc_errors: int
    old: int


class Conversation:
    """One side of a line to a Nano. tally: what went wrong on it."""

    def __init__(self, line: Transport) -> None:
        self.line, self.wire, self.tally = line, Wire(), Tally()
        self._bytes, self._last = 0, b""

    def came(self) -> Came:
        return Came(self._bytes, self.wire.decoder.crc_errors, self.wire.old)

    def instead(self, since: Came) -> str:
        """What has come since then, in words; empty where nothing did."""
        count, crc_errors, old = (now - before for now, before in zip(self.came(), since))
        if not count:
            return ""
        frames = [
            f"{number} {what}"
            for number, what in (
                (crc_errors, "with a wrong checksum"),
                (old, "that answer nothing that was asked: late, or an echo"),
            )
            if number
        ]
        told = f", frames: {', '.join(frames)}" if frames else ", none of them a frame"
        return f"{count} bytes came{told}; the last: {self._last[-SHOWN:]!r}"

    def hear(self, timeout_s: float) -> bytes | None:
        """Read; the payload of the answer to the last command, if it is whole now."""
        data = self.line.read(timeout_s)
        self._bytes += len(data)
        self._last = (self._last + data)[-SHOWN:]
        return self.wire.hear(data)

    def ask(self, command: int, payload: bytes, timeout_s: float) -> bytes | None:
        """Send, and wait for the answer to this and no other; None where it does not come in time."""
        line = self.line
        line.write(self.wire.ask(command, payload))
        until = line.clock_s() + timeout_s
        while (left := until - line.clock_s()) > 0:
            if (heard := self.hear(left)) is not None:
                return heard
        return None

    def insist(self, command: int, payload: bytes, what: str) -> Answer:
        """Ask up to TRIES times. LostError if nobody answers."""
        for _ in range(TRIES):
            heard = self.ask(command, payload, TRY_S)
            if heard is not None and (answer := answer_of(heard)):
                return answer
            self.tally.count(f"no answer to `{what}`; asked again")
        raise LostError(
            f"nobody answered `{what}` in {TRIES * TRY_S:g} s",
            file=self.line.name,
            hint="vent by hand; the firmware vents by itself once it hears nothing",
        )

    def greet(self) -> Hello:
        """What the firmware says of itself, once it has booted. BenchError where nothing answers, or no firmware of this protocol."""
        line, began = self.line, self.line.clock_s()
        line.read(0.0)
        before = self.came()
        garbage_since = math.inf
        while (now := line.clock_s()) - began < BOOT_S and now - garbage_since < GARBAGE_S:
            payload = self.ask(HELLO, b"", HELLO_S)
            if payload is not None and (hello := hello_of(payload)):
                hello = self._with_supply(self._of_this_protocol(hello))
                self.tally.start(self.wire)
                return hello
            if self.wire.decoder.garbage > MUCH_GARBAGE:
                garbage_since = min(garbage_since, now)
        waited = f"no valid frame in {line.clock_s() - began:.0f} s"
        if instead := self.instead(before):
            raise BenchError(
                f"{waited}, but {instead}",
                file=line.name,
                hint=f"is this the Nano, with benchlab's firmware, which speaks at {BAUD} baud? see docs/firmware.md",
            )
        raise BenchError(
            f"{waited}: nothing answers",
            file=line.name,
            hint="is the firmware on it (`benchlab bench firmware`), and is this the Nano's port?",
        )

    def _with_supply(self, hello: Hello) -> Hello:
        """The hello once the supply is measured, or as it is where the firmware never does."""
        until = self.line.clock_s() + SUPPLY_S
        while hello.reference == 0 and self.line.clock_s() < until:
            self.hear(SUPPLY_PAUSE_S)
            hello = hello_of(self.ask(HELLO, b"", HELLO_S) or b"") or hello
        return hello

    def _of_this_protocol(self, hello: Hello) -> Hello:
        if hello.protocol != PROTOCOL:
            raise BenchError(
                f"its firmware {hello.version} speaks protocol {hello.protocol}, this benchlab {PROTOCOL}",
                file=self.line.name,
                hint="write this benchlab's firmware with `benchlab bench firmware` and flash it",
            )
        return hello
