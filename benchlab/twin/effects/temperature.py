"""temperature: the film warms over a session, gets softer and bends more.

    θ → θ·(1 + b·ΔT·(1 − exp(−t/τ)))

b `per_K`: growth of the angle a kelvin, chosen 0.004. ΔT `rise_K`: of the session, chosen 5 K. τ `time_s`: chosen 900 s. t: since the
start of the run. Not measured. Off in the twin that comes with benchlab.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Now, Stage, number


@dataclass(frozen=True)
class Temperature(Effect):
    """Drift over a session."""

    name = "temperature"
    per_K: float = number(0.004, "1/K", -0.05, 0.05, "growth b of the angle a kelvin")
    rise_K: float = number(5, "K", -50, 50, "rise ΔT of the temperature over a session")
    time_s: float = number(900, "s", 1, 1e6, "time constant τ of the rise")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        def warmed(value: float, now: Now) -> float:
            return value * (1 + self.per_K * self.rise_K * (1 - math.exp(-now.since_s / self.time_s)))

        return {"angle": warmed}
