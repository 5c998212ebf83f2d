"""Loadings found in drawn traces whose cycles are known: many seeds, noise, drift, double bumps, uneven and cut cycles."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from benchlab.force.loading import find_loadings
from benchlab.force.synthetic import CycleShape, DrawnTrace, draw_trace

LEVELS = np.repeat(np.round(0.035 * np.arange(1, 11), 3), 5)
PEAKS = 37.72 / 0.35 * LEVELS


def drawn(seed: int = 0, **options) -> DrawnTrace:
    return draw_trace(PEAKS.tolist(), LEVELS.tolist(), np.random.default_rng(seed), **options)


def holds_each_peak(trace: DrawnTrace, values: np.ndarray) -> bool:
    found = find_loadings(values)
    return len(found) == len(trace.peaks_N) and all(
        trace.time_s[c.start] <= t <= trace.time_s[c.stop - 1] for c, t in zip(found, trace.peak_times_s)
    )


@pytest.mark.parametrize("noise_N", [0.0, 0.05, 0.3, 0.8])
@pytest.mark.parametrize(("offset_N", "drift_N_per_s"), [(0.0, 0.0), (3.0, 0.02), (-40.0, -0.02)])
def test_fifty_cycles_of_ten_heights_are_found(noise_N: float, offset_N: float, drift_N_per_s: float) -> None:
    for seed, uneven, dip in itertools.product(range(4), (0.0, 0.6), (0.0, 0.5)):
        trace = drawn(seed, noise_N=noise_N, offset_N=offset_N, drift_N_per_s=drift_N_per_s, uneven=uneven,
                      shape=CycleShape(dip=dip))  # fmt: skip
        assert holds_each_peak(trace, trace.force_N), (seed, uneven, dip)
        assert holds_each_peak(trace, trace.pressure_MPa)


@pytest.mark.parametrize("rate_Hz", [10, 20, 1000])
def test_the_rate_of_readings_does_not_matter(rate_Hz: float) -> None:
    for seed in range(3):
        trace = drawn(seed, rate_Hz=rate_Hz, noise_N=0.1)
        assert holds_each_peak(trace, trace.force_N)


def test_rise_and_fall_lie_half_way_up() -> None:
    trace = draw_trace([10.0], [0.1], np.random.default_rng(0), rate_Hz=1000, shape=CycleShape(relaxation=0))
    (cycle,) = find_loadings(trace.force_N)
    assert trace.time_s[cycle.rise] == pytest.approx(1.5 + 0.15, abs=0.01)
    assert trace.time_s[cycle.fall] == pytest.approx(1.5 + 0.3 + 1.5 + 0.2, abs=0.01)


def test_three_bumps_are_one_loading_as_long_as_they_do_not_come_back() -> None:
    def trace(dip: float) -> np.ndarray:
        return np.repeat([0, 10, dip, 9, dip, 10, 0, 8, 0.0], 40)

    assert len(find_loadings(trace(5.0))) == 2
    assert len(find_loadings(trace(3.0))) == 4


def test_cut_cycles_are_told() -> None:
    whole = find_loadings(drawn().force_N)
    assert {c.cut for c in whole} == {""}
    trace = drawn(cut_s=(2.5, 2.2))  # both within a hold
    cuts = [c.cut for c in find_loadings(trace.force_N)]
    assert (len(cuts), cuts[0], cuts[-1], set(cuts[1:-1])) == (50, "start", "end", {""})


def test_a_record_that_ends_in_a_rest_or_low_on_the_fall_is_whole() -> None:
    trace = drawn(cut_s=(0.0, 1.6))
    assert [c.cut for c in find_loadings(trace.force_N)] == [""] * 50


@pytest.mark.parametrize("seed", range(10))
def test_noise_alone_is_no_loading(seed: int) -> None:
    rng = np.random.default_rng(seed)
    assert find_loadings(rng.normal(0, 0.1, 20_000)) == ()
    assert find_loadings(rng.normal(5, 0.1, 500) + 0.001 * np.arange(500)) == ()


def test_constant_short_and_unknown_traces_have_none() -> None:
    assert find_loadings(np.zeros(100)) == find_loadings(np.array([1.0, 2.0])) == find_loadings(np.array([])) == ()
    assert find_loadings(np.full(50, np.nan)) == ()


def test_one_wild_reading_is_no_loading_and_hides_none() -> None:
    trace = drawn(noise_N=0.05)
    values = trace.force_N.copy()
    values[[300, 4000, 9001]] = 5000.0, -3000.0, 900.0
    assert holds_each_peak(trace, values)


def test_missing_readings_keep_their_places() -> None:
    trace = drawn(noise_N=0.05)
    values = trace.force_N.copy()
    values[::7] = np.nan
    found, whole = find_loadings(values), find_loadings(trace.force_N)
    assert [c.rise for c in found] == pytest.approx([c.rise for c in whole], abs=3)
    assert [c.stop for c in found][-1] == len(values)


def test_a_staircase_that_never_comes_back_between_is_one_loading() -> None:
    assert len(find_loadings(np.repeat([0, 2, 4, 6, 8, 6, 4, 2, 0.0], 50))) == 1
