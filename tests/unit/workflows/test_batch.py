"""Batches: expected errors end one item, dead workers are tried once more, nothing is lost."""

import functools
import os
import signal
from pathlib import Path
from typing import Any

from benchlab.errors import InputError
from benchlab.workflows.batch import run_batch


def work(item: int, folder: Path, deaths: int = 0) -> dict[str, Any]:
    """Fails for 3; for 5, kills its own process as often as `deaths` says."""
    if item == 3:
        raise InputError("three is refused", file="3.mp4", hint="take four")
    mark = folder / "deaths"
    if item == 5 and (mark.stat().st_size if mark.exists() else 0) < deaths:
        with mark.open("a") as file:
            file.write("x")
        os.kill(os.getpid(), signal.SIGKILL)
    return {"item": item}


def outcomes(tmp_path: Path, jobs: int, deaths: int = 0) -> dict[int, Any]:
    found = list(run_batch(range(6), functools.partial(work, folder=tmp_path, deaths=deaths), jobs))
    assert sorted(o.item for o in found) == list(range(6))
    return {o.item: o for o in found}


def test_one_after_another(tmp_path: Path) -> None:
    found = outcomes(tmp_path, 1)
    assert [found[i].result for i in (0, 1, 2, 4, 5)] == [{"item": i} for i in (0, 1, 2, 4, 5)]
    assert str(found[3].error) == "3.mp4: three is refused; take four"


def test_errors_come_back_whole_from_workers(tmp_path: Path) -> None:
    error = outcomes(tmp_path, 2)[3].error
    assert isinstance(error, InputError) and error.exit_code == 3
    assert str(error) == "3.mp4: three is refused; take four"


def test_a_worker_that_dies_once_is_tried_again(tmp_path: Path) -> None:
    found = outcomes(tmp_path, 2, deaths=1)
    assert all(found[i].result == {"item": i} for i in (0, 1, 2, 4, 5))


def test_a_worker_that_dies_twice_fails_alone(tmp_path: Path) -> None:
    found = outcomes(tmp_path, 2, deaths=2)
    assert all(found[i].result == {"item": i} for i in (0, 1, 2, 4))
    assert "died twice" in str(found[5].error)
