"""Many items, one after another or several at once: each done, skipped or failed with its reason, never lost."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
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


def run_batch(items: Sequence[Item], work: Callable[[Item], dict[str, Any]], jobs: int = 1) -> Iterator[Outcome[Item]]:
    """Outcomes as they come. With jobs > 1, `work` and the items must be picklable.

    An expected error ends its item alone. A worker that dies (killed, out of memory) takes its items with it: each is
    tried once more, on its own, and marked failed if that kills the worker again.
    """
    if jobs <= 1:
        for item in items:
            yield attempt(item, work)
        return
    yield from _in_processes(items, work, jobs)


def attempt(item: Item, work: Callable[[Item], dict[str, Any]]) -> Outcome[Item]:
    """The outcome of one item; an expected error ends it."""
    try:
        return Outcome(item, work(item), None)
    except BenchlabError as error:
        return Outcome(item, None, error)


def _pool(jobs: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn"))


def _in_processes(items: Sequence[Item], work: Callable[[Item], dict[str, Any]], jobs: int) -> Iterator[Outcome[Item]]:
    lost: list[Item] = []
    pool = _pool(jobs)
    try:
        waiting: dict[Future[Outcome[Item]], Item] = {pool.submit(attempt, item, work): item for item in items}
        while waiting:
            done, _ = wait(waiting, return_when=FIRST_COMPLETED)
            for future in done:
                item = waiting.pop(future)
                try:
                    yield future.result()
                except BrokenProcessPool:
                    lost.append(item)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
    for item in lost:
        with _pool(1) as single:
            try:
                yield single.submit(attempt, item, work).result()
            except BrokenProcessPool:
                yield Outcome(item, None, BatchError("its worker process died twice", hint="is there enough memory?"))
