"""What comes from outside while a run goes on: stop, pause, go on. By signal, by key, or from another thread."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from benchlab.runner.end import Cause

SIGNALS = {
    "SIGINT": Cause("interrupted", "interrupted from the keyboard"),
    "SIGTERM": Cause("terminated", "told to stop by SIGTERM"),
    "SIGHUP": Cause("hung up", "the terminal was closed (SIGHUP)"),
}
"""What a signal asks for. SIGUSR1 pauses and resumes."""

QUIT = Cause("quit", "stopped with the key q")
PATIENCE_S = 1.0


class Stop:
    """Wishes that the loop looks at between ticks. The first wish to stop is the one that counts.

    Signals only set it: nothing is raised into the loop, so that no signal comes between it and its vent. Only where the loop has
    not looked for longer than PATIENCE_S, a second signal raises KeyboardInterrupt, once. pausable: not so in virtual time, where any
    pause is over at once.

    After the loop a wish says that it is enough: of watching the bench, which was vented before, or of drawing pictures. While files are
    written, one more wish after PATIENCE_S raises KeyboardInterrupt.
    """

    def __init__(self, pausable: bool = True) -> None:
        self.cause: Cause | None = None
        self.pausable, self.paused = pausable, False
        self.over = self.enough = self.writing = False
        self._asked_at = 0.0
        self._seen = False

    def ask(self, cause: Cause) -> None:
        """End the run, vented, for this cause; or, where it has ended, what comes after it."""
        if self.over:
            self._asked_at, self.enough = time.monotonic(), True
        elif self.cause is None:
            self._asked_at, self.cause = time.monotonic(), cause

    def toggle_pause(self) -> None:
        self.paused = self.pausable and not self.paused

    def seen(self) -> Cause | None:
        """The cause to end for, if there is one; from then on signals are left without effect."""
        if self.cause is not None:
            self._seen = True
        return self.cause

    def close(self) -> None:
        """From here on no signal raises anything: the loop is over, and the bench is vented."""
        self._seen = self.over = True

    def write(self) -> None:
        """From here on the bench is closed, and files are written."""
        self._seen = self.over = self.writing = True

    def on_signal(self, number: int, frame: Any) -> None:
        name = signal.Signals(number).name
        if name not in SIGNALS:
            self.toggle_pause()
        elif self._waits_in_vain() and time.monotonic() - self._asked_at > PATIENCE_S:
            self._seen = True
            raise KeyboardInterrupt
        else:
            self.ask(SIGNALS[name])

    def _waits_in_vain(self) -> bool:
        """Whether something was wished for and has not been heard."""
        return self.enough if self.writing else self.cause is not None and not self._seen


@contextmanager
def signals_to(stop: Stop) -> Iterator[None]:
    """While the block runs, signals go to `stop`. Where this is not the main thread, none are taken."""
    before: dict[int, Any] = {}
    if threading.current_thread() is threading.main_thread():
        for name in (*SIGNALS, "SIGUSR1"):
            if (number := getattr(signal, name, None)) is not None:
                before[number] = signal.signal(number, stop.on_signal)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
