"""How far it is: bars with time left on a terminal, plain lines elsewhere. All on standard error."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from benchlab.errors import printable

PLAIN_EVERY_S = 10.0


class Reporter(Protocol):
    def __call__(self, done: int, total: int | None) -> None: ...


def fancy() -> bool:
    """Whether standard error is a terminal that draws bars."""
    return sys.stderr.isatty() and os.environ.get("TERM", "") not in ("", "dumb")


@contextmanager
def progress(label: str, quiet: bool = False) -> Iterator[Reporter | None]:
    """Yields what a workflow calls with frames done and frames in all (None where unknown)."""
    label = printable(label)
    if quiet:
        yield None
    elif fancy():
        yield from _bar(label)
    else:
        yield _Plain(label)


def _bar(label: str) -> Iterator[Reporter]:
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.text import Text

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[rate]}"),
               TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn())  # fmt: skip
    with Progress(*columns, console=Console(stderr=True), transient=True, refresh_per_second=5) as bar:
        task = bar.add_task(Text(label).markup, total=None, rate="")
        started = time.monotonic()
        last = 0.0

        def report(done: int, total: int | None) -> None:
            nonlocal last
            now = time.monotonic()
            if now - last > 0.1:
                last = now
                rate = done / max(now - started, 1e-6)
                bar.update(task, completed=done, total=max(total, done) if total else None, rate=f"{rate:.3g}/s")

        yield report


class Teller(Protocol):
    def __call__(self, words: str, done: int, total: int | None) -> None: ...


@contextmanager
def stages() -> Iterator[Teller]:
    """Yields what a workflow of several stages calls with what it is doing, and how much of it is done."""
    if not fancy():
        yield _PlainStages()
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
    from rich.text import Text

    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(bar_width=20), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True, refresh_per_second=5) as bar:
        task = bar.add_task("", total=None)

        def report(words: str, done: int, total: int | None) -> None:
            text = printable(words) + _of(done, total)
            bar.update(task, description=Text(text).markup, completed=done, total=total)

        yield report


def _of(done: int, total: int | None) -> str:
    """
    >>> _of(2, 5), _of(0, None)
    (' (2 of 5)', '')
    """
    return f" ({done} of {total})" if total else ""


class _PlainStages:
    """A line a stage, and one now and then within it."""

    def __init__(self) -> None:
        self.words, self.plain = "", _Plain("")

    def __call__(self, words: str, done: int, total: int | None) -> None:
        if words != self.words:
            self.words, self.plain = words, _Plain(printable(words))
            print(f"{self.plain.label}{_of(done, total)} …", file=sys.stderr, flush=True)
        self.plain(done, total)


class _Plain:
    """A line now and then, for logs."""

    def __init__(self, label: str) -> None:
        self.label, self.started, self.last = label, time.monotonic(), time.monotonic()

    def __call__(self, done: int, total: int | None) -> None:
        now = time.monotonic()
        if now - self.last >= PLAIN_EVERY_S:
            self.last = now
            known = total is not None and total > done > 0
            left = f" of {total}, {(now - self.started) * (total - done) / done:.0f} s left" if total and known else ""
            print(f"{self.label}: {done}{left}", file=sys.stderr, flush=True)
