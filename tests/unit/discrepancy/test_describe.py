"""Data without scatter are described: what was put into the gap is found in it, and nothing is named."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.explain import explain
from benchlab.discrepancy.explanation import Explanation
from benchlab.discrepancy.measured import Measured, Run
from benchlab.errors import InputError
from tests.unit.discrepancy import scenes

BASE = scenes.base(2, known=False)
NAMES = tuple(BASE.designs)


def run_of(
    design: str, time_s: np.ndarray, pressure_MPa: np.ndarray, gap_deg: np.ndarray | float, **more: object
) -> Run:
    """Measured is what is simulated, plus the gap."""
    table = BASE.designs[design]
    angle = np.interp(pressure_MPa, table.pressure_MPa, table.curves["angle_deg"]) + gap_deg
    return Run(design, "s1", "r1", time_s, pressure_MPa, {"angle_deg": angle}, **more)  # type: ignore[arg-type]


def loop(design: str, up_deg: float, down_deg: float) -> Run:
    """Loading, a hold, unloading, one gap in each."""
    time = np.linspace(0, 30, 601)
    gap = np.where(time <= 10, up_deg, np.where(time < 20, 0.0, down_deg))
    return run_of(design, time, np.interp(time, [0, 10, 20, 30], [0, 0.34, 0.34, 0]), gap)


def timeless(design: str, gap_deg: np.ndarray | float, **more: object) -> Run:
    return run_of(design, np.full(36, np.nan), BASE.designs[design].pressure_MPa, gap_deg, **more)


def described(*runs: Run) -> Explanation:
    return explain(Measured(runs, "a test"), BASE, built_in()).explanation


def test_a_loop_is_found_in_its_directions_and_nothing_is_named() -> None:
    found = described(*(loop(name, -1.0, 4.0) for name in NAMES))
    assert found.verdict == "unexplained" and found.only_described
    assert found.effects == () and found.rivals == () and found.tried == () and found.held_out == ()
    assert all(
        np.isnan([found.p_gap, found.false_naming, found.gap.noise_floor, found.gap.heldout_after, found.gap.ceiling])
    )
    assert set(found.judged_not) == set(built_in())
    for name in NAMES:
        (up,), (down,) = (
            [r for r in found.where if (r.design, r.direction) == (name, way)] for way in ("loading", "unloading")
        )
        assert up.gap == pytest.approx(-1, abs=0.1) and down.gap == pytest.approx(4, abs=0.1)
        assert np.isnan(up.p) and up.rate_MPa_s == pytest.approx(0.034, rel=0.02)
    assert any("with the direction" in line and "+4° for unloading" in line for line in found.remainder)
    assert any("Measure two samples of a design at least, or three runs" in line for line in found.warnings)


def test_a_region_in_a_hold_has_no_rate() -> None:
    regions = described(loop(NAMES[0], 2.0, 2.0)).where
    assert {r.direction: r.rate_MPa_s is None for r in regions} == {"loading": False, "unloading": False, "hold": True}


def test_without_a_time_all_pressures_count_and_stretches_have_one_sign() -> None:
    pressure = BASE.designs[NAMES[0]].pressure_MPa
    found = described(timeless(NAMES[0], np.where(pressure < 0.17, 3.0, -5.0)), timeless(NAMES[1], 1.0))
    ours = [(r.design, round(r.gap), r.direction, r.rate_MPa_s) for r in found.where]
    assert ours == [(NAMES[0], 3, "all", None), (NAMES[0], -5, "all", None), (NAMES[1], 1, "all", None)]
    whole = found.curves.pressure_MPa[found.curves.design == NAMES[1]]
    assert whole.min() == pytest.approx(0.02) and whole.max() > 0.325 and set(found.curves.direction) == {"all"}
    count = (found.curves.design == NAMES[1]).sum()
    assert count == 8 and np.all(found.curves.time_s == 0)
    assert found.judged_not["viscoelasticity"] == "there is no course in time"
    assert found.judged_not["friction"] == "there is no unloading"


def test_readings_at_the_ends_are_in_the_means() -> None:
    pressure = BASE.designs[NAMES[0]].pressure_MPa
    ends = np.where((pressure == 0) | (pressure == pressure[-1]), 10.0, 0.0)
    found = described(timeless(NAMES[0], ends))
    gap = found.curves.measured - found.curves.simulated
    assert gap[0] > 1.5 and gap[-1] > 1.5 and abs(gap[3]) < 0.1


def test_three_runs_of_one_sample_or_two_samples_are_tested() -> None:
    noise = np.random.default_rng(1)
    runs = [replace(timeless(NAMES[0], noise.normal(0, 0.5, 36)), run=f"r{i}") for i in range(3)]
    found = described(*runs)
    assert found.verdict == "agree" and not found.only_described and np.isfinite(found.p_gap)
    assert found.judged_not["viscoelasticity"] == "there is no course in time"
    two = [replace(timeless(NAMES[0], noise.normal(0, 0.5, 36)), sample=f"s{i}") for i in range(2)]
    assert not described(*two).only_described
    assert described(*runs[:2]).only_described


def test_too_little_is_refused() -> None:
    short = timeless(NAMES[0], 1.0)
    few = replace(short, time_s=short.time_s[:9], pressure_MPa=short.pressure_MPa[:9], values={"angle_deg": np.ones(9)})
    with pytest.raises(InputError, match="9 readings cannot carry a verdict"):
        described(few)


def test_what_is_left_depends_on_further_columns() -> None:
    humidity = np.linspace(20, 60, 36)
    runs = [
        timeless(NAMES[0], 0.3 * (humidity - 40), against={"humidity": humidity, "operator": "anna"}),
        timeless(NAMES[1], 6 + 0.3 * (humidity - 40), against={"humidity": humidity, "operator": "bert"}),
    ]
    lines = "\n".join(described(*runs).remainder)
    assert re.search(r"goes with the column operator: -0\.\d+° on average for anna, \+5\.9° for bert", lines)
    assert "the column humidity: " in lines and "for the lowest values" in lines and "for the highest values" in lines


def test_a_column_that_says_nothing_is_not_told() -> None:
    even = np.tile([1.0, 2.0], 18)
    runs = [timeless(name, gap, against={"even": even}) for name, gap in zip(NAMES, (-3.0, 3.0))]
    assert "column" not in "\n".join(described(*runs).remainder)


def test_an_even_gap_goes_with_nothing() -> None:
    words = described(*(timeless(name, 3.0) for name in NAMES)).remainder[1:]
    assert words == ("100 % of it is the same everywhere: +3°",)
