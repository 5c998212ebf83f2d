"""The thresholds of the guards, and how the command line changes them."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from benchlab.errors import UsageError


@dataclass(frozen=True)
class Limits:
    """Thresholds of the guards; infinity switches one off.

    late_s: a command after its deadline. follow_MPa, follow_s, lag_s: how far the measured pressure may lie from what a regulator with this
    lag would give, and for how long; five times as far, for a quarter of the time. above_MPa: over the bench's limit. bend_share, bend_s:
    the least share of the expected angle. stuck_s: a sensor that reads exactly the same while the pressure asked for goes by stuck_MPa.
    sensor_s: without a number, or off the scale. fault_share: of the ticks of two seconds. rest_deg: of the vented bench at the
    beginning. swings: turns of a controlled pressure in ten seconds that its reference does not ask for.
    """

    late_s: float = 0.25
    follow_MPa: float = 0.010
    follow_s: float = 2.0
    lag_s: float = 0.5
    above_MPa: float = 0.02
    bend_share: float = 0.25
    bend_s: float = 1.0
    stuck_s: float = 1.0
    stuck_MPa: float = 0.1
    sensor_s: float = 0.1
    fault_share: float = 0.1
    rest_deg: float = 10.0
    swings: float = 8.0

    @classmethod
    def of(cls, words: tuple[str, ...]) -> Limits:
        """From words as `follow_MPa=0.02` and `bend_s=off`. UsageError for a name that there is not, or no number above 0.

        >>> Limits.of(("late_s=0.5", "bend_s=off")).bend_s
        inf
        """
        names = [each.name for each in fields(cls)]
        given = {}
        for word in words:
            name, _, text = word.partition("=")
            if name not in names:
                raise UsageError(f"--guard {word}: there is no limit {name!r}", hint=f"there are {', '.join(names)}")
            try:
                given[name] = math.inf if text == "off" else float(text)
            except ValueError:
                given[name] = math.nan
            if not given[name] > 0:
                raise UsageError(f"--guard {word}: not a number above 0", hint=f"give {name}=NUMBER or {name}=off")
        return cls(**given)
