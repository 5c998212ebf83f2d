"""clock_offset: the camera's clock runs ahead of the bench's, although its trigger is told.

    frame at time t of the film shows what was at t − Δt after the trigger

Δt `ahead_s`: chosen 0.05 s, between one and two frames. Off in the twin that comes with benchlab.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, number


@dataclass(frozen=True)
class ClockOffset(Effect):
    """Asked for by name where a film is drawn (workflows/twin_film)."""

    name = "clock_offset"
    ahead_s: float = number(0.05, "s", -10, 10, "time Δt by which the camera's clock is ahead")
