"""A bench held at a pressure for as long as somebody reads a gauge: it is spoken to all the time, whatever the command waits for."""

from __future__ import annotations

import threading
import typing
from collections import deque
from types import TracebackType

from benchlab.devices.interface import Device, Reading, Status
from benchlab.errors import BenchError
from benchlab.runner.clock import RealClock
from benchlab.runner.run import vent

PERIOD_S = 0.02
"""Between two commands: a tenth of the silence after which a bench vents."""

RISE_MPA_PER_S = 0.1
"""How fast a level is gone to: slowly, so that none is overshot and hysteresis keeps its sense."""

PATIENCE_S = 300.0
"""A level is held for so long, and then vented: whoever read the gauge has gone."""

AVERAGED = 25
"""Most readings that a level's monitor volts are the mean of: half a second, and of the second half of the wait at most."""


class Hold(typing.Protocol):
    """An armed bench that can be asked to stand at a pressure."""

    def stand(self, pressure_MPa: float, settle_s: float) -> list[Reading]:
        """Go there, wait, and give the last readings, none of them from the way. BenchError where the bench vented, was lost or refused."""
        ...

    def check(self) -> None:
        """Raise what ended the holding, if it has ended."""
        ...


class ThreadHold:
    """Holds in real time from a thread of its own; `with` arms, and vents at every end.

    The thread vents, not the caller: signals reach the main thread only, so that a second Ctrl-C cannot interrupt it.
    """

    def __init__(
        self,
        device: Device,
        period_s: float = PERIOD_S,
        rise_MPa_per_s: float = RISE_MPA_PER_S,
        patience_s: float = PATIENCE_S,
    ) -> None:
        self._device, self._period_s, self._step_MPa = device, period_s, rise_MPa_per_s * period_s
        self._patience_s = patience_s
        self._target_MPa = self._level_MPa = self._asked_s = 0.0
        self._recent: deque[Reading] = deque(maxlen=AVERAGED)
        self._stop, self._armed, self._ended = threading.Event(), threading.Event(), threading.Event()
        self._error: BaseException | None = None
        self._clock = RealClock()
        self._thread = threading.Thread(target=self._run, name="benchlab holds the bench")

    def __enter__(self) -> ThreadHold:
        try:
            self._thread.start()
            while not self._armed.wait(0.05):
                self.check()
        except BaseException:
            self._leave()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._leave()
        if self._error is not None and error is not self._error:
            raise self._error

    def stand(self, pressure_MPa: float, settle_s: float) -> list[Reading]:
        self._asked_s = self._clock.now_s()
        self._target_MPa = pressure_MPa
        while abs(self._level_MPa - pressure_MPa) > 1e-9:
            self._pause(self._period_s)
        self._pause(settle_s / 2)
        self._recent.clear()
        self._pause(max(settle_s / 2, 3 * self._period_s))
        while not self._recent:
            self._pause(self._period_s)
        return list(self._recent)

    def check(self) -> None:
        if self._ended.is_set() and self._error is not None:
            raise self._error

    def _leave(self) -> None:
        """Wait until it is vented; what interrupts the waiting is raised after that.

        Not by joining the thread: Python 3.11 takes a thread for ended whose join was interrupted.
        """
        self._stop.set()
        interrupted: BaseException | None = None
        while self._thread.ident is not None and not self._ended.is_set():
            try:
                self._ended.wait()
            except BaseException as error:
                interrupted = error
        if interrupted is not None:
            raise interrupted

    def _pause(self, seconds: float) -> None:
        self._ended.wait(seconds)
        self.check()

    def _run(self) -> None:
        try:
            self._device.arm()
            self._armed.set()
            while not self._stop.is_set():
                if self._clock.now_s() - self._asked_s > self._patience_s:
                    raise BenchError(f"nobody asked for another level for {self._patience_s:g} s", hint="begin again")
                self._level_MPa = _towards(self._level_MPa, self._target_MPa, self._step_MPa)
                self._recent.append(_checked(self._device.exchange(self._clock.now_s(), self._level_MPa)))
                self._stop.wait(self._period_s)
        except BaseException as error:
            self._error = error
        finally:
            vented, words = vent(self._device)
            if not vented:
                self._error = not_vented(words)
            self._ended.set()


class VirtualHold:
    """Holds a bench whose time is what it is told: a twin or an emulated firmware, as fast as they can."""

    def __init__(self, device: Device, period_s: float = PERIOD_S, rise_MPa_per_s: float = RISE_MPA_PER_S) -> None:
        self._device, self._period_s, self._step_MPa = device, period_s, rise_MPa_per_s * period_s
        self._ticks, self._level_MPa = 0, 0.0

    def __enter__(self) -> VirtualHold:
        self._device.arm()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        vented, words = vent(self._device)
        if not vented:
            raise not_vented(words)

    def stand(self, pressure_MPa: float, settle_s: float) -> list[Reading]:
        while abs(self._level_MPa - pressure_MPa) > 1e-9:
            self._level_MPa = _towards(self._level_MPa, pressure_MPa, self._step_MPa)
            self._exchange()
        readings = [self._exchange() for _ in range(max(2, round(settle_s / self._period_s)))]
        return readings[len(readings) // 2 :][-AVERAGED:]

    def check(self) -> None:
        pass

    def _exchange(self) -> Reading:
        self._ticks += 1
        return _checked(self._device.exchange(self._ticks * self._period_s, self._level_MPa))


def not_vented(words: str) -> BenchError:
    """What to say, and to do, where nobody confirmed a vent."""
    return BenchError(
        f"NOT CONFIRMED VENTED: {words}",
        hint="close the supply and open the relief valve by hand, then look for the cause",
    )


def _towards(level: float, target: float, step: float) -> float:
    return min(level + step, target) if level < target else max(level - step, target)


def _checked(reading: Reading) -> Reading:
    if reading.status & Status.NO_ANSWER or (reading.status & Status.ARMED and not reading.status & Status.DAC_LOST):
        return reading
    said = ", ".join(flag.name.lower().replace("_", " ") for flag in reading.status if flag.name) or "not armed"
    raise BenchError(f"the bench is no longer armed, it vented: {said}", hint="see `benchlab bench monitor`")
