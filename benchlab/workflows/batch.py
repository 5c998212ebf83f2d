"""Many items, one after another or several at once: each done, skipped or failed with its reason, never lost."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from benchlab.errors import BatchError, BenchlabError

Item = TypeVar("Item")


@dataclass(frozen=True)
class Outcome(Generic[Item]):
    """What became of one item: its result, or the error that ended it."""

    item: Item
    result: dict[str, Any] | None
    error: BenchlabError | None


def run_batch(
    items: Sequence[Item], work: Callable[[Item], dict[str, Any]], jobs: int = 1, *, disposable: bool = False
) -> Generator[Outcome[Item], None, None]:
    """Outcomes as they come. With jobs > 1, `work` and the items must be picklable.

    An expected error ends its item alone. A worker that dies (killed, out of memory) takes its items with it: each is
    tried once more, on its own, and marked failed if that kills the worker again. disposable: `work` only computes, so that its
    workers take no Ctrl-C, and are killed where the batch is left early; others end their items first.
    """
    if jobs <= 1:
        for item in items:
            yield attempt(item, work)
        return
    yield from _in_processes(items, work, jobs, disposable)


def attempt(item: Item, work: Callable[[Item], dict[str, Any]]) -> Outcome[Item]:
    """The outcome of one item; an expected error ends it."""
    try:
        return Outcome(item, work(item), None)
    except BenchlabError as error:
        return Outcome(item, None, error)


@contextmanager
def _deaf(disposable: bool) -> Iterator[None]:
    """Processes that are started in the block take no Ctrl-C; ours is taken after it."""
    if not disposable or not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _workers(jobs: int, disposable: bool) -> Iterator[ProcessPoolExecutor]:
    """A pool; disposable: left by an exception, its workers are killed, otherwise they end what they have begun."""
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn"))
    try:
        yield pool
    except BaseException:
        for worker in set(multiprocessing.active_children()) - others if disposable else ():
            worker.kill()
        raise
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _in_processes(
    items: Sequence[Item], work: Callable[[Item], dict[str, Any]], jobs: int, disposable: bool
) -> Iterator[Outcome[Item]]:
    lost: list[Item] = []
    with _workers(jobs, disposable) as pool:
        with _deaf(disposable):
            waiting: dict[Future[Outcome[Item]], Item] = {pool.submit(attempt, item, work): item for item in items}
        while waiting:
            done, _ = wait(waiting, return_when=FIRST_COMPLETED)
            for future in done:
                item = waiting.pop(future)
                try:
                    yield future.result()
                except BrokenProcessPool:
                    lost.append(item)
    for item in lost:
        with _workers(1, disposable) as single:
            try:
                with _deaf(disposable):
                    future = single.submit(attempt, item, work)
                yield future.result()
            except BrokenProcessPool:
                yield Outcome(item, None, BatchError("its worker process died twice", hint="is there enough memory?"))
