"""A batch on a real scheduler with workers in processes of their own, on loopback."""

import contextlib
import functools
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError
from benchlab.io.layup_file import read_layup
from benchlab.simulation.actuator_response import Fixture
from benchlab.workflows.batch import run_batch
from benchlab.workflows.cluster import run_anywhere, run_on_cluster
from benchlab.workflows.simulated import Conditions, simulate_design

DESIGNS = [ShellDesign(slw, 3) for slw in (4, 8, 10, 14)]


LONG_S = 120
"""Until a process that does not do what it should is given up: it may be slow, and a test that passes does not wait for it."""


def start(module: str, folder: Path, *arguments: str) -> subprocess.Popen:
    command = [sys.executable, "-m", f"distributed.cli.{module}", *arguments]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    return subprocess.Popen(command, cwd=folder, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}, **quiet)


def wait_until(found: Callable[[], Any], process: subprocess.Popen | None = None) -> Any:
    """What is found, once it is something; the process is to live meanwhile."""
    end = time.monotonic() + LONG_S
    while not (what := found()):
        assert time.monotonic() < end and (process is None or process.poll() is None)
        time.sleep(0.02)
    return what


@pytest.fixture
def scheduler(tmp_path):
    """Address of a scheduler without workers, which listens."""
    told = tmp_path / "scheduler.json"
    where = ("--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(told))
    process = start("dask_scheduler", tmp_path, *where, "--no-dashboard")

    def address() -> str | None:
        with contextlib.suppress(OSError, ValueError):  # not there yet, or half written
            return json.loads(told.read_text())["address"]

    yield wait_until(address, process)
    process.kill()
    process.wait()


@pytest.fixture
def workers(scheduler, tmp_path):
    """Two workers of it, one thread each; killed ones stay dead."""
    options = (scheduler, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--death-timeout", str(LONG_S))
    processes = [start("dask_worker", tmp_path, *options, "--name", name) for name in ("one", "two")]
    yield processes
    for process in processes:
        process.kill()
        process.wait()


def test_a_killed_worker_changes_neither_the_number_of_results_nor_the_numbers(scheduler, workers, tmp_path):
    """All but the first item wait in their worker, until one that waits has been killed."""
    from distributed import Client

    conditions = Conditions(read_layup("trial"), (0.1, 0.2), Fixture(), blocked=False)
    gate, first = tmp_path / "gate", DESIGNS[0]
    long_s = LONG_S  # the function goes to the workers as it is: they cannot import this file

    def gated(design: ShellDesign) -> dict[str, Any]:
        (tmp_path / f"{os.getpid()}.at_work").touch()
        end = time.monotonic() + long_s
        while design != first and not gate.exists() and time.monotonic() < end:
            time.sleep(0.01)
        (tmp_path / f"{os.getpid()}.at_work").unlink()
        return simulate_design(design, conditions=conditions)

    def waiting() -> int | None:
        return next((int(path.stem) for path in tmp_path.glob("*.at_work")), None)

    found = {}
    with Client(scheduler, timeout=LONG_S, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=LONG_S)
    outcomes = run_on_cluster(DESIGNS, gated, scheduler, timeout_s=LONG_S)
    for outcome in outcomes:
        assert outcome.error is None
        if not found:
            assert outcome.item == first
            killed = wait_until(waiting)
            os.kill(killed, signal.SIGKILL)
            (dead,) = [worker for worker in workers if worker.pid == killed]
            assert dead.wait(LONG_S) == -signal.SIGKILL
            assert (tmp_path / f"{killed}.at_work").exists()  # it was in the midst of one
            gate.touch()
        found[outcome.item] = outcome.result
    assert set(found) == set(DESIGNS)
    work = functools.partial(simulate_design, conditions=conditions)
    for outcome in run_batch(DESIGNS, work):
        for name, values in outcome.result["columns"].items():
            np.testing.assert_array_equal(found[outcome.item]["columns"][name], values)


def unknown_there(item):
    return {}


def test_a_cluster_that_does_not_know_the_work_is_told_to_be_made_alike(scheduler, workers):
    with pytest.raises(UsageError, match=r"cannot import what it needs"):
        list(run_on_cluster([1], unknown_there, scheduler, timeout_s=LONG_S))


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense://x", "127.0.0.1:99999"])
def test_an_address_where_nobody_answers_is_said_in_time(address):
    import distributed  # noqa: F401  # its seconds are not those of the waiting

    started = time.monotonic()
    with pytest.raises(UsageError, match=r"no scheduler answers at .* within 1 s"):
        list(run_on_cluster(DESIGNS, str, address, timeout_s=1))
    assert time.monotonic() - started < 20  # distributed's own patience is 30 s


def test_a_scheduler_without_workers_is_said_in_time(scheduler):
    started = time.monotonic()
    with pytest.raises(UsageError, match="has no worker after 3 s"):
        list(run_on_cluster(DESIGNS, str, scheduler, timeout_s=3))
    assert time.monotonic() - started < 60


def test_without_the_package_the_remedy_is_said(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(UsageError) as said:
        list(run_anywhere(DESIGNS, str, scheduler="tcp://127.0.0.1:8786"))
    assert "pip install 'benchlab[cluster]'" in str(said.value)
