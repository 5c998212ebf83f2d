"""A Nano with the firmware's manners on a pty, for tests of commands; the true firmware is tested in its emulator."""

from __future__ import annotations

import os
import pty
import select
import struct
import threading
import time
import tty

from benchlab.bench import Line
from benchlab.devices.interface import Status
from benchlab.devices.messages import ARM, HELLO, PROTOCOL, SET, VENT
from benchlab.devices.wire import ANSWER, Decoder, Frame, encode

SILENCE_S, ADC_SAMPLES, TRUE_SUPPLY_V = 0.5, 8, 4.9  # the longest silence that is taken: a loaded machine hiccups
TICK_S = 0.01
REGULATOR, MONITOR = Line(0.0965, -0.001), Line(0.12, -0.12)


class SmallNano:
    """`with SmallNano() as nano:` answers on nano.port. deaf_to: commands that are not answered. sticks: pressure that a vent leaves.
    counts: of its reference on its supply; None is a firmware that does not measure it. heard: frames that came, answered or not."""

    def __init__(self, ceiling_code: int = 2730, deaf_to: tuple[int, ...] = (), sticks_MPa: float = 0.0,
                 counts: float | None = None) -> None:  # fmt: skip
        self.ceiling_code, self.deaf_to, self.sticks_MPa, self.counts = ceiling_code, deaf_to, sticks_MPa, counts
        self.code, self.armed, self.silent = 0, False, False
        self.power_on_code, self.silence_ms, self.patch = 0, round(1000 * SILENCE_S), 0
        self.highest_code = 0
        self.vents: list[str] = []
        self.heard, self._quiet = 0, 0
        self.master, self.slave = pty.openpty()
        tty.setraw(self.slave)
        self.port = os.ttyname(self.slave)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    @property
    def pressure_MPa(self) -> float:
        """What a gauge on it shows."""
        asked = max(0.0, REGULATOR.of(TRUE_SUPPLY_V * self.code / 4096)) if self.code else 0.0
        return max(asked, self.sticks_MPa)

    def __enter__(self) -> SmallNano:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()
        os.close(self.master)
        os.close(self.slave)

    def _run(self) -> None:
        decoder = Decoder()
        while not self._stop.is_set():
            if select.select([self.master], [], [], TICK_S)[0]:
                for frame in decoder.feed(os.read(self.master, 4096)):
                    self.heard += 1
                    if frame.command not in self.deaf_to:
                        self.answer(frame)
            else:  # counted in its own time: where the whole machine stood still, nobody was silent
                self._quiet += 1
            if self.armed and self._quiet * TICK_S > SILENCE_S:
                self._vent("silence")
                self.silent = True

    def _vent(self, why: str) -> None:
        self.armed, self.code = False, 0
        self.vents.append(why)

    def answer(self, frame: Frame) -> None:
        refused = Status(0)
        self._quiet = 0
        if frame.command in (HELLO, VENT):
            self._vent("hello" if frame.command == HELLO else "vent")
        elif frame.command == ARM:
            self.armed, self.silent = True, False
        elif frame.command == SET:
            code, _ = struct.unpack("<HB", frame.payload)
            if code > self.ceiling_code or (code and not self.armed):
                refused = Status.REFUSED
            else:
                self.code, self.highest_code = code, max(self.highest_code, code)
        status = refused | Status.ARMED * self.armed | Status.SILENCE * self.silent
        if frame.command == HELLO:
            payload = struct.pack(
                "<4B6H4B",
                PROTOCOL,
                1,
                int(self.counts is not None),
                self.patch,
                self.ceiling_code,
                40,
                self.silence_ms,
                125,
                1,
                self.power_on_code,
                1,
                ADC_SAMPLES,
                0x62,
                int(status),
            )
            if self.counts is not None:
                payload += struct.pack("<HB", round(64 * self.counts), 64)
        else:
            micros = int(time.monotonic() * 1e6) % 2**32
            payload = struct.pack("<4HI3H", self.code, *self._adc(), int(status), micros, 1, 0, 0)
        os.write(self.master, encode(Frame(frame.number, frame.command | ANSWER, payload)))

    def _adc(self) -> tuple[int, int]:
        """Sums of the conversions of 1 V at the flex sensor and of the monitor's volts."""
        volts = (1.0, MONITOR.inverse(self.pressure_MPa))
        flex, monitor = (round(ADC_SAMPLES * 1024 * v / TRUE_SUPPLY_V) for v in volts)
        return flex, monitor
