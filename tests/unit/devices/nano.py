"""The firmware in its emulator, spoken to frame by frame; tests of it skip, saying so, where it cannot be compiled."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchlab.bench import Bench, Line
from benchlab.devices.emulated import LockstepTransport
from benchlab.devices.emulator import Emulator, State, missing_packages
from benchlab.devices.messages import (
    ARM,
    HELLO,
    SET,
    STATUS,
    VENT,
    Answer,
    answer_of,
    arm_payload,
    hello_of,
    set_payload,
)
from benchlab.devices.wire import Wire

BENCH = Bench("emulated", calibrated=True, monitor=Line(0.12, -0.12))
MISSING = missing_packages()
needs_emulator = pytest.mark.skipif(bool(MISSING), reason=f"no emulated Nano without {' '.join(MISSING)}")


class Nano:
    """A Nano from its boot on. Times in seconds, of its own."""

    def __init__(self, log: Path) -> None:
        self.log = log
        self.emulator = Emulator(BENCH, lockstep=True, log=log)
        self.line = LockstepTransport(self.emulator)
        self.wire = Wire()
        self.boot = -1

    def events(self, *kinds: str) -> list[tuple[float, str, int]]:
        """What happened: seconds, kind, value."""
        rows = [line.split() for line in self.log.read_text().splitlines()]
        return [(int(us) / 1e6, what, int(value)) for _, us, what, value in rows if not kinds or what in kinds]

    def tell(self, line: str) -> State:
        return self.emulator.tell(line)

    def run(self, seconds: float) -> State:
        """Let it go on, alone."""
        self.line.advance(self.line.clock_s() + seconds)
        self.line.read(0)
        return self.tell("state")

    def raw(self, data: bytes, seconds: float = 0.02) -> list[bytes]:
        """Say these bytes; the payload of each answer, whatever its number."""
        frames = []
        self.line.write(data)
        until = self.line.clock_s() + seconds
        while self.line.clock_s() < until:
            frames += self.wire.decoder.feed(self.line.read(until - self.line.clock_s()))
        return [frame.payload for frame in frames]

    def ask(self, command: int, payload: bytes = b"") -> Answer:
        self.line.write(self.wire.ask(command, payload))
        heard = self.wire.hear(self.line.read(0.05))
        assert heard is not None, "no answer"
        answer = answer_of(heard)
        assert answer is not None
        return answer

    def hello(self) -> None:
        if self.line.clock_s() < 0.05:
            self.run(0.05)  # it boots
        self.line.write(self.wire.ask(HELLO))
        hello = hello_of(self.wire.hear(self.line.read(0.2)) or b"")
        assert hello is not None
        self.said, self.boot = hello, hello.boot

    def arm(self) -> Answer:
        self.hello()
        return self.ask(ARM, arm_payload(self.boot))

    def set(self, code: int, trigger: bool = False) -> Answer:
        return self.ask(SET, set_payload(code, trigger))

    def vent(self) -> Answer:
        return self.ask(VENT)

    def status(self) -> Answer:
        return self.ask(STATUS)

    def hold(self, code: int, seconds: float) -> Answer:
        """Ask for a code at 100 Hz."""
        for _ in range(round(100 * seconds)):
            self.line.advance(self.line.clock_s() + 0.008)
            answer = self.set(code)
        return answer
