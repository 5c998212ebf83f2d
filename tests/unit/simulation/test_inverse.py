"""Inverse design on functions whose inverse is known."""

import math

import numpy as np
import pytest

from benchlab.errors import UsageError
from benchlab.simulation.inverse import (
    balanced,
    best_rows,
    brackets,
    central_slope,
    nodes_between,
    solve_bracket,
    spline_peak,
    whole_window_widths,
)


def hill(x):
    """Largest, 100, at 8; asymmetric, as the angle over slw."""
    return 100 * (x / 8) * np.exp(1 - x / 8)


NODES = nodes_between(1.0, 30.0, 8)


def test_both_roots_of_a_hill_are_found_in_few_evaluations():
    found = brackets(NODES, hill(NODES), 60.0)
    assert len(found) == 2
    for bracket in found:
        seen = []

        def counted(x, seen=seen):
            seen.append(x)
            return float(hill(x))

        root = solve_bracket(counted, bracket, 60.0, tolerance=1e-4)
        assert hill(root) == pytest.approx(60.0, abs=1e-2)
        assert bracket.low < root < bracket.high and len(seen) <= 8


def test_a_target_between_the_nodes_and_the_peak_is_seen_by_the_spline_peak():
    x = np.array([1.0, 5.0, 11.0, 18.0, 30.0])
    y = hill(x)
    target = 0.5 * (y.max() + 100)
    assert not brackets(x, y, target)
    peak = spline_peak(x, y)
    assert peak == pytest.approx(8, abs=1.5)
    x, y = np.insert(x, 2, peak), np.insert(y, 2, hill(peak))
    assert len(brackets(x, y, target)) == 2


def test_no_peak_where_the_end_is_highest_and_none_from_three_points():
    assert spline_peak(np.arange(5.0), np.arange(5.0) ** 2) is None
    assert spline_peak(np.arange(3.0), np.array([0.0, 1.0, 0.0])) is None


def test_roots_on_nodes_are_found_once_and_gaps_are_not_bridged():
    assert len(brackets(np.arange(4.0), np.array([0.0, 1.0, 2.0, 3.0]), 2.0)) == 1
    assert len(brackets(np.arange(4.0), np.array([0.0, 1.0, 2.0, 3.0]), 3.0)) == 1
    assert len(brackets(np.arange(4.0), np.array([0.0, 1.0, 2.0, 3.0]), 0.0)) == 1
    assert not brackets(np.arange(4.0), np.array([0.0, np.nan, 2.0, 3.0]), 1.0)
    assert not brackets(np.arange(4.0), np.array([0.0, 1.0, 2.0, 3.0]), 9.0)


@pytest.mark.parametrize("target", [0.0, 3.0])
def test_a_root_on_a_node_is_solved(target):
    (bracket,) = brackets(np.arange(4.0), np.arange(4.0), target)
    assert solve_bracket(lambda x: x, bracket, target, 1e-6) == pytest.approx(target, abs=1e-5)


def test_a_hole_in_the_function_is_an_error():
    (bracket,) = brackets(np.array([0.0, 4.0]), np.array([0.0, 4.0]), 2.5)
    with pytest.raises(UsageError, match="no value at"):
        solve_bracket(lambda x: math.nan, bracket, 2.5, 1e-3)


def test_slope_is_exact_for_a_parabola():
    assert central_slope(lambda x: 3 * x**2 + x, 2.0, 0.25) == pytest.approx(13)


def test_balanced_weighs_columns_alike_and_missing_values_count_as_worst():
    costs = np.array([[0.0, 1e6, 1.0], [0.2, 2e5, 1.0], [1.0, 0.0, np.nan]])
    assert balanced(costs) == 1
    assert best_rows(costs, ("a", "b", "c")) == {"balanced": 1, "a": 0, "b": 2, "c": 0}
    assert best_rows(np.array([[np.nan]]), ("a",)) == {"balanced": 0}


def test_whole_windows_fill_the_length():
    for width in whole_window_widths(1.0, 15.0, 180.0, 2.0, 11):
        count = 178 / (width + 2)
        assert 0 <= count - math.floor(count + 1e-9) < 0.2 and 1 <= width <= 15
    assert len(whole_window_widths(1.0, 15.0, 180.0, 2.0, 11)) == 11
    assert whole_window_widths(3.0, 3.05, 180.0, 2.0, 11) == ()
