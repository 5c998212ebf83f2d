"""The line and the device: what it says of itself, faults, lateness."""

from __future__ import annotations

import typing

from benchlab.devices.interface import Status
from benchlab.runner.end import Cause
from benchlab.runner.tick import Tick

HUNG = (Status.REBOOTED | Status.WATCHDOG).value


class DeviceGuard:
    """What the device says of itself: it vented, it booted, its DAC is gone, it did not take a command, it is not armed."""

    name = "device"
    WORDS: typing.ClassVar = {
        Status.SILENCE: ("silence", "the device vented because it heard nothing for longer than its silence limit"),
        Status.REBOOTED: (
            "rebooted",
            "the device has booted since it was armed, and is vented: look at its supply and its cable",
        ),
        Status.DAC_LOST: ("dac lost", "the device's DAC does not acknowledge: look at its wires"),
        Status.REFUSED: ("refused", "the device did not take the pressure asked for, which is above its own ceiling"),
    }
    BAD = sum(map(int, WORDS))

    def check(self, tick: Tick) -> Cause | None:
        status = tick.status
        if status & Status.NO_ANSWER.value:
            return None
        if status & self.BAD:
            if status & HUNG == HUNG:
                return Cause(
                    "rebooted", "the device's main loop hung, its watchdog booted it, and it is vented: report it"
                )
            for flag, (reason, words) in self.WORDS.items():
                if status & flag.value:
                    return Cause(reason, words)
        if not status & Status.ARMED.value:
            return Cause("disarmed", "the device is not armed any more, and is vented")
        return None


def too_late(index: int, late_s: float, most_s: float) -> Cause:
    """The computer is too slow or was suspended, or the device takes longer than a tick to answer; the tick is not sent any more."""
    words = f"tick {index} comes {late_s:.3g} s after its deadline, more than {most_s:g} s"
    return Cause(
        "overrun",
        f"{words}: the computer is busy or slept, or the rate is more than the bench can answer; --guard late_s=... waits longer",
    )


class FaultGuard:
    """More faults in the last two seconds than a share of the ticks of two seconds.

    Looked at when an answer came: a line that stays silent is the device's to call lost.
    """

    name = "faults"
    OVER_S = 2.0

    def __init__(self, share: float, rate_Hz: float) -> None:
        self.most = max(5.0, share * rate_Hz * self.OVER_S)
        self.recent: list[tuple[float, int]] = []
        self.last = ""

    def check(self, tick: Tick) -> Cause | None:
        if tick.faults:
            self.recent = [(t, n) for t, n in self.recent if t > tick.time_s - self.OVER_S]
            self.recent.append((tick.time_s, tick.faults))
            self.last = tick.fault
        if not self.recent or tick.status & Status.NO_ANSWER.value:
            return None
        if (total := sum(n for t, n in self.recent if t > tick.time_s - self.OVER_S)) <= self.most:
            return None
        words = f"{total} faults on the line in {self.OVER_S:g} s, more than {self.most:g}, the last: {self.last}"
        return Cause(
            "faults",
            f"{words}; look at cable, plug and noise, or run at a lower rate; --guard fault_share=... allows more",
        )
