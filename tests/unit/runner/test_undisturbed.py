"""What keeps a run from coming late is there in the block, and gone after it."""

import gc
import os

import pytest

from benchlab.runner.undisturbed import PRIORITY, undisturbed


def test_it_is_undone_after_a_block_that_raises_too() -> None:
    frozen = gc.get_freeze_count()
    with pytest.raises(ValueError, match="x"), undisturbed(real_time=False) as first:
        assert not first and gc.get_freeze_count() > 1000 and gc.isenabled()
        raise ValueError("x")
    assert gc.get_freeze_count() == frozen


@pytest.mark.skipif(not hasattr(os, "sched_setscheduler"), reason="the system knows no SCHED_FIFO")
def test_where_the_system_lets_it_the_thread_goes_first_and_what_it_starts_does_not() -> None:
    assert os.sched_getscheduler(0) == os.SCHED_OTHER
    with undisturbed(real_time=True) as first:
        policy = os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK
        assert policy == (os.SCHED_FIFO if first else os.SCHED_OTHER)
        if first:
            assert os.sched_getparam(0).sched_priority == PRIORITY
            assert os.sched_getscheduler(0) & os.SCHED_RESET_ON_FORK
    assert os.sched_getscheduler(0) == os.SCHED_OTHER


def test_where_the_system_refuses_it_goes_on_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    with undisturbed(real_time=True) as first:
        assert not first
