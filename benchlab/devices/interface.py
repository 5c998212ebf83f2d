"""What every bench does, be it of metal, emulated, simulated or replayed.

A device is plain and strict: out of range raises and never clips; venting and closing may be done twice; what went
wrong on the way is told by `faults`, never hidden.
"""

from __future__ import annotations

import enum
import math
import typing
from dataclasses import dataclass

from benchlab.errors import BenchError


class Status(enum.IntFlag):
    """What a bench says of itself with each reading."""

    ARMED = 1
    SLEWING = 2  # the output is still on its way to what was asked for
    SILENCE = 4  # vented because nobody spoke for longer than the silence limit
    WATCHDOG = 8  # the last boot came from the watchdog
    REFUSED = 16  # the command was above the ceiling and was not taken
    DAC_LOST = 32  # the DAC does not acknowledge
    NO_ANSWER = 64  # the device gave no answer to this command; all numbers are missing
    REBOOTED = 128  # the device has booted since it was armed


class LostError(BenchError):
    """The bench does not answer any more."""


class OutputError(BenchError):
    """The bench gives more than was asked for."""


@dataclass(frozen=True, slots=True)
class Reading:
    """What a bench answers to one command; NaN where it has no such sensor or gave no answer.

    pressure_MPa: measured at the regulator. flex_V: at the flex sensor's divider. code: that the DAC holds, −1 unknown.
    device_time_s: of the device's own clock. status: see Status. monitor_V: at the regulator's monitor output, which pressure_MPa is
    from; there too where the monitor is wired and not calibrated.
    """

    pressure_MPa: float
    flex_V: float
    code: int
    device_time_s: float
    status: Status
    monitor_V: float = math.nan


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that went wrong and was survived. cause: in words, with what was done about it. count: how often since last told."""

    cause: str
    count: int = 1


class Device(typing.Protocol):
    """One bench, open. Made disarmed: until `arm`, and after `vent`, any pressure above 0 is refused (BenchError)."""

    kind: str

    def about(self) -> dict[str, typing.Any]:
        """Everything that is worth keeping with a run: versions, limits, settings, seed. JSON's own types."""
        ...

    def arm(self) -> None:
        """Open the vent latch. BenchError where the device refuses."""
        ...

    def exchange(self, time_s: float, pressure_MPa: float, trigger: bool = False) -> Reading:
        """Ask for a pressure (MPa) and get the reading of now. time_s: of the run, never going back.

        trigger: pulse the camera's output. LimitError above the limit; LostError where no answer came for too long (single
        answers that are missing come as a Reading with NO_ANSWER).
        """
        ...

    def vent(self) -> None:
        """Ask for 0 MPa and close the latch. Idempotent; raises LostError where nobody confirmed it."""
        ...

    def faults(self) -> list[Fault]:
        """What went wrong since the last call."""
        ...

    def close(self) -> None:
        """Vent if that can still be done, and let go of the port. Idempotent, never raises."""
        ...
