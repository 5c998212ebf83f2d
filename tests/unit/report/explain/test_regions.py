"""Where they disagree, in words: regions are put together only where what is said holds for each of them."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import pytest

from benchlab.discrepancy.explanation import Region
from benchlab.report.explain.regions import merged, told_regions
from tests.unit.report import explanations

FOUND = explanations.curves({"a": 100.0, "b": 80.0, "c": 60.0}, cycles=3)
ONE = Region("a", "angle_deg", "loading", 0.01, 1, (0.2, 0.35), -4.5, 0.009)


def regions(designs: str = "abc", directions: tuple[str, ...] = ("loading", "unloading"),
            rates: tuple[float, ...] = explanations.RATES, cycles: tuple[int, ...] = (1, 2, 3)) -> list[Region]:  # fmt: skip
    return [
        replace(ONE, design=d, direction=w, rate_MPa_s=r, cycle=c)
        for d, w, r, c in product(designs, directions, rates, cycles)
    ]


def test_one_region_has_its_design_sign_interval_circumstances_and_p() -> None:
    assert told_regions([ONE], FOUND) == [
        "a bends 4.5° less than simulated from 0.20 to 0.35 MPa, loading, at 0.01 MPa/s, cycle 1; p = 0.009"
    ]
    (more,) = told_regions([replace(ONE, gap=0.5)], FOUND)
    assert "bends 0.5° more than simulated" in more


def test_all_of_everything_but_holds_is_one_sentence() -> None:
    assert told_regions(regions(), FOUND) == [
        "all 3 designs bend 4.5° less than simulated from 0.20 to 0.35 MPa, loading and unloading, at every rate, cycles 1 to 3; p = 0.009"
    ]


def test_the_sentence_of_the_brief() -> None:
    ramps = explanations.curves({"tw3_slw10": 130.0, "other": 50.0}, hold=False)
    found = [replace(ONE, design="tw3_slw10", direction=d, rate_MPa_s=r, cycle=None)
             for d in ("loading", "unloading") for r in explanations.RATES]  # fmt: skip
    assert told_regions(found, ramps) == [
        "tw3_slw10 bends 4.5° less than simulated from 0.20 to 0.35 MPa, loading and unloading, at every rate; p = 0.009"
    ]


@pytest.mark.parametrize("missing", range(0, 36, 5))
def test_what_is_said_covers_every_region_once_and_nothing_else(missing: int) -> None:
    """A combination taken out of the whole is never claimed: the sentences' own combinations are those of the regions."""
    given = regions()
    del given[missing]
    claimed = []
    for one in merged(given, FOUND):
        directions = one.directions or ("loading", "unloading", "hold")
        axes = (one.designs, directions, one.rates_MPa_s or explanations.RATES, one.cycles or (1, 2, 3))
        claimed += list(product(*axes))
    assert sorted(claimed) == sorted((r.design, r.direction, r.rate_MPa_s, r.cycle) for r in given)


def test_gaps_of_other_sign_quantity_or_pressure_stay_apart() -> None:
    for other in (replace(ONE, design="b", gap=4.5), replace(ONE, design="b", pressure_MPa=(0.05, 0.15))):
        assert len(merged([ONE, other], FOUND)) == 2


def test_together_they_have_the_common_pressures_the_span_of_gaps_and_the_largest_p() -> None:
    (both,) = merged([ONE, replace(ONE, design="b", pressure_MPa=(0.15, 0.34), gap=-3.0, p=0.02)], FOUND)
    assert (both.designs, both.pressure_MPa, both.gap, both.p) == (("a", "b"), (0.2, 0.34), (-4.5, -3.0), 0.02)
    (told,) = told_regions([ONE, replace(ONE, design="b", gap=-3.0, p=0.02)], FOUND)
    assert told.startswith("a and b bend 3.0 to 4.5° less than simulated") and told.endswith("p ≤ 0.02")


def test_holds_are_told_as_holds() -> None:
    held = [replace(ONE, direction="hold", rate_MPa_s=None, cycle=c, pressure_MPa=(0.35, 0.35)) for c in (1, 2, 3)]
    assert told_regions(held, FOUND) == [
        "a bends 4.5° less than simulated at 0.35 MPa, in holds, cycles 1 to 3; p = 0.009"
    ]


def test_the_order_of_regions_changes_nothing() -> None:
    given = [*regions(), replace(ONE, gap=2.0), replace(ONE, design="b", gap=-9.0, pressure_MPa=(0.01, 0.02))]
    assert told_regions(given, FOUND) == told_regions(given[::-1], FOUND)


def test_the_published_table_has_no_direction_rate_or_cycle() -> None:
    found = explanations.published()
    assert told_regions(found.where, found.curves) == [
        "tw3_slw10, tw3_slw5 and tw9_slw10 bend 4.5 to 9.3° less than simulated at 0.35 MPa; p ≤ 0.009"
    ]


def test_many_are_told_by_direction_and_sign() -> None:
    given = [replace(ONE, pressure_MPa=(i / 100, (i + 1) / 100), gap=-1.0 - i) for i in range(0, 30, 2)]
    told = told_regions(given, FOUND, most=3)
    assert told == [
        "a bends 1.0 to 29.0° less than simulated within 0.00 to 0.29 MPa, loading, at 0.01 MPa/s, cycle 1; p ≤ 0.009",
        "told together: 15 regions, each in the report's table and in --json",
    ]
    back = [replace(one, direction="unloading", gap=-one.gap, design="b") for one in given]
    first, second, last = told_regions([*given, *back, replace(ONE, gap=40.0)], FOUND, most=3)[:3]
    assert first.startswith("a bends 40.0° more than simulated from 0.20 to 0.35 MPa, loading")
    assert second.startswith("a bends 1.0 to 29.0° less") and last.startswith("b bends 1.0 to 29.0° more")


def test_forces_and_columns_of_users() -> None:
    found = explanations.crowded()
    told = told_regions(found.where, found.curves)
    assert [line.split(" than")[0] for line in told] == [
        "all 14 designs bend 5.0 to 6.3° less",
        "all 14 designs push 0.210 N less",
        "all 14 designs have a lift_mm 1.30 mm lower",
    ]


def test_small_probabilities_are_below_their_floor() -> None:
    assert told_regions([replace(ONE, p=0.0)], FOUND)[0].endswith("p < 0.0001")
