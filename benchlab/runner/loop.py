"""The loop of a run, from its first tick to the cause of its end. Venting is its caller's."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np

from benchlab.bench import Bench, LimitError
from benchlab.control.controller import Controller
from benchlab.devices.interface import Device, Fault
from benchlab.protocol.plan import Plan
from benchlab.runner.clock import Clock
from benchlab.runner.end import Cause
from benchlab.runner.guards.choice import Guard
from benchlab.runner.guards.device import too_late
from benchlab.runner.stop import Stop
from benchlab.runner.tick import Tick

LOOK_S = 0.02
"""How long a wait goes on without a look at what is asked from outside."""

NAN = math.nan


class Journal(Protocol):
    """Where samples and events go; `benchlab.io.journal.JournalWriter` is one."""

    def sample(self, *values: Any) -> None: ...

    def event(self, kind: str, **content: Any) -> None: ...


class Loop:
    """One run of a plan. ticks: done; late_s: of each. faults, paused_s: in all. What the journal has not got yet waits for `write`."""

    def __init__(
        self,
        plan: Plan,
        device: Device,
        bench: Bench,
        journal: Journal,
        clock: Clock,
        controller: Controller | None,
        guards: Sequence[Guard],
        on_tick: Callable[[Tick], None] | None,
        stop: Stop,
        most_late_s: float,
        pause_limit_s: float,
    ) -> None:
        self.plan, self.device, self.bench, self.journal, self.clock = plan, device, bench, journal, clock
        self.controller, self.guards, self.on_tick, self.stop = controller, guards, on_tick, stop
        self.most_late_s, self.pause_limit_s = most_late_s, pause_limit_s
        self.top_MPa = min(plan.limit_MPa, bench.ceiling_MPa) + 1e-9
        self.ahead_deg = ahead_of(plan, 0.0 if controller is None else controller.lead_s)
        self.ticks = self.faults = 0
        self.late_s = array("d")
        self.paused_s = self.shift_s = 0.0
        self._command_MPa, self._angle_deg = 0.0, NAN
        self._index, self._step, self._controlling = 0, 0, False
        self._sample: tuple[Any, ...] | None = None
        self._faults: list[Fault] = []

    def run(self) -> Cause:
        """All ticks of the plan, or those up to the cause that is given back. What device, controller or journal raise goes through."""
        plan, events = self.plan, self.plan.events_by_tick()
        rows = zip(plan.time_s.tolist(), plan.step.tolist(), plan.pressure_MPa.tolist(), plan.reference_deg.tolist())
        for index, (time_s, step, pressure, reference) in enumerate(rows):
            cause = self._wait(time_s + self.shift_s)
            if cause is None and self.stop.paused and index:  # before the first tick there is nothing to hold
                cause = self._pause(index, time_s)
            if cause is not None:
                return cause
            command, here = self._asked(index, pressure, reference), events.get(index, ())
            trigger = any(event.kind == "trigger" for event in here)
            self._step = step
            if cause := self._tick(index, time_s + self.shift_s, command, reference, trigger):
                return cause
            for event in here:
                self.journal.event(event.kind, tick=index, time_s=self.clock.now_s(), text=event.text)
        return self._wait(plan.duration_s + self.shift_s) or Cause("completed", "to the end of the plan")

    def write(self) -> None:
        """What was measured last goes into the journal, if it is not there."""
        if self._sample is not None:
            self.journal.sample(*self._sample)
            self._sample = None
        while self._faults:
            fault = self._faults.pop(0)
            self.journal.event("fault", cause=fault.cause, count=fault.count, time_s=self.clock.now_s())

    def watch_until(self, time_s: float) -> bool:
        """Wait for a look at the vented bench; whether it is still wanted."""
        self._sleep(time_s, lambda: self.stop.enough)
        return not self.stop.enough

    def look(self) -> Tick:
        """Ask the vented bench for 0 MPa; what it answers waits for `write`. It is a tick after the plan: it has the last one's number."""
        self._step = len(self.plan.steps)
        return self._ask(self._index, self.clock.now_s(), 0.0, NAN, held=True)

    def ask_faults(self) -> int:
        """Take what the device has to tell; how many faults."""
        if not (faults := self.device.faults()):
            return 0
        self._faults += faults
        count = sum(fault.count for fault in faults)
        self.faults += count
        return count

    def _wait(self, until_s: float) -> Cause | None:
        """Until the deadline, or until somebody wishes to stop."""
        self._sleep(until_s, lambda: self.stop.cause is not None)
        return self.stop.seen()

    def _sleep(self, until_s: float, over: Callable[[], bool]) -> None:
        """Until then, with a look now and then whether it is over before."""
        while (now := self.clock.now_s()) < until_s and not over():
            self.clock.wait_until(min(until_s, now + LOOK_S))

    def _pause(self, index: int, time_s: float) -> Cause | None:
        """Hold what was asked for last, with guards and journal at work, until it goes on: the plan's time stands still."""
        began = self.clock.now_s()
        self.journal.event("pause", tick=index, time_s=began)
        try:
            cause = self._hold(index - 1, began)
        finally:
            now = self.clock.now_s()
            self.paused_s += now - began
        self.shift_s, self._controlling = now - time_s, False
        if cause is None:
            self.journal.event("resume", tick=index, time_s=now)
        return cause

    def _hold(self, index: int, began_s: float) -> Cause | None:
        held, period_s = 0, 1 / self.plan.rate_Hz
        while self.stop.paused:
            if held * period_s >= self.pause_limit_s:
                return Cause("pause", f"a pause lasts {self.pause_limit_s:g} s at most, and nobody resumed")
            cause = self._tick(index, began_s + held * period_s, self._command_MPa, NAN, held=True)
            held += 1
            if cause := cause or self._wait(began_s + held * period_s):
                return cause
        return None

    def _asked(self, index: int, pressure_MPa: float, reference_deg: float) -> float:
        """The pressure for this tick: the plan's or, where it leaves that open, the controller's."""
        if not math.isnan(pressure_MPa):
            self._controlling = False
            return pressure_MPa
        if self.controller is None:
            raise ValueError(f"the plan leaves the pressure of tick {index} open, and there is no controller")
        if not self._controlling:
            self.controller.start(self._command_MPa)
            self._controlling = True
        dt_s = 1 / self.plan.rate_Hz
        return self.controller.pressure_MPa(reference_deg, self.ahead_deg[index], self._angle_deg, dt_s)

    def _tick(
        self,
        index: int,
        deadline_s: float,
        command_MPa: float,
        reference_deg: float,
        trigger: bool = False,
        held: bool = False,
    ) -> Cause | None:
        """Check, ask, guard, write. Where a guard stops the run, what was measured waits for `write`, as venting comes first."""
        if command_MPa > self.top_MPa:
            raise LimitError(f"{command_MPa:g} MPa at tick {index} is above the limit, {self.top_MPa:.4g} MPa")
        late = max(0.0, self.clock.now_s() - deadline_s)
        if late > self.most_late_s:
            return too_late(index, late, self.most_late_s)
        tick = self._ask(index, deadline_s, command_MPa, reference_deg, trigger, held)
        for guard in self.guards:
            if cause := guard.check(tick):
                return cause
        self.write()
        if self.on_tick is not None:
            self.on_tick(tick)
        return None

    def _ask(
        self,
        index: int,
        deadline_s: float,
        command_MPa: float,
        reference_deg: float,
        trigger: bool = False,
        held: bool = False,
    ) -> Tick:
        """One exchange with the device; what it measured waits for `write`."""
        code = self.bench.code(command_MPa)
        self._index, now = index, self.clock.now_s()
        reading = self.device.exchange(now, command_MPa, trigger)
        answer_s, late = self.clock.now_s() - now, max(0.0, now - deadline_s)
        angle = NAN if self.bench.flex is None else self.bench.flex.of(reading.flex_V)
        self._command_MPa, self._angle_deg = command_MPa, angle
        if not held:
            self.ticks += 1
            self.late_s.append(late)
        faults, status = self.ask_faults(), int(reading.status)
        fault = self._faults[-1].cause if faults else ""
        tick = Tick(index, now, late, command_MPa, reading, status, angle, reference_deg, faults, fault, held)
        self._sample = sample_of(tick, self._step, answer_s, self.bench.volts(code))
        return tick


def sample_of(tick: Tick, step: int, answer_s: float, command_V: float) -> tuple[Any, ...]:
    """A tick in the order of the journal's SAMPLE."""
    reading = tick.reading
    return (
        tick.index,
        step,
        tick.time_s,
        tick.late_s,
        answer_s,
        tick.command_MPa,
        command_V,
        reading.code,
        reading.pressure_MPa,
        reading.flex_V,
        tick.angle_deg,
        tick.reference_deg,
        reading.device_time_s,
        tick.status,
        reading.monitor_V,
    )


def ahead_of(plan: Plan, lead_s: float) -> list[float]:
    """(T,) the reference lead_s after each tick; a stretch of closed loop ends with its last value."""
    ahead = np.full(len(plan.time_s), NAN)
    known = np.isfinite(plan.reference_deg)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int)))
    for first, end in zip(edges[::2], edges[1::2]):
        here = slice(first, end)
        ahead[here] = np.interp(plan.time_s[here] + lead_s, plan.time_s[here], plan.reference_deg[here])
    return list(ahead.tolist())
