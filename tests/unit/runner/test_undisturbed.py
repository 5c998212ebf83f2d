"""What keeps Python itself from coming late is there in the block, and gone after it."""

import gc
import sys

import pytest

from benchlab.runner.undisturbed import SWITCH_S, undisturbed


def test_it_is_undone_after_a_block_that_raises_too() -> None:
    before, frozen = sys.getswitchinterval(), gc.get_freeze_count()
    with pytest.raises(ValueError, match="x"), undisturbed():
        assert sys.getswitchinterval() == pytest.approx(SWITCH_S)
        assert gc.get_freeze_count() > 1000 and gc.isenabled()
        raise ValueError("x")
    assert (sys.getswitchinterval(), gc.get_freeze_count()) == (before, frozen)
