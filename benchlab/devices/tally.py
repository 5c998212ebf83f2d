"""What went wrong on a line, by cause, since it was last told."""

from __future__ import annotations

from benchlab.devices.interface import Fault
from benchlab.devices.wire import Wire

COUNTERS = 1 << 16


class Tally:
    """Counts by cause, from both ends: this one's decoder, and the counters that the device tells with each answer."""

    def __init__(self) -> None:
        self._counts: dict[str, int] = {}
        self._seen = (0, 0, 0)
        self._device: tuple[int, int] | None = None

    def start(self, wire: Wire) -> None:
        """What was on the line before is none of ours."""
        self._seen = _here(wire)

    def count(self, cause: str, number: int = 1) -> None:
        if number > 0:
            self._counts[cause] = self._counts.get(cause, 0) + number

    def device(self, crc_errors: int, dropped: int) -> None:
        """The device's own counters, which begin again at 0 after 65535 and after a boot."""
        if self._device is not None:
            before_crc, before_dropped = self._device
            self.count(
                "the device heard a command with a wrong checksum; it passed it over", _since(before_crc, crc_errors)
            )
            self.count(
                "the device heard an old, unfinished or unreadable command; it passed it over",
                _since(before_dropped, dropped),
            )
        self._device = (crc_errors, dropped)

    def take(self, wire: Wire) -> list[Fault]:
        """All since the last call."""
        crc_errors, garbage, old = (now - before for now, before in zip(_here(wire), self._seen))
        self._seen = _here(wire)
        self.count("an answer with a wrong checksum; passed over", crc_errors)
        if garbage and not crc_errors:
            self.count("bytes on the line that are no frame; passed over", 1)
        self.count("an answer that came late, or twice; passed over", old)
        told = [Fault(cause, number) for cause, number in self._counts.items()]
        self._counts.clear()
        return told


def _here(wire: Wire) -> tuple[int, int, int]:
    return wire.decoder.crc_errors, wire.decoder.garbage, wire.old


def _since(before: int, now: int) -> int:
    """Of a counter; one that fell was begun again at a boot or, from near its top, at 0."""
    return now - before if now >= before else now if before < COUNTERS - 1000 else now + COUNTERS - before
