"""The thresholds of the guards, and how the command line changes them."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from benchlab.errors import UsageError

MOST = {
    **{"follow_MPa": 0.2, "above_MPa": 0.1, "stuck_MPa": 1.0, "bend_share": 1.0, "fault_share": 1.0},
    **{"late_s": 10.0, "follow_s": 60.0, "lag_s": 30.0, "bend_s": 60.0, "stuck_s": 60.0, "sensor_s": 10.0},
    **{"rest_deg": 180.0, "swings": 1000.0, "empty_s": 60.0},
}
"""The largest number of each limit that still guards something; who wants none says `off`."""

UNSEEN = {
    "late_s": "ticks that come late",
    "follow_MPa": "a pressure that does not follow",
    "follow_s": "a pressure that does not follow",
    "above_MPa": "a pressure above the limit",
    "bend_share": "an actuator that does not bend",
    "bend_s": "an actuator that does not bend, or stays bent",
    "stuck_s": "a stuck sensor",
    "stuck_MPa": "a stuck sensor",
    "sensor_s": "a sensor off its scale",
    "fault_share": "faults on the line",
    "rest_deg": "an angle at rest that is not 0°",
    "swings": "a loop that oscillates",
    "empty_s": "whether the bench is empty at the end",
}
"""What is not seen where a limit is off."""

NEVER_OFF = ("lag_s",)
"""What is a number that guards go by, and no guard."""


@dataclass(frozen=True)
class Limits:
    """Thresholds of the guards; infinity switches one off.

    late_s: a command after its deadline. follow_MPa, follow_s, lag_s: how far the measured pressure may lie from what a regulator with this
    lag would give, and for how long; five times as far, for a quarter of the time. above_MPa: over the bench's limit. bend_share, bend_s:
    the least share of the expected angle. stuck_s: a sensor that reads exactly the same while the pressure asked for goes by stuck_MPa.
    sensor_s: without a number, or off the scale. fault_share: of the ticks of two seconds. rest_deg: of the vented bench at the
    beginning. swings: turns of a controlled pressure in ten seconds that its reference does not ask for. empty_s: how long the
    vented bench is watched at the end, until it is seen empty.
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
    empty_s: float = 3.0

    @classmethod
    def of(cls, words: tuple[str, ...]) -> Limits:
        """From words as `follow_MPa=0.02` and `bend_s=off`. UsageError for a name that there is not, no number above 0, or one of MOST.

        >>> Limits.of(("late_s=0.5", "bend_s=off")).bend_s
        inf
        """
        names = [each.name for each in fields(cls)]
        given = {}
        for word in words:
            name, _, text = word.partition("=")
            if name not in names:
                raise UsageError(f"--guard {word}: there is no limit {name!r}", hint=f"there are {', '.join(names)}")
            given[name] = _number(word, name, text)
        return cls(**given)

    @property
    def off(self) -> tuple[str, ...]:
        """Names of the limits that are switched off."""
        return tuple(each.name for each in fields(self) if math.isinf(getattr(self, each.name)))

    @property
    def off_words(self) -> list[str]:
        """A sentence on what is not watched, if anything is switched off.

        >>> Limits.of(("bend_s=off",)).off_words
        ['switched off by --guard, and not watched: an actuator that does not bend, or stays bent (bend_s)']
        """
        unseen: dict[str, list[str]] = {}
        for name in self.off:
            unseen.setdefault(UNSEEN[name], []).append(name)
        told = "; ".join(f"{what} ({', '.join(names)})" for what, names in unseen.items())
        return [f"switched off by --guard, and not watched: {told}"] if told else []


def _number(word: str, name: str, text: str) -> float:
    most, off = MOST[name], "" if name in NEVER_OFF else f" or {name}=off"
    if text == "off" and off:
        return math.inf
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not 0 < number <= most:
        what = f"--guard {word}: not a number above 0" if not number > 0 else f"--guard {word}: more than {most:g}"
        raise UsageError(what, hint=f"give {name}=NUMBER, up to {most:g},{off}".rstrip(","))
    return number
