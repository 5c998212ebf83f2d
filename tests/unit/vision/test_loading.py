"""Cycles found in pressure traces, and angles at a pressure against the curves that they were made of."""

import math

import numpy as np
import pytest

from benchlab.vision.loading import Trace, angle_at, find_cycles, rising_curve

TARGET, TOLERANCE = 0.35, 0.0035


def response(pressure: np.ndarray) -> np.ndarray:
    """A smooth angle in deg: 100 at the target."""
    share = pressure / TARGET
    return 100 * share * (1.35 - 0.35 * share)


def trapezes(peaks: list[float], rise: int = 50, hold: int = 20, rest: int = 10) -> np.ndarray:
    parts = [
        np.concatenate([np.zeros(rest), np.linspace(0, p, rise), np.full(hold, p), np.linspace(p, 0, rise)])
        for p in peaks
    ]
    return np.concatenate([*parts, np.zeros(rest)])


def trace_of(pressure: np.ndarray, angle: np.ndarray | None = None, sd: float = 0.2) -> Trace:
    angle = response(pressure) if angle is None else angle
    return Trace(pressure, angle, np.full(len(pressure), sd), np.ones(len(pressure), bool))


def read_all(trace: Trace, at: float = TARGET) -> list:
    return [angle_at(at, TOLERANCE, trace, cycle) for cycle in find_cycles(trace.pressure_MPa, TARGET)]


def test_every_cycle_is_found_and_read_in_its_hold() -> None:
    readings = read_all(trace_of(trapezes([0.35, 0.35, 0.35])))
    assert [r.method for r in readings] == ["held"] * 3
    assert [r.angle for r in readings] == pytest.approx([100] * 3, abs=1e-9)
    assert [r.sd for r in readings] == pytest.approx([0.2] * 3)
    assert all(
        len(r.frames) == 22 for r in readings
    )  # the last frame of the rise and the first of the fall are at the peak too


def test_noise_on_the_pressure_makes_no_cycles() -> None:
    rng = np.random.default_rng(1)
    clean = trapezes([0.35] * 5)
    noisy = clean + rng.normal(0, 0.004, len(clean))
    readings = [angle_at(TARGET, 0.012, trace_of(noisy, response(clean)), c) for c in find_cycles(noisy, TARGET)]
    assert len(readings) == 5
    assert [r.angle for r in readings] == pytest.approx([100] * 5, abs=0.5)


def test_a_peak_that_does_not_reach_has_no_value_and_says_so() -> None:
    good, low = read_all(trace_of(trapezes([0.35, 0.31])))
    assert good.method == "held" and low.method == "" and math.isnan(low.angle) and math.isnan(low.sd)
    assert low.why == "its peak of 0.31 MPa does not reach 0.35 MPa"


def test_pressures_far_below_the_wanted_one_are_no_cycle() -> None:
    assert find_cycles(trapezes([0.2, 0.1]), TARGET) == ()
    assert find_cycles(np.full(5, np.nan), TARGET) == ()
    assert find_cycles(np.array([]), TARGET) == ()


