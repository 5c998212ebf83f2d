"""Values of samples: centred exactly, whatever they are written as; what is no number is refused."""

from decimal import Decimal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchlab.errors import InputError
from benchlab.stats.groups import groups_of
from benchlab.stats.measurements import measurements_of
from benchlab.stats.names import lookalikes


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.integers(-999_999, 999_999), min_size=2, max_size=12),
    st.integers(-(10**60), 10**60),
    st.integers(0, 40),
)
def test_differences_are_exact_whatever_is_added(values: list[int], offset: int, decimals: int) -> None:
    """The correctly rounded difference from the origin, for offsets that no float holds."""
    written = [f"{offset * 10**6 + value}e-{decimals}" for value in values]
    found = measurements_of(["a"] * len(values), written)
    exact = [float((value - middle) * Decimal(10) ** -decimals) for middle in values for value in values]
    rows = [exact[i : i + len(values)] for i in range(0, len(exact), len(values))]
    assert found.deviations.tolist() in rows


def test_a_sample_with_several_rows_counts_once() -> None:
    found = measurements_of(list("aaab"), [1, 3, 5, 9], ["s1", "s1", "s2", "s1"])
    assert found.nested and {k: list(v) for k, v in found.cycles().items()} == {"a": ["s1", "s2"], "b": ["s1"]}
    a, b = groups_of(found)
    assert (a.n, a.mean, b.n, b.mean) == (2, 3.5, 1, 9.0)
    assert not measurements_of(list("aab"), [1, 3, 9]).nested


@pytest.mark.parametrize("value", ["abc", "", "nan", "inf", "1e999", "-1e400", float("nan"), float("inf"), None])
def test_what_is_no_finite_number_is_refused_with_its_place(value) -> None:
    with pytest.raises(InputError, match="not a finite number") as refused:
        measurements_of(list("aab"), ["1", "2", value])
    assert refused.value.where == "value 3"


def test_lists_unlike_in_length_and_empty_ones() -> None:
    with pytest.raises(InputError, match="1 groups, 2 values and 1 samples"):
        measurements_of(["a"], [1, 2])
    with pytest.raises(InputError, match="no values"):
        measurements_of([], [])


@pytest.mark.parametrize("offset", ["1e15", "-4e300", "0.0000001"])
def test_scatter_of_a_constant_is_none(offset: str) -> None:
    found = groups_of(measurements_of(list("aaa"), [offset] * 3))[0]
    assert found.ss == 0.0 and found.mean == float(offset)


def test_rounding_is_not_taken_for_scatter() -> None:
    """Samples whose cycles have one mean, 0.2, in ways that float64 rounds unlike each other."""
    values, samples = ["0.1", "0.3", "0.2", "0.7", "-0.3", "0.2"], ["1", "1", "2", "3", "3", "3"]
    others = ["1.07"] * 9, [str(i) for i in range(9)]  # of another group, so that the middle value is theirs
    found = groups_of(measurements_of(["a"] * 6 + ["b"] * 9, values + others[0], samples + others[1]))[0]
    assert found.n == 3 and found.ss == 0.0 and np.ptp(found.deviations) > 0
    found = groups_of(measurements_of(["a"] * 3, ["1.0000000001", "1", "1"]))[0]
    assert found.ss == pytest.approx(2 / 3 * 1e-20, rel=1e-12)


def test_names_that_may_be_meant_as_one() -> None:
    assert lookalikes(["1", "1.0", "slw5", "SLW 5", "1,0", "a"]) == [("1", "1.0"), ("1.0", "1,0"), ("slw5", "SLW 5")]
    assert lookalikes(["nan", "inf", "$x_{$", "5", "50"]) == []
    assert np.size(lookalikes([])) == 0
