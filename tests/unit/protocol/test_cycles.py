"""Cycles of a run, from the counts of its steps."""

import pytest

from benchlab.protocol.cycles import number_cycles


@pytest.mark.parametrize(
    ("counts", "numbers"),
    [
        ([(), ()], [1, 1]),
        ([(1,), (2,), (3,)], [1, 2, 3]),
        ([(1, 1), (1, 1), (1, 2), (2, 1), (2, 2)], [1, 1, 2, 3, 4]),  # nested: each has its own
        ([(), (1,), (), (1,)], [0, 1, 0, 2]),  # two repeats, apart
        ([(1,), (1,), ()], [1, 1, 0]),
    ],
)
def test_each_new_count_is_a_cycle(counts, numbers):
    assert number_cycles(counts, range(len(counts))).tolist() == numbers


def test_a_step_that_the_plan_does_not_have_is_in_no_cycle():
    assert number_cycles([(1,)], [0, 7]).tolist() == [1, 0]
    assert number_cycles([], []).tolist() == []
