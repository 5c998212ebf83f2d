"""A recorded run played back as a bench, which fails on the first difference of what it is asked for."""

from __future__ import annotations

import typing
from collections.abc import Collection, Mapping

import numpy as np
from numpy.typing import NDArray

from benchlab.devices.interface import Fault, Reading, Status
from benchlab.errors import BenchError

SAME_MPA = 1e-9
"""Two pressures nearer than this are the same."""


class Replay:
    """Gives the readings of a run, tick after tick.

    samples: of the run, with the fields of a journal. about: what its device said of itself. triggers: ticks at which it was asked to
    trigger the camera; None compares no triggers. The time of a command is not compared, as it was real. Ticks that were held in a pause
    are passed over. A tick that the recording lacks, and one after its last, is a difference too. watched: how many of the last samples
    are of the vented bench; after a run that went as far as its recording they are given again.
    """

    kind = "replay"

    def __init__(
        self,
        samples: NDArray[np.void],
        about: Mapping[str, typing.Any],
        triggers: Collection[int] | None = None,
        watched: int = 0,
    ) -> None:
        samples, self._watched = samples[: len(samples) - watched], list(samples[len(samples) - watched :])
        self._about, self._triggers = dict(about), triggers
        ticks, first = np.unique(samples["tick"], return_index=True)
        self._rows = dict(zip(ticks.tolist(), samples[first]))
        self._last = int(ticks[-1]) if len(ticks) else -1
        self._next, self._armed, self._told = 0, False, False

    def about(self) -> dict[str, typing.Any]:
        return {**self._about, "kind": self.kind, "replayed": self._about.get("kind", "serial")}

    def arm(self) -> None:
        self._armed = True

    def exchange(self, time_s: float, pressure_MPa: float, trigger: bool = False) -> Reading:
        """The reading of the next tick. BenchError where what is asked differs from what was, with tick, field and both values."""
        if not self._armed and pressure_MPa > 0:
            raise BenchError(f"{pressure_MPa:g} MPa asked of a disarmed bench", hint="arm it first")
        tick = self._next
        if not self._armed and tick > self._last and self._watched:
            return reading_of(self._watched.pop(0))
        row = self._rows.get(tick)
        if row is None:
            ended = (
                f"the recording ends with tick {self._last}"
                if tick > self._last
                else f"the recording lacks tick {tick}"
            )
            raise BenchError(f"{ended}, and {pressure_MPa:g} MPa are asked for at tick {tick}", where="replay")
        if tick and not self._armed and int(row["status"]) & Status.ARMED:
            raise BenchError(f"tick {tick} is of an armed bench, and this one was vented", where="replay")
        self._check(tick, "command_MPa", float(row["command_MPa"]), pressure_MPa)
        if self._triggers is not None:
            self._check(tick, "trigger", tick in self._triggers, trigger)
        self._next += 1
        return reading_of(row)

    def vent(self) -> None:
        self._armed = False

    def faults(self) -> list[Fault]:
        """Once, after venting: that the recording goes on."""
        if self._armed or self._told or self._next > self._last or not self._next:
            return []
        self._told = True
        return [Fault(f"the recording goes on from tick {self._next} to {self._last}, which was not asked for")]

    def close(self) -> None:
        self.vent()

    @staticmethod
    def _check(tick: int, field: str, recorded: float, asked: float) -> None:
        if not abs(recorded - asked) <= SAME_MPA:
            was, now = (str(value) if isinstance(value, bool) else f"{value:.9g}" for value in (recorded, asked))
            what = f"tick {tick} differs from the recording: {field} was {was}, {now} is asked for"
            raise BenchError(
                what, where="replay", hint="a replay takes the protocol, the rate and the gains of its run"
            )


def reading_of(row: np.void) -> Reading:
    """What a bench answered, from a sample of its journal."""
    return Reading(
        float(row["pressure_MPa"]),
        float(row["flex_V"]),
        int(row["code"]),
        float(row["device_time_s"]),
        Status(int(row["status"])),
        float(row["monitor_V"]),
    )
