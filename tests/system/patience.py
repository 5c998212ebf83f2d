"""benchlab on a computer that is busy elsewhere: it waits longer for the answers of a Nano, and for its own ticks, than in a lab.

For tests of what else happens on a line in real time. How long benchlab waits by itself is tested in virtual time, by tests/unit.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import pytest

LONG_S = 120.0
"""Until something that does not come is given up: a test that passes never waits so long."""

LATE = ("--guard", "late_s=10")
"""A run whose ticks may come late."""

PATIENCE: dict[str, dict[str, float]] = {
    "benchlab.devices.serial_bench": {"PATIENCE": 200.0, "LOST_S": 20.0},
    "benchlab.devices.conversation": {"TRY_S": 5.0, "HELLO_S": 5.0, "BOOT_S": 60.0},
    "benchlab.devices.transport": {"WRITE_S": 20.0},
}

SCRIPT = f"""
import importlib
for module, constants in {PATIENCE!r}.items():
    for name, value in constants.items():
        setattr(importlib.import_module(module), name, value)
from benchlab.__main__ import main
main()
"""

PATIENT = (sys.executable, "-c", SCRIPT)
"""Words before those of a command line: benchlab in a process of its own, patient."""

INTERRUPTED = """
import contextlib, os, signal, sys
from benchlab.cli import progress

at = int(sys.argv.pop(1))

@contextlib.contextmanager
def interrupting(label, quiet=False):
    def report(done, total):
        if done == at:
            os.kill(os.getpid(), signal.SIGINT)
    yield report

progress.progress = interrupting
from benchlab.__main__ import main
main()
"""


def interrupted_at(done: int) -> tuple[str, ...]:
    """The same, which sends itself a Ctrl-C once its progress has come so far."""
    return (sys.executable, "-c", INTERRUPTED, str(done))


def be_patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same in this process."""
    for module, constants in PATIENCE.items():
        for name, value in constants.items():
            monkeypatch.setattr(f"{module}.{name}", value)


def wait_until(so: Callable[[], Any], meanwhile: Callable[[], bool] = lambda: True) -> None:
    """Until it is so; `meanwhile` must hold all the while."""
    end = time.monotonic() + LONG_S
    while not so():
        assert time.monotonic() < end and meanwhile()
        time.sleep(0.01)
