"""How fast this computer is just now: bars of speed are set on one machine, and hold on a slower or a busy one."""

from __future__ import annotations

import time
from collections.abc import Callable

SECONDS = 0.0048
"""What `_work` takes of one core of the machine on which the bars were set."""


def slowness() -> float:
    """How many times longer the same Python takes here and now than where the bars were set, at least 1. Best of seven."""
    return max(1.0, best_cpu_s(_work, 7) / SECONDS)


def best_cpu_s(call: Callable[[], object], times: int = 3) -> float:
    """Seconds of this process's CPU, which waiting for a core does not count in: the least of several calls."""
    return min(cpu_s(call) for _ in range(times))


def cpu_s(call: Callable[[], object]) -> float:
    """Seconds of this process's CPU that one call takes."""
    began = time.process_time()
    call()
    return time.process_time() - began


def _work() -> int:
    found: dict[int, str] = {}
    for index in range(20_000):
        found[index % 997] = f"{index:x}"
    return sum(len(word) for word in found.values())
