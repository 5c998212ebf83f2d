"""A batch on many computers: dask.distributed, with the outcomes of `run_batch`."""

from __future__ import annotations

import logging
import queue
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import benchlab
from benchlab.errors import BatchError, UsageError
from benchlab.workflows.batch import Item, Outcome, attempt, run_batch

TIMEOUT_S = 15.0
"""How long a scheduler may take to answer, and how long it may be without a worker."""


def run_anywhere(
    items: Sequence[Item], work: Callable[[Item], dict[str, Any]], jobs: int = 1, scheduler: str | None = None
) -> Iterator[Outcome[Item]]:
    """Outcomes as they come: in this process, in `jobs` of this computer, or by the workers of a scheduler."""
    if scheduler is None:
        return run_batch(items, work, min(jobs, max(len(items), 1)))
    return run_on_cluster(items, work, scheduler)


def run_on_cluster(
    items: Sequence[Item], work: Callable[[Item], dict[str, Any]], scheduler: str, timeout_s: float = TIMEOUT_S
) -> Iterator[Outcome[Item]]:
    """Outcomes as they come from the workers of `scheduler` (tcp://host:port), each with the same benchlab installed.

    Items of a worker that dies go to another; one that kills three workers is marked failed. Raises UsageError where
    dask.distributed is not installed, nothing answers within `timeout_s`, there is no worker, or the workers' benchlab is
    another; BatchError where the scheduler, or the last worker for `timeout_s`, is lost under way.
    """
    with _quiet(), _client(scheduler, timeout_s) as client:
        waiting = [client.submit(_attempt_there, item, work, benchlab.__version__, pure=False) for item in items]
        places = {future.key: item for future, item in zip(waiting, items)}
        arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
        for future in waiting:
            future.add_done_callback(arrived.put)
        for _ in items:
            future = _next(arrived, client, scheduler, timeout_s)
            yield _outcome(future, places[future.key], scheduler)


def _attempt_there(item: Item, work: Callable[[Item], dict[str, Any]], version: str) -> Outcome[Item]:
    """In a worker: the item, or the error that this worker would not compute the same."""
    if benchlab.__version__ != version:
        what = f"a worker has benchlab {benchlab.__version__}, this computer {version}"
        return Outcome(item, None, UsageError(what, hint="install the same version on all"))
    return attempt(item, work)


def _client(scheduler: str, timeout_s: float) -> Any:
    try:
        from distributed import Client
    except ImportError:
        hint = "install it with: pip install 'benchlab[cluster]', or use --jobs"
        raise UsageError("--scheduler needs the package dask.distributed, which is not installed", hint=hint) from None
    try:
        client = Client(scheduler, timeout=timeout_s, set_as_default=False)
    except (OSError, TimeoutError, ValueError, TypeError) as error:
        hint = "start one with `dask scheduler`, and give the address that it prints, as tcp://host:8786"
        what = f"no scheduler answers at {scheduler!r} within {timeout_s:g} s"
        raise UsageError(what, hint=hint) from error
    try:
        client.wait_for_workers(1, timeout=timeout_s)
    except (OSError, TimeoutError) as error:
        client.close()
        what = f"the scheduler at {scheduler} has no worker after {timeout_s:g} s"
        raise UsageError(what, hint=f"start some with `dask worker {scheduler} --nthreads 1`") from error
    return client


def _next(arrived: queue.SimpleQueue[Any], client: Any, scheduler: str, timeout_s: float) -> Any:
    """The next future that is done. Looks after scheduler and workers while it waits."""
    alone_since: float | None = None
    while True:
        try:
            return arrived.get(timeout=1.0)
        except queue.Empty:
            pass
        if _has_workers(client):
            alone_since = None
            continue
        alone_since = time.monotonic() if alone_since is None else alone_since
        if time.monotonic() - alone_since > timeout_s:
            what = f"the scheduler at {scheduler} is gone, or has had no worker for {timeout_s:g} s"
            raise BatchError(what, hint="start it again and repeat the command; a sweep goes on from what is done")


def _has_workers(client: Any) -> bool:
    try:
        return client.status == "running" and bool(client.scheduler_info().get("workers"))
    except (OSError, TimeoutError, RuntimeError, ValueError):
        return False


def _outcome(future: Any, item: Item, scheduler: str) -> Outcome[Item]:
    from distributed.scheduler import KilledWorker

    if future.status in ("cancelled", "lost"):
        hint = "start it again and repeat the command; a sweep goes on from what is done"
        raise BatchError(f"the scheduler at {scheduler} was lost", hint=hint)
    try:
        found: Outcome[Item] = future.result()
    except KilledWorker:
        return Outcome(item, None, BatchError("its workers died, one after another", hint="have they enough memory?"))
    except (ImportError, RuntimeError) as error:
        if isinstance(error, RuntimeError) and "deserialization" not in str(error):
            raise
        what = f"the scheduler at {scheduler} or a worker of it cannot import what it needs"
        raise UsageError(what, hint="install the same benchlab on all these computers") from error
    if isinstance(found.error, UsageError) and found.error.what.startswith("a worker has benchlab"):
        raise found.error
    return found


@contextmanager
def _quiet() -> Iterator[None]:
    """distributed's own words are not shown: what matters is said by an outcome or an error."""
    logger = logging.getLogger("distributed")
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(level)
