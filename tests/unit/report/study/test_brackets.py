"""Significance brackets: over what they span, and never on each other."""

from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from benchlab.report.study.brackets import stack_brackets

TOPS = st.lists(st.floats(0, 200), min_size=2, max_size=7)


@given(TOPS, st.data())
def test_a_bracket_clears_the_bars_it_spans_and_the_brackets_it_meets(tops: list[float], data: st.DataObject) -> None:
    every = list(combinations(range(len(tops)), 2))
    chosen = data.draw(st.lists(st.sampled_from(every), unique=True, max_size=len(every)))
    placed = stack_brackets([(b, a, "*") if a % 2 else (a, b, "*") for a, b in chosen], tops, 5.0)
    assert sorted((one.left, one.right) for one in placed) == sorted(chosen)
    for one in placed:
        assert one.height >= max(tops[one.left : one.right + 1]) + 5.0
    for one, other in combinations(placed, 2):
        if one.left < other.right and other.left < one.right:
            assert abs(one.height - other.height) >= 5.0 - 1e-9


def test_side_by_side_they_share_a_height() -> None:
    placed = stack_brackets([(0, 1, "a"), (1, 2, "b")], [1.0, 1.0, 1.0], 1.0)
    assert [one.height for one in placed] == [2.0, 2.0]
