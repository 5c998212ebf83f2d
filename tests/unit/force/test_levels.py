"""Pressures of cycles and the steps that they are of."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.force.levels import cluster, level_of, nearest_steps, stated_steps
from benchlab.force.loading import find_loadings
from benchlab.force.synthetic import CycleShape, draw_trace

STEPS = np.round(0.035 * np.arange(1, 11), 3)


@pytest.mark.parametrize("seed", range(5))
def test_levels_of_holds_with_overshoot_and_noise(seed: int) -> None:
    rng = np.random.default_rng(seed)
    levels = np.repeat(STEPS, 3)
    trace = draw_trace((100 * levels).tolist(), levels.tolist(), rng)
    since = trace.time_s[:, None] - trace.peak_times_s
    overshoot = (np.where((since > 0) & (since < 0.2), 0.12, 0) * levels).sum(axis=1)
    pressure = trace.pressure_MPa + overshoot + rng.normal(0, 0.0004, len(trace.time_s))
    found = [level_of(pressure, cycle) for cycle in find_loadings(pressure)]
    assert all(level.held for level in found)
    assert [level.pressure_MPa for level in found] == pytest.approx(levels, abs=0.0006)


def test_a_pressure_that_is_not_held_counts_with_its_largest() -> None:
    trace = draw_trace([5.0], [0.2], np.random.default_rng(0), shape=CycleShape(rise_s=1.5, hold_s=0.02, fall_s=1.5))
    (cycle,) = find_loadings(trace.pressure_MPa)
    level = level_of(trace.pressure_MPa, cycle)
    assert (level.held, level.pressure_MPa) == (False, pytest.approx(0.2, abs=1e-3))


def test_missing_pressures_in_a_hold_are_passed_over() -> None:
    trace = draw_trace([5.0], [0.2], np.random.default_rng(0))
    (cycle,) = find_loadings(trace.pressure_MPa)
    pressure = trace.pressure_MPa.copy()
    pressure[200:250] = np.nan
    assert level_of(pressure, cycle).pressure_MPa == pytest.approx(0.2, abs=1e-3)


def test_levels_cluster_to_steps_in_any_order() -> None:
    rng = np.random.default_rng(1)
    truth = rng.permutation(np.repeat(np.arange(10), 15))
    assert cluster(STEPS[truth] + rng.uniform(-0.003, 0.003, 150), 0.007).tolist() == truth.tolist()


def test_levels_without_gaps_are_refused_with_their_range() -> None:
    with pytest.raises(
        InputError, match=r"50 cycles have pressures from 0\.1 to 0\.2 MPa without a gap of 0\.005 MPa.*--steps-MPa"
    ):
        cluster(np.linspace(0.1, 0.2, 50), 0.005)


def test_a_level_far_from_every_step_is_refused_by_number() -> None:
    assert nearest_steps(np.array([0.071, 0.034]), STEPS.tolist(), 0.005).tolist() == [1, 0]
    with pytest.raises(InputError, match=r"cycle 2 is at 0\.052 MPa, 0\.017 MPa from the nearest step of 0\.035 MPa"):
        nearest_steps(np.array([0.07, 0.052]), STEPS.tolist(), 0.005)


def test_stated_steps_need_the_right_count() -> None:
    assert stated_steps(6, 3, 2, "").tolist() == [0, 0, 1, 1, 2, 2]
    with pytest.raises(InputError, match=r"49 whole cycles found, and 10 steps of 5 cycles are 50: peaks at 3 s"):
        stated_steps(49, 10, 5, "peaks at 3 s")
    with pytest.raises(InputError, match=r"49 whole cycles found, and 10 steps do not divide them"):
        stated_steps(49, 10, None, "")
    with pytest.raises(InputError, match="0 whole cycles"):
        stated_steps(0, 10, None, "")
