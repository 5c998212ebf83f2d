"""The last seconds of a run: its bench is vented and disarmed, and asked on until it is seen empty."""

from __future__ import annotations

import math
from contextlib import suppress

from benchlab.errors import InputError
from benchlab.runner.empty import Sight
from benchlab.runner.end import Emptied
from benchlab.runner.loop import Loop

SLOWEST_S = 0.1
"""Between two looks at most, however slow the plan is."""

STEADY_S = 0.1
"""For so long it must look empty, so that it is not noise."""


def watch(loop: Loop, sight: Sight, limit_s: float, disbelieved: str = "", written: bool = True) -> Emptied:
    """Ask for 0 MPa at the plan's rate until the bench is seen empty, or nothing of it is seen, for limit_s at most, or until somebody has
    had enough.

    Every answer goes into the journal as a tick after the plan. disbelieved: a sensor that is not looked at. written: whether the journal
    takes anything. Never raises: what goes wrong is in the words.
    """
    if not loop.ticks:
        return Emptied(None, "nothing was asked for")
    if math.isinf(limit_s):
        return Emptied(None, "not watched, as empty_s is off")
    began, period_s = loop.clock.now_s(), min(1 / loop.plan.rate_Hz, SLOWEST_S)
    samples, passed, full_at = 0, 0.0, 0.0
    try:
        while passed < limit_s and passed - full_at < STEADY_S - 1e-9:
            if not loop.watch_until(began + samples * period_s):
                words = f"the watching was ended after {passed:.1f} s, when {sight.words(disbelieved)}"
                return Emptied(None, words, passed, samples)
            tick = loop.look()
            sight.check(tick)
            samples, passed = samples + 1, tick.time_s - began
            if sight.empty(disbelieved) is False:
                full_at = passed
            if written:
                written = _kept(loop)
            if loop.on_tick is not None:
                loop.on_tick(tick)
    except Exception as error:
        return Emptied(None, f"it could not be watched: {error}", passed, samples)
    return Emptied(sight.empty(disbelieved), sight.words(disbelieved), passed, samples)


def _kept(loop: Loop) -> bool:
    """Write what was seen; whether the journal takes more. A disk that is full does not end the watching; it is told at the stop record."""
    with suppress(InputError, OSError):
        loop.write()
        return True
    return False
