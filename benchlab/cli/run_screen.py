"""What is seen of a run while it goes on: four lines on a terminal, a plain line now and then elsewhere. All on standard error.

Drawn from a thread of its own, ten times a second at most, so that a terminal that is slow, stopped or gone holds up nothing.
"""

from __future__ import annotations

import math
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from rich.cells import cell_len, set_cell_size

from benchlab.cli.progress import PLAIN_EVERY_S, fancy
from benchlab.errors import printable
from benchlab.protocol.plan import Plan
from benchlab.runner.stop import Stop
from benchlab.runner.tick import Tick

DRAW_EVERY_S = 0.1
ESC = "\x1b["
PLAIN, BOLD, DIM = f"{ESC}0m", f"{ESC}1m", f"{ESC}2m"


class Screen:
    """Takes ticks from the loop, which costs it an assignment, and puts the last one into words."""

    def __init__(self, plan: Plan, stop: Stop, keys: bool) -> None:
        self.plan, self.stop, self.keys = plan, stop, keys
        self.tick: Tick | None = None
        self.most_late_s, self.began_s = 0.0, math.nan

    def on_tick(self, tick: Tick) -> None:
        if self.tick is None:
            self.began_s = time.monotonic()
        self.tick = tick
        self.most_late_s = max(self.most_late_s, tick.late_s)

    def place(self, tick: Tick) -> str:
        """Where in the plan: `3.2 of 10.0 s, ramp to 0.35 MPa`."""
        plan = self.plan
        step = plan.steps[int(plan.step[tick.index])]
        return f"{plan.time_s[tick.index]:.1f} of {plan.duration_s:.1f} s{self.left(tick)}, {printable(step.label)}"

    def left(self, tick: Tick) -> str:
        """In virtual time, how long it still computes: ` (about 40 s left)`, once there is something to go by."""
        done, all_ticks = tick.index + 1, len(self.plan.time_s)
        passed_s = time.monotonic() - self.began_s
        if self.stop.pausable or passed_s < 1.0:
            return ""
        return f" (about {passed_s * (all_ticks - done) / done:.0f} s left)"

    def values(self, tick: Tick) -> str:
        """`set 0.210 MPa, measured 0.208 MPa, 62.4°, at most 0.9 ms late`."""
        measured, angle, reference = tick.reading.pressure_MPa, tick.angle_deg, tick.reference_deg
        parts = [f"set {tick.command_MPa:.3f} MPa"]
        parts += [f"measured {measured:.3f} MPa"] if math.isfinite(measured) else []
        wanted = f" of {reference:.1f}°" if math.isfinite(reference) else ""
        parts += [f"{angle:.1f}°{wanted}"] if math.isfinite(angle) else []
        parts += [f"at most {1e3 * self.most_late_s:.1f} ms late"] if self.most_late_s else []
        return ", ".join(parts)

    def hint(self) -> str:
        if self.stop.over:
            return "vented; watched until it is empty, Ctrl-C ends that"
        if self.stop.cause is not None:
            return "stopping"
        if self.stop.paused:
            return "PAUSED, holding: p goes on, q stops"
        if not self.keys:
            return "Ctrl-C stops"
        return "p pauses, q stops" if self.stop.pausable else "q stops"


@contextmanager
def shown(screen: Screen, title: str, quiet: bool) -> Iterator[None]:
    """Draw the screen while the block runs."""
    if quiet:
        yield
        return
    over, title = threading.Event(), printable(title)
    work = _drawing(screen, title, over) if fancy() else _printing(screen, title, over)
    thread = threading.Thread(target=work, daemon=True, name="benchlab screen")
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join(2.0)


def _drawing(screen: Screen, title: str, over: threading.Event) -> Callable[[], None]:
    """What a thread does on a terminal. Plain text, not rich.live: while one thread of Python computes, the others wait."""

    def draw() -> None:
        height = 0
        with suppress(OSError):
            while not over.wait(DRAW_EVERY_S):
                if screen.tick is not None:
                    width = os.get_terminal_size(sys.stderr.fileno()).columns
                    lines = drawn_lines(screen, screen.tick, title, width)
                    _put(up_by(height) + "".join(f"{line}\n" for line in lines))
                    height = len(lines)
            _put(up_by(height))

    return draw


def drawn_lines(screen: Screen, tick: Tick, title: str, width: int) -> list[str]:
    """Bar and title, place, values, keys: each fits into the width of the terminal."""
    room = max(10, min(60, width - len(title) - 2))
    full = round(room * tick.index / max(1, len(screen.plan.time_s) - 1))
    bar = "━" * full + "─" * (room - full)
    lines = [f"{title} {bar}", f"{screen.place(tick)}", screen.values(tick), screen.hint()]
    styles = [BOLD, PLAIN, PLAIN, BOLD if screen.stop.paused else DIM]
    return [f"{style}{_clipped(line, width - 1)}{PLAIN}" for style, line in zip(styles, lines)]


def up_by(height: int) -> str:
    """To the first of so many lines above, and all below erased."""
    return f"\r{f'{ESC}{height}A' if height else ''}{ESC}J"


def _clipped(line: str, width: int) -> str:
    return line if cell_len(line) <= width else f"{set_cell_size(line, width - 1)}…"


def _put(text: str) -> None:
    sys.stderr.write(text)
    sys.stderr.flush()


def _printing(screen: Screen, title: str, over: threading.Event) -> Callable[[], None]:
    """What a thread does elsewhere: a plain line now and then."""

    def say() -> None:
        with suppress(OSError):
            while not over.wait(PLAIN_EVERY_S):
                if (tick := screen.tick) is not None:
                    print(f"{title}: {screen.place(tick)}: {screen.values(tick)}", file=sys.stderr, flush=True)

    return say
