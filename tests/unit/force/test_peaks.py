"""Peaks and zero against drawn traces of known peaks, zero, drift and noise."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.force.clipping import clipping_value
from benchlab.force.loading import Loading, find_loadings
from benchlab.force.peaks import NO_CONTACT, ForceRecord, loadings_of_cycles, peaks_of, pushes_down
from benchlab.force.synthetic import CycleShape, DrawnTrace, draw_trace

LEVELS = np.repeat(np.round(0.035 * np.arange(1, 11), 3), 5)
PEAKS = 37.72 / 0.35 * LEVELS


def drawn(seed: int = 0, **options) -> DrawnTrace:
    return draw_trace(PEAKS.tolist(), LEVELS.tolist(), np.random.default_rng(seed), **options)


def errors(record: ForceRecord, trace: DrawnTrace) -> np.ndarray:
    return np.array([peak.peak_N for peak in record.peaks]) - trace.peaks_N


@pytest.mark.parametrize("by_pressure", [False, True])
def test_without_noise_peaks_are_exact_to_the_rate_of_readings(by_pressure: bool) -> None:
    trace = drawn(rate_Hz=500, offset_N=2.0)
    found = peaks_of(trace.force_N, trace.time_s, find_loadings(trace.pressure_MPa) if by_pressure else None)
    assert np.abs(errors(found, trace) / trace.peaks_N).max() < 6e-4
    assert [p.time_s for p in found.peaks] == pytest.approx(trace.peak_times_s, abs=0.05)
    assert [p.row for p in found.peaks] == pytest.approx(500 * trace.peak_times_s, abs=25)


@pytest.mark.parametrize("by_pressure", [False, True])
@pytest.mark.parametrize(("rate_Hz", "noise_N", "largest"), [(100, 0.02, 0.05), (100, 0.3, 0.75), (500, 0.1, 0.15)])
def test_peaks_with_noise_zero_and_drift(by_pressure: bool, rate_Hz: float, noise_N: float, largest: float) -> None:
    all_errors, raw = [], []
    for seed in range(6):
        trace = drawn(seed, rate_Hz=rate_Hz, noise_N=noise_N, offset_N=3.0, drift_N_per_s=0.02, uneven=0.4)
        found = peaks_of(trace.force_N, trace.time_s, find_loadings(trace.pressure_MPa) if by_pressure else None)
        all_errors.append(errors(found, trace))
        raw.append(np.array([p.raw_N - p.baseline_N for p in found.peaks]) - trace.peaks_N)
        assert found.baseline is not None
        assert found.baseline.noise_N == pytest.approx(noise_N, rel=0.2)
        assert found.baseline.slope_N_per_s == pytest.approx(0.02, abs=0.0005)
        truth = 3.0 + 0.02 * np.interp(found.baseline.place, np.arange(len(trace.time_s)), trace.time_s)
        assert np.abs(found.baseline.level_N - truth).max() < max(0.02, 0.5 * noise_N)
    assert np.abs(all_errors).max() < largest
    assert abs(np.mean(all_errors)) < 0.7 * noise_N
    assert abs(np.mean(all_errors)) < abs(np.mean(raw))  # the largest of many readings lies above the truth


def test_the_stated_standard_deviation_covers_the_errors() -> None:
    shares = []
    for seed in range(10):
        trace = drawn(seed, rate_Hz=100, noise_N=0.15, offset_N=1.0)
        found = peaks_of(trace.force_N, trace.time_s)
        shares.append(np.abs(errors(found, trace)) < 2 * np.array([p.sd_N for p in found.peaks]))
    assert 0.85 < np.mean(shares) <= 1.0


def test_the_zero_is_taken_rest_by_rest_where_it_jumps() -> None:
    trace = drawn(rate_Hz=200, noise_N=0.02)
    jump = np.where(trace.time_s > trace.peak_times_s[24] + 3.0, 5.0, 0.0)  # in the rest behind cycle 25
    found = peaks_of(trace.force_N + jump, trace.time_s)
    away = np.delete(errors(found, trace), [24, 25])
    assert np.abs(away).max() < 0.1


def test_a_slow_fall_and_a_swing_below_zero_do_not_move_the_zero() -> None:
    trace = draw_trace([20.0] * 6, [0.2] * 6, np.random.default_rng(1), rate_Hz=200, noise_N=0.02)
    after = trace.time_s[:, None] - (trace.peak_times_s + 1.9)
    tail = np.where(after > 0, 0.5 * np.exp(-after / 0.25), 0).sum(axis=1)
    swing = np.where((after > 0) & (after < 0.1), -0.6, 0).sum(axis=1)
    for other in (tail, swing):
        found = peaks_of(trace.force_N + other, trace.time_s)
        assert found.baseline is not None
        assert np.abs(found.baseline.level_N).max() < 0.06
        assert np.abs(errors(found, trace)).max() < 0.15


def test_where_nothing_rests_the_lowest_is_taken_and_it_is_told() -> None:
    force = 5 + 4 * np.abs(np.sin(np.linspace(0, 5 * np.pi, 2001)))
    found = peaks_of(force)
    assert found.baseline is not None and not found.baseline.flat.any()
    assert [p.peak_N for p in found.peaks] == pytest.approx([4.0] * 5, abs=0.15)


def test_without_time_there_is_no_slope_and_no_time_of_a_peak() -> None:
    found = peaks_of(drawn().force_N)
    assert found.baseline is not None
    assert np.isnan(found.baseline.slope_N_per_s) and np.isnan(found.peaks[0].time_s)


def test_a_wild_reading_is_in_the_raw_peak_only() -> None:
    trace = drawn(rate_Hz=200, noise_N=0.02)
    force = trace.force_N.copy()
    force[np.searchsorted(trace.time_s, trace.peak_times_s[10] + 0.5)] = 99.0
    found = peaks_of(force, trace.time_s)
    assert found.peaks[10].raw_N == 99.0
    assert np.abs(errors(found, trace)).max() < 0.1


def test_a_corner_is_no_peak_higher_than_its_readings() -> None:
    force = np.repeat([0.0, 10.0, 0.0, 10.0, 0.0], 200)
    force[650] = 1e300
    found = peaks_of(force)
    assert [p.peak_N for p in found.peaks] == [10.0, 10.0]
    assert [p.raw_N for p in found.peaks] == [10.0, 1e300]


def test_a_load_cell_at_its_limit_gives_lower_bounds() -> None:
    trace = drawn(rate_Hz=100, noise_N=0.02)
    found = peaks_of(np.minimum(trace.force_N, 10.0), trace.time_s)
    assert found.clipped_at_N == 10.0
    assert [p.lower_bound for p in found.peaks] == (trace.peaks_N > 10.1).tolist()
    assert "clipped at 10 N" in found.peaks[-1].why


def test_level_holds_and_coarse_readings_are_not_taken_for_a_limit() -> None:
    assert clipping_value(np.repeat([0.0, 5.0, 0.0, 9.0, 0.0], 100)) is None
    assert clipping_value(np.round(drawn(noise_N=0.05).force_N, 1)) is None
    assert clipping_value(drawn().force_N) is None
    assert clipping_value(np.minimum(np.round(drawn(noise_N=0.05).force_N, 1), 20.0)) == 20.0


def test_readings_missing_at_the_top_give_a_lower_bound() -> None:
    trace = drawn(noise_N=0.02)
    force = np.where(trace.force_N > 30, np.nan, trace.force_N)
    found = peaks_of(force, trace.time_s)
    assert len(found.peaks) == 50
    assert [p.lower_bound for p in found.peaks] == (trace.peaks_N > 30).tolist()
    assert trace.force_N[found.peaks[0].row] == pytest.approx(trace.peaks_N[0], abs=0.1)


def test_cut_cycles_are_marked() -> None:
    found = peaks_of(drawn(cut_s=(2.5, 0.0)).force_N)
    assert [p.cut for p in found.peaks] == [True] + [False] * 49
    assert "cut at its start" in found.peaks[0].why


@pytest.mark.parametrize("force", [np.zeros(500), np.random.default_rng(1).normal(0, 0.01, 5000)])
def test_no_contact_is_told(force: np.ndarray) -> None:
    found = peaks_of(force)
    assert not found.contact and found.peaks == ()
    assert found.notes[0] == NO_CONTACT and "stays between" in found.notes[1]


def test_no_contact_with_known_cycles_gives_peaks_of_noise() -> None:
    trace = drawn(noise_N=0.01)
    found = peaks_of(
        np.random.default_rng(2).normal(0, 0.01, len(trace.time_s)), trace.time_s, find_loadings(trace.pressure_MPa)
    )
    assert not found.contact
    assert max(abs(p.peak_N) for p in found.peaks) < 0.02


def test_a_record_without_readings_or_without_a_rest_says_so() -> None:
    assert peaks_of(np.full(10, np.nan)).notes == ("no reading of force",)
    found = peaks_of(np.linspace(8.0, 9.0, 10), loadings=[Loading(0, 0, 9, 10)])
    assert not found.contact and not found.untouched
    assert found.notes == ("no unloaded rest in the record, so that its zero is not known",)


def test_the_way_of_a_trace() -> None:
    trace = drawn(noise_N=0.05)
    assert not pushes_down(trace.force_N) and pushes_down(-trace.force_N)
    assert not pushes_down(trace.force_N - 50) and pushes_down(50 - trace.force_N)
    assert not pushes_down(np.zeros(100)) and not pushes_down(np.random.default_rng(0).normal(0, 1, 1000))


def test_a_column_of_cycles_tells_where_they_are() -> None:
    trace = draw_trace([5.0, 7.0, 6.0], [0.1] * 3, np.random.default_rng(0), noise_N=0.01, shape=CycleShape(dip=0.9))
    cycle = 1.0 + np.searchsorted(trace.peak_times_s[1:] - 1.0, trace.time_s)
    found = peaks_of(trace.force_N, trace.time_s, loadings_of_cycles(cycle, trace.force_N))
    assert errors(found, trace) == pytest.approx([0, 0, 0], abs=0.03)
    assert len(find_loadings(trace.force_N)) == 6  # a dip to a tenth is a return, where nobody says otherwise


@pytest.mark.parametrize("rate_Hz", [20, 100])
def test_one_reading_that_stands_alone_is_no_peak(rate_Hz: float) -> None:
    trace = drawn(rate_Hz=rate_Hz, noise_N=0.02)
    clean = peaks_of(trace.force_N, trace.time_s)
    row = clean.peaks[7].row + rate_Hz // 2
    force = trace.force_N.copy()
    force[row] *= 2
    found = peaks_of(force, trace.time_s)
    assert found.peaks[7].raw_N == force[row] and found.peaks[7].alone == 1 and "left out" in found.peaks[7].why
    assert found.peaks[7].peak_N == pytest.approx(clean.peaks[7].peak_N, abs=0.05)
    assert [peak.alone for peak in found.peaks if peak.number != 8] == [0] * 49


def test_a_pointed_loading_keeps_its_point() -> None:
    for readings in (15, 21, 61):
        top = 10 * (1 - np.abs(np.linspace(-1, 1, readings)))
        record = peaks_of(np.concatenate([*[np.concatenate([np.zeros(20), top])] * 4, np.zeros(20)]))
        assert [peak.alone for peak in record.peaks] == [0] * 4
        assert record.peaks[1].peak_N == pytest.approx(10, abs=10 * 2.5 / readings)


def test_few_readings_give_the_largest_one_and_say_so() -> None:
    record = peaks_of(
        np.concatenate([np.tile(np.concatenate([np.zeros(9), [2.0, 4.0, 4.2, 4.1, 2.0]]), 5), np.zeros(9)])
    )
    assert all(
        peak.coarse and peak.peak_N == pytest.approx(4.2) and "largest reading" in peak.why for peak in record.peaks
    )