def test_a_trace_that_passes_the_pressure_is_interpolated_on_the_rise() -> None:
    pressure = trapezes([0.5], rise=60)
    angle = response(pressure)
    angle[len(angle) // 2 :] += 7  # hysteresis: the way back is another
    (reading,) = read_all(trace_of(pressure, angle))
    assert reading.method == "interpolated" and reading.angle == pytest.approx(100, abs=0.02)
    assert reading.frames[1] == reading.frames[0] + 1


def test_a_slow_pass_is_no_hold_though_many_frames_are_within_the_tolerance() -> None:
    pressure = np.concatenate([np.linspace(0, 0.4, 2000), np.linspace(0.4, 0, 2000)])
    angle = response(pressure)
    angle[2000:] += 7
    (reading,) = read_all(trace_of(pressure, angle))
    assert reading.method == "interpolated" and reading.angle == pytest.approx(100, abs=1e-3)


def test_an_overshoot_before_the_hold_is_passed_over() -> None:
    pressure = np.concatenate(
        [np.linspace(0, 0.37, 40), np.linspace(0.37, 0.35, 5), np.full(30, 0.35), np.linspace(0.35, 0, 20)]
    )
    (reading,) = read_all(trace_of(pressure))
    assert reading.method == "held" and len(reading.frames) >= 30 and reading.angle == pytest.approx(100, abs=0.05)


def test_doubtful_frames_are_used_only_where_no_sure_one_would_do() -> None:
    pressure = trapezes([0.35, 0.35])
    angle = response(pressure)
    first, second = find_cycles(pressure, TARGET)
    sure = np.ones(len(pressure), bool)
    odd = np.flatnonzero(pressure[: first.stop] == 0.35)[:5]
    angle[odd], sure[odd] = 500, False
    sure[second.start :] = False
    trace = Trace(pressure, angle, np.full(len(pressure), 0.1), sure)
    readings = [angle_at(TARGET, TOLERANCE, trace, cycle) for cycle in (first, second)]
    assert [r.angle for r in readings] == pytest.approx([100, 100])
    assert not set(odd.tolist()) & set(readings[0].frames)


def test_what_was_not_measured_stays_missing_with_its_reason() -> None:
    pressure = trapezes([0.35])
    angle = response(pressure)
    angle[pressure > 0.34] = np.nan
    (reading,) = read_all(trace_of(pressure, angle))
    assert reading.why == "no frame was measured while 0.35 MPa were held"
    pressure = np.concatenate([np.zeros(3), np.linspace(0, 0.5, 51)])
    angle = response(pressure)
    angle[(pressure > 0.29) & (pressure < 0.41)] = np.nan
    (reading,) = read_all(trace_of(pressure, angle))
    assert reading.why.startswith("no frame was measured between 0.29 and 0.41 MPa")
    angle = response(pressure)
    angle[pressure >= 0.35] = np.nan
    (reading,) = read_all(trace_of(pressure, angle))
    assert reading.why == "no frame was measured above 0.35 MPa on the rise"


def test_few_stills_at_rising_pressures_are_interpolated_however_far_apart() -> None:
    (reading,) = read_all(trace_of(np.array([0, 0.1, 0.2, 0.3, 0.4])))
    low, high = response(np.array([0.3, 0.4]))
    assert reading.angle == pytest.approx((low + high) / 2)


def test_the_curve_does_not_turn_up_where_a_hold_creeps() -> None:
    """3° of creep in a hold of 60 frames: the value has its mean, the curve ends where the hold begins."""
    pressure = trapezes([0.35])
    held = pressure >= 0.35 - 1e-9
    angle = response(pressure) + np.where(held, np.linspace(0, 3, held.sum())[np.cumsum(held) - 1], 0)
    trace = trace_of(pressure, angle)
    cycles = find_cycles(trace.pressure_MPa, TARGET)
    curve = rising_curve(np.linspace(0, TARGET, 36), TOLERANCE, trace, cycles)
    (top,) = response(np.array([0.35]))
    assert angle_at(TARGET, TOLERANCE, trace, cycles[0]).angle == pytest.approx(top + 1.5, abs=0.2)
    assert curve[-1] == pytest.approx(top, abs=3 * 3 / held.sum())


def test_the_curve_meets_the_response_and_ends_with_the_value() -> None:
    grid = np.linspace(0, TARGET, 36)
    trace = trace_of(trapezes([0.35, 0.31]))
    cycles = find_cycles(trace.pressure_MPa, TARGET)
    curve = rising_curve(grid, TOLERANCE, trace, cycles)
    assert curve == pytest.approx(response(grid), abs=0.05)
    assert curve[-1] == pytest.approx(angle_at(TARGET, TOLERANCE, trace, cycles[0]).angle, abs=1e-9)
    assert np.isnan(rising_curve(np.array([0.4]), TOLERANCE, trace, cycles)).all()
    late = trace_of(trapezes([0.35])[25:])
    late_curve = rising_curve(grid, TOLERANCE, late, find_cycles(late.pressure_MPa, TARGET))
    started = late.pressure_MPa[0] - TOLERANCE
    assert np.isnan(late_curve[grid < started]).all() and np.isfinite(late_curve[grid > started]).all()


def test_the_last_frames_of_a_ramp_are_not_of_its_hold() -> None:
    pressure = np.concatenate([np.arange(0, 0.35, 0.0023), np.full(8, 0.35), np.arange(0.3485, 0, -0.0023)])
    angle = 100 * pressure
    trace = Trace(pressure, angle, np.zeros_like(angle), np.ones(len(angle), bool))
    (cycle,) = find_cycles(pressure, 0.35)
    assert np.count_nonzero(np.abs(pressure - 0.35) <= 0.0035) == 11
    found = angle_at(0.35, 0.0035, trace, cycle)
    assert (found.method, len(found.frames)) == ("held", 10)  # one at 0.3496, one at 0.3485; the one at 0.3473 is not
    assert found.angle == pytest.approx(34.9810)
