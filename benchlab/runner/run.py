"""Executes a plan on a bench, tick by tick at absolute deadlines, in the caller's thread.

One tick: command from plan or controller -> limit -> device -> guards -> journal. A tick that is late is executed late, with its lateness
in its sample; none is skipped. Whatever ends a run, the bench is vented first, then it is watched until it is seen empty, and then it is
written why.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from benchlab.bench import Bench
from benchlab.control.controller import Controller
from benchlab.devices.interface import Device, LostError
from benchlab.protocol.plan import Plan
from benchlab.runner.clock import Clock
from benchlab.runner.empty import Sight
from benchlab.runner.end import Emptied, RunEnd, cause_of, judged
from benchlab.runner.guards.choice import Guard, guards_of
from benchlab.runner.guards.limits import Limits
from benchlab.runner.loop import Journal, Loop
from benchlab.runner.stop import Stop
from benchlab.runner.tick import Tick
from benchlab.runner.watch import watch

VENT_TRIES = 3


def execute(
    plan: Plan,
    device: Device,
    bench: Bench,
    journal: Journal,
    clock: Clock,
    controller: Controller | None = None,
    guards: Sequence[Guard] | None = None,
    on_tick: Callable[[Tick], None] | None = None,
    stop: Stop | None = None,
    limits: Limits | None = None,
    pause_limit_s: float = 10.0,
) -> RunEnd:
    """Arm the device, run the plan, vent, watch it empty. Never raises for what goes wrong on the way: the RunEnd says it, bugs included.

    controller: decides where the plan leaves the pressure open. guards: see `guards_of`, which is the default. on_tick: is called after
    each answer, in this thread, and must be quick. stop: wishes from outside. The device is left vented and open.
    """
    stop = stop or Stop()
    limits = limits or Limits()
    guards = guards_of(bench, plan.rate_Hz, limits) if guards is None else guards
    sight = Sight(bench)
    loop = Loop(
        plan, device, bench, journal, clock, controller, [sight, *guards], on_tick, stop, limits.late_s, pause_limit_s
    )
    try:
        device.arm()
        clock.start()
        cause = loop.run()
    except BaseException as error:
        stop.close()
        cause = cause_of(error)
    stop.close()
    time_s = clock.now_s()
    vented, vent_words = vent(device)
    trouble = _vent_written(loop, journal, clock.now_s(), vented, vent_words)
    emptied = Emptied(None, "nobody confirmed the vent")
    if vented:
        emptied = watch(loop, sight, limits.empty_s, cause.sensor, written=not trouble)
    end = RunEnd(
        judged(cause, emptied),
        vented,
        vent_words,
        emptied=emptied,
        ticks=loop.ticks,
        ticks_planned=len(plan.time_s),
        time_s=time_s,
        paused_s=loop.paused_s,
        faults=loop.faults,
        late_s=np.array(loop.late_s, float),
        trouble=trouble,
    )
    return _end_written(end, loop, journal)


def vent(device: Device) -> tuple[bool, str]:
    """Vent, and again if nobody confirmed it; whether it was confirmed, and what was said if not."""
    words = ""
    for _ in range(VENT_TRIES):
        try:
            device.vent()
        except LostError as error:
            words = str(error)
        except Exception as error:
            words = f"{type(error).__name__}: {error}"
        else:
            return True, ""
    return False, words


def _vent_written(loop: Loop, journal: Journal, time_s: float, vented: bool, words: str) -> str:
    """The last sample and faults, if the end came before they were written, and that it was vented. What went wrong, in words."""
    with suppress(Exception):
        loop.ask_faults()
    try:
        loop.write()
        journal.event("vent", time_s=time_s, confirmed=vented, text=words)
    except Exception as error:
        return cause_of(error).words
    return ""


def _end_written(end: RunEnd, loop: Loop, journal: Journal) -> RunEnd:
    """The last faults, and the stop record."""
    with suppress(Exception):
        loop.ask_faults()
    try:
        loop.write()
        end = replace(end, faults=loop.faults)
        journal.event("stop", **end.record())
    except Exception as error:
        return end.with_trouble(cause_of(error).words)
    return end
