"""A flex sensor that does not read 0° on a bench that is at rest."""

from __future__ import annotations

import math
import statistics

from benchlab.runner.end import Cause
from benchlab.runner.guards.limits import Limits
from benchlab.runner.tick import Tick


class RestGuard:
    """The angle of the first ticks against 0°: a run begins vented, and an actuator without pressure is straight.

    Looked at once: the median of the first five ticks that ask for next to nothing, or of the first tick alone, at which nothing can have
    moved yet.
    """

    name = "angle at rest"
    REST_MPA, READINGS = 0.02, 5

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.angles: list[float] = []
        self.looked = False

    def check(self, tick: Tick) -> Cause | None:
        if self.looked:
            return None
        resting = tick.command_MPa <= self.REST_MPA
        if math.isfinite(tick.angle_deg) and (resting or not self.angles):
            self.angles.append(tick.angle_deg)
        if not self.angles or (resting and len(self.angles) < self.READINGS):
            return None
        self.looked = True
        angle = statistics.median(self.angles)
        if abs(angle) <= self.limits.rest_deg:
            return None
        words = f"the bench is vented and the flex sensor reads {angle:.1f}°, more than {self.limits.rest_deg:g}° from straight"
        look = "is offset_deg of the bench file right (its sign too), is it this actuator's sensor, is air left inside"
        return Cause("sensor", f"{words}: {look}? `benchlab control flex` calibrates it".replace(" -", " −"))
