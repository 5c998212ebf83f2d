"""How a run ended, and what that means to whoever called."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from benchlab.bench import LimitError
from benchlab.devices.interface import LostError, OutputError
from benchlab.errors import BenchError, InputError, printable
from benchlab.units import FloatArray

EXIT_CODES = {
    "completed": 0,
    "bug": 1,
    "journal": 3,
    "interrupted": 130,
    "terminated": 130,
    "hung up": 130,
    "quit": 130,
}
"""Exit code of a reason; all others are stops of the bench or for safety."""


WISHES = tuple(reason for reason, code in EXIT_CODES.items() if code == 130)
"""Reasons of a run that somebody ended."""


@dataclass(frozen=True)
class Cause:
    """Why a run ends. reason: a word or two, for machines. words: what was seen, the limit, what to look at. error: if one was raised.
    sensor: the name of one that is not believed any more."""

    reason: str
    words: str
    error: BaseException | None = None
    sensor: str = ""


@dataclass(frozen=True)
class Emptied:
    """What was seen after a vent. empty: None where nobody can tell. words: what it rests on. watched_s: for how long, by samples."""

    empty: bool | None
    words: str
    watched_s: float = 0.0
    samples: int = 0


@dataclass(frozen=True)
class RunEnd:
    """The end of a run, of which the journal's stop record has all but the lateness.

    vented: whether the device confirmed it; vent_words: what it said if not. emptied: what was seen after it. ticks: of the plan, that
    were asked of the device. time_s: of the cause. paused_s: in all. late_s: (ticks,) each command after its deadline. trouble: what
    could not be written at the end, empty if all was.
    """

    cause: Cause
    vented: bool
    vent_words: str
    ticks: int
    ticks_planned: int
    time_s: float
    paused_s: float
    faults: int
    late_s: FloatArray = field(repr=False)
    emptied: Emptied = Emptied(None, "not watched")
    trouble: str = ""

    @property
    def reason(self) -> str:
        return self.cause.reason

    @property
    def completed(self) -> bool:
        return self.cause.reason == "completed"

    @property
    def exit_code(self) -> int:
        """As in benchlab.errors; a bench that is not known to be vented, or seen not to be empty, is a failure whatever else happened."""
        code = EXIT_CODES.get(self.cause.reason, BenchError.exit_code)
        good = self.vented and self.emptied.empty is not False
        return code if good or code == EXIT_CODES["bug"] else BenchError.exit_code

    @property
    def late_ms(self) -> dict[str, float] | None:
        """Median, 99th percentile and largest lateness; None for a run without a tick."""
        if not len(self.late_s):
            return None
        p50, p99 = np.percentile(self.late_s, (50, 99))
        return {"p50": 1e3 * p50, "p99": 1e3 * p99, "max": 1e3 * float(self.late_s.max())}

    def with_trouble(self, words: str) -> RunEnd:
        """The same with what could not be written, if nothing was known of that yet."""
        return replace(self, trouble=self.trouble or words)

    def record(self) -> dict[str, Any]:
        """The stop record, in JSON's own types."""
        return {
            "reason": self.cause.reason,
            "words": self.cause.words,
            "vented": self.vented,
            "vent_words": self.vent_words,
            "empty": self.emptied.empty,
            "empty_words": self.emptied.words,
            "watched_s": self.emptied.watched_s,
            "samples_watched": self.emptied.samples,
            "ticks": self.ticks,
            "ticks_planned": self.ticks_planned,
            "time_s": self.time_s,
            "paused_s": self.paused_s,
            "faults": self.faults,
        }


def judged(cause: Cause, emptied: Emptied) -> Cause:
    """The cause of a run, after whose vent so much was seen: air that is left makes a failure of one that went well or was ended."""
    if emptied.empty is not False or cause.reason not in ("completed", *WISHES):
        return cause
    seen = f"{cause.words}, and {emptied.watched_s:.1f} s after the vent {emptied.words}"
    look = "exhaust blocked, tube kinked or a valve shut, or a bench that empties more slowly than `--guard empty_s=...` waits"
    return Cause("not empty", f"{seen}: {look}")


REASONS = (
    (LostError, "lost"),
    (LimitError, "limit"),
    (OutputError, "output"),
    (BenchError, "refused"),
    (InputError, "journal"),
)
"""Of exceptions; the first that fits."""


def cause_of(error: BaseException) -> Cause:
    """An exception as a cause: of the bench, of the user, or a bug."""
    if isinstance(error, KeyboardInterrupt):
        return Cause("interrupted", "interrupted from the keyboard, twice", error)
    for kind, reason in REASONS:
        if isinstance(error, kind):
            return Cause(reason, str(error), error)
    return Cause("bug", f"a bug in benchlab: {type(error).__name__}: {printable(error)}", error)
