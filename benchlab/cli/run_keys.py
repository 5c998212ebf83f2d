"""Keys while a run goes on: p pauses and goes on, q stops. Only where standard input is a terminal that is ours."""

from __future__ import annotations

import importlib.util
import os
import select
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from benchlab.runner.stop import QUIT, Stop

LOOK_S = 0.1


def have_keys() -> bool:
    """Whether keys can be read: a terminal, of a system that has termios, and not in the background."""
    if importlib.util.find_spec("termios") is None:
        return False
    try:
        return sys.stdin.isatty() and os.tcgetpgrp(sys.stdin.fileno()) == os.getpgrp()
    except (OSError, ValueError):
        return False


@contextmanager
def keys_to(stop: Stop, wanted: bool) -> Iterator[None]:
    """While the block runs, keys go to `stop`, each without Enter; Ctrl-C stays a signal. The terminal is left as it was."""
    if not wanted:
        yield
        return
    import termios
    import tty

    terminal = sys.stdin.fileno()
    before = termios.tcgetattr(terminal)
    over = threading.Event()
    thread = threading.Thread(target=_read, args=(terminal, stop, over), daemon=True, name="benchlab keys")
    tty.setcbreak(terminal)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join(2 * LOOK_S)
        if have_keys():
            termios.tcsetattr(terminal, termios.TCSADRAIN, before)


def _read(terminal: int, stop: Stop, over: threading.Event) -> None:
    with suppress(OSError):
        while not over.is_set():
            if not select.select([terminal], [], [], LOOK_S)[0]:
                continue
            key = os.read(terminal, 1)
            if not key:
                return
            if key in b"pP":
                stop.toggle_pause()
            elif key in b"qQ":
                stop.ask(QUIT)
