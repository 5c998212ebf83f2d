from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from benchlab.discrepancy.locate import SIGNIFICANT, gap_p, gaps, regions
from tests.unit.discrepancy.drawn import TRUE, problem, studies


def test_where_the_model_is_true_some_gap_is_significant_in_one_of_twenty_studies() -> None:
    smallest = [gap_p(made, made.cells([TRUE]), np.random.default_rng(i)).min() for i, made in enumerate(studies())]
    low, high = stats.binom(len(smallest), [0.05, 0.5]).interval(0.998)
    found = np.sum(np.array(smallest)[:, None] < [SIGNIFICANT, 0.5], axis=0)
    assert found[0] <= high[0] and low[1] <= found[1] <= high[1]


@pytest.mark.parametrize("step_deg", [8.0, -8.0])
def test_a_step_is_found_in_its_design_direction_and_pressures(step_deg: float) -> None:
    made = problem(4, designs=2, samples=5, protocol=("slow",))
    features = made.features.features
    there = [f.design == 1 and f.direction == "unloading" and 2 <= f.bin <= 5 for f in features]
    value = made.cells(()) + 0.2 * np.random.default_rng(1).standard_normal(len(made.features.value))
    moved = replace(
        made, features=replace(made.features, value=value + step_deg * np.array(there)[made.features.feature])
    )
    gap = gaps(moved, moved.cells(()))
    p = gap_p(moved, moved.cells(()), np.random.default_rng(1))
    (one,) = regions(moved, gap, p)
    assert (one.design, one.direction, one.quantity, one.cycle) == (made.scene.names[1], "unloading", "angle_deg", 1)
    inside = [f.pressure_MPa for f, t in zip(features, there) if t]
    assert one.pressure_MPa == (min(inside), max(inside))
    assert one.gap == pytest.approx(step_deg, abs=0.3) and one.p < SIGNIFICANT
    assert one.rate_MPa_s == pytest.approx(0.35 / 30, rel=0.05)
    assert gap[~np.array(there)] == pytest.approx(0, abs=0.5)
