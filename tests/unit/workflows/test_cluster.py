"""A batch on a real scheduler with workers in processes of their own, on loopback."""

import functools
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError
from benchlab.io.layup_file import read_layup
from benchlab.simulation.actuator_response import Fixture
from benchlab.workflows.batch import run_batch
from benchlab.workflows.cluster import run_anywhere, run_on_cluster
from benchlab.workflows.simulated import Conditions, simulate_design

DESIGNS = [ShellDesign(slw, 3) for slw in (4, 6, 8, 10, 12, 14)]


def start(module: str, folder: Path, *arguments: str) -> subprocess.Popen:
    command = [sys.executable, "-m", f"distributed.cli.{module}", *arguments]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    return subprocess.Popen(command, cwd=folder, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}, **quiet)


@pytest.fixture
def scheduler(tmp_path):
    """Address of a scheduler without workers."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    process = start("dask_scheduler", tmp_path, "--host", "127.0.0.1", "--port", str(port), "--no-dashboard")
    yield f"tcp://127.0.0.1:{port}"
    process.kill()
    process.wait()


@pytest.fixture
def workers(scheduler, tmp_path):
    """Two workers of it, one thread each; killed ones stay dead."""
    options = (scheduler, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--death-timeout", "30")
    processes = [start("dask_worker", tmp_path, *options, "--name", name) for name in ("one", "two")]
    yield processes
    for process in processes:
        process.kill()
        process.wait()


def test_a_killed_worker_changes_neither_the_number_of_results_nor_the_numbers(scheduler, workers):
    from distributed import Client

    conditions = Conditions(read_layup("trial"), (0.1, 0.2), Fixture(), blocked=False)
    work = functools.partial(simulate_design, conditions=conditions)
    found, killed = {}, None
    with Client(scheduler, timeout=15, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=30)
        processes = client.run(os.getpid)
        for outcome in run_on_cluster(DESIGNS, work, scheduler):
            assert outcome.error is None
            found[outcome.item] = outcome.result
            if killed is None:
                at_work = client.processing()
                killed = processes[max(at_work, key=lambda address: len(at_work[address]))]
                assert any(at_work.values()) and killed in [worker.pid for worker in workers]
                os.kill(killed, signal.SIGKILL)
    (dead,) = [worker for worker in workers if worker.pid == killed]
    assert dead.wait(5) == -signal.SIGKILL
    assert set(found) == set(DESIGNS)
    for outcome in run_batch(DESIGNS, work):
        for name, values in outcome.result["columns"].items():
            np.testing.assert_array_equal(found[outcome.item]["columns"][name], values)


def unknown_there(item):
    return {}


def test_a_cluster_that_does_not_know_the_work_is_told_to_be_made_alike(scheduler, workers):
    with pytest.raises(UsageError, match=r"cannot import what it needs"):
        list(run_on_cluster([1], unknown_there, scheduler))


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense://x", "127.0.0.1:99999"])
def test_an_address_where_nobody_answers_is_said_in_time(address):
    started = time.monotonic()
    with pytest.raises(UsageError, match=r"no scheduler answers at .* within 1 s"):
        list(run_on_cluster(DESIGNS, str, address, timeout_s=1))
    assert time.monotonic() - started < 10


def test_a_scheduler_without_workers_is_said_in_time(scheduler):
    started = time.monotonic()
    with pytest.raises(UsageError, match="has no worker after 3 s"):
        list(run_on_cluster(DESIGNS, str, scheduler, timeout_s=3))
    assert time.monotonic() - started < 20


def test_without_the_package_the_remedy_is_said(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(UsageError) as said:
        list(run_anywhere(DESIGNS, str, scheduler="tcp://127.0.0.1:8786"))
    assert "pip install 'benchlab[cluster]'" in str(said.value)
