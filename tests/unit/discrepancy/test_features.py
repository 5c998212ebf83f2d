from dataclasses import replace

import numpy as np
import pytest

from benchlab.discrepancy.features import Features, features_of
from benchlab.discrepancy.measured import Run
from benchlab.discrepancy.points import BINS, HOLD_EDGES
from tests.unit.discrepancy.scenes import KINDS, TOP_MPa, base

DESIGN = next(iter(base(1).designs))


def run_of(kind: str, sample: str = "s1", run: str = "r1", shift_deg: float = 0.0, **more: object) -> Run:
    """Loading: 10 · interval; unloading: 100 + that; hold: 1000 + its interval: one value in all of a feature."""
    corners_s, corners_MPa, number = KINDS[kind]
    time = np.linspace(0, corners_s[-1], 5 * (number - 1) + 1)
    pressure = np.interp(time, corners_s, corners_MPa)
    interval = np.clip(np.floor(pressure / TOP_MPa * BINS + 1e-9), 0, BINS - 1)
    angle = 10 * interval + shift_deg + 100 * (np.gradient(pressure, time) < -1e-6)
    if kind == "hold":
        held = (time >= corners_s[1]) & (time <= corners_s[2])
        share = (time - corners_s[1]) / (corners_s[2] - corners_s[1])
        angle = np.where(held, 1000 + np.searchsorted(HOLD_EDGES, share, side="right") - 1, angle)
    return Run(DESIGN, sample, run, time, pressure, {"angle_deg": angle}, **more)  # type: ignore[arg-type]


def features(*runs: Run) -> Features:
    return features_of(runs, base(1), TOP_MPa)[0]


@pytest.mark.parametrize("kind", ["slow", "fast", "hold"])
def test_a_cell_is_the_mean_of_its_readings(kind: str) -> None:
    found = features(run_of(kind))
    for cell, number in enumerate(found.feature):
        one = found.features[number]
        expected = {"loading": 10 * one.bin, "unloading": 100 + 10 * one.bin, "hold": 1000 + one.bin}[one.direction]
        border = (
            0.1 if one.direction == "hold" else 1.5
        )  # a reading on the border of two intervals may count for either
        assert found.value[cell] == pytest.approx(expected, abs=border), one
        if one.direction != "hold" and 0 < one.bin < 6:  # an interval that the run passes from end to end
            assert one.pressure_MPa * BINS / TOP_MPa == pytest.approx(one.bin + 0.5, abs=0.1)


def test_every_reading_between_the_turns_counts_once() -> None:
    run = run_of("fast")
    found = features(run)
    turns = 7
    assert found.count.sum() == len(run.time_s) - turns
    assert {(f.cycle, f.direction) for f in found.features} == {
        (c, w) for c in (1, 2, 3) for w in ("loading", "unloading")
    }


def test_collecting_the_points_gives_the_measured_means() -> None:
    found, scene = features_of([run_of("slow"), run_of("fast", run="r2")], base(1))
    assert np.bincount(found.of_point["angle_deg"][found.of_point["angle_deg"] >= 0]).min() >= 3
    pressure = found.collect({"angle_deg": scene.pressure_MPa})
    assert pressure == pytest.approx([found.features[i].pressure_MPa for i in found.feature])


def test_nothing_hangs_on_the_order_of_the_runs() -> None:
    runs = [run_of(kind, f"s{i}", kind, 3.0 * i) for i in range(3) for kind in ("slow", "fast", "hold")]
    one, other = features(*runs), features(*(runs[i] for i in np.random.default_rng(1).permutation(len(runs))))
    assert (
        repr(one.features) == repr(other.features)
        and one.kinds == other.kinds
        and one.sample_names == other.sample_names
    )
    assert np.array_equal(one.value, other.value) and np.array_equal(one.count, other.count)


def test_a_repeated_run_is_another_feature_only_where_the_order_is_known() -> None:
    told = features(run_of("slow", run="r1", run_index=1), run_of("slow", run="r2", shift_deg=4, run_index=2))
    first, second = (told.value[[told.features[f].occurrence == n for f in told.feature]] for n in (0, 1))
    assert second - first == pytest.approx(4)
    untold = features(run_of("slow", run="r1"), run_of("slow", run="r2", shift_deg=4))
    assert {f.occurrence for f in untold.features} == {0}
    assert untold.value == pytest.approx(first + 2) and untold.count.sum() == told.count.sum()


def test_only_what_is_kept_stays_and_the_rest_is_numbered_anew() -> None:
    whole, scene = features_of([run_of("slow", f"s{i}", shift_deg=i) for i in range(3)], base(1))
    loading = np.array([whole.features[i].direction == "loading" for i in whole.feature])
    kept = whole.only(loading & (whole.sample != 1))
    assert kept.sample_names == (f"{DESIGN} s0", f"{DESIGN} s2") and set(kept.sample) == {0, 1}
    assert kept.features == whole.features and np.array_equal(kept.value, whole.value[loading & (whole.sample != 1)])
    moved = {"angle_deg": scene.pressure_MPa}
    assert np.array_equal(kept.collect(moved), whole.collect(moved)[loading & (whole.sample != 1)])


def test_readings_that_are_missing_do_not_count() -> None:
    run = run_of("slow")
    angle = run.values["angle_deg"].copy()
    angle[::2] = np.nan
    found = features(replace(run, values={"angle_deg": angle}))
    assert 0.45 < found.count.sum() / features(run).count.sum() < 0.55
    assert np.isfinite(found.value).all()
    angle[run.time_s < 30] = np.nan
    assert {f.direction for f in features(replace(run, values={"angle_deg": angle})).features} == {"unloading"}


def test_runs_that_did_about_the_same_are_one_kind_and_a_mounting_is_another() -> None:
    slow = run_of("slow")
    slower = replace(slow, run="r2", time_s=1.3 * slow.time_s)
    much_slower = replace(slow, run="r3", time_s=1.4 * slow.time_s)
    lower = replace(slow, run="r4", pressure_MPa=0.9 * slow.pressure_MPa)
    turned = replace(slow, run="r5", orientation_deg=90.0)
    assert len(features(slow, slower).kinds) == 1
    for other in (much_slower, lower, turned):
        assert len(features(slow, other).kinds) == 2
    assert [kind.words for kind in features(turned).kinds] == ["to 0.35 MPa at 0.012 MPa/s, mounted at 90°"]
