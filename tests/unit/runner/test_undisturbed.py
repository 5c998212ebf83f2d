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


needs_fifo = pytest.mark.skipif(not hasattr(os, "sched_setscheduler"), reason="the system knows no SCHED_FIFO")


@needs_fifo
def test_where_the_system_lets_it_the_thread_goes_first_and_what_it_starts_does_not() -> None:
    before = os.sched_getscheduler(0)  # of the tests themselves, which may have been started to go first
    with undisturbed(real_time=True) as first:
        policy = os.sched_getscheduler(0)
        assert policy == (os.SCHED_FIFO | os.SCHED_RESET_ON_FORK if first else before)
        assert not first or os.sched_getparam(0).sched_priority == PRIORITY
    assert os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK == before & ~os.SCHED_RESET_ON_FORK


@needs_fifo
def test_who_may_not_lay_down_the_flag_is_as_others_after_it_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """sched(7): once set, SCHED_RESET_ON_FORK is taken away by nobody without CAP_SYS_NICE."""
    now = [os.SCHED_OTHER]

    def of_a_user(_: int, policy: int, __: object) -> None:
        if now[0] & os.SCHED_RESET_ON_FORK and not policy & os.SCHED_RESET_ON_FORK:
            raise PermissionError(1, "Operation not permitted")
        now[0] = policy

    monkeypatch.setattr(os, "sched_setscheduler", of_a_user)
    monkeypatch.setattr(os, "sched_getscheduler", lambda _: now[0])
    for _ in range(2):  # the second time it begins with the flag
        with undisturbed(real_time=True) as first:
            assert first and now[0] == os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
        assert now[0] == os.SCHED_OTHER | os.SCHED_RESET_ON_FORK


def test_where_the_system_refuses_it_goes_on_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    with undisturbed(real_time=True) as first:
        assert not first
