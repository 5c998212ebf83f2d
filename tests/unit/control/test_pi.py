"""PI against closed forms, its limits, and how it comes back from them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchlab.control.pi import PI
from benchlab.errors import BenchError, InputError

K, LAG = 300.0, 0.5  # of the plant: degrees per MPa, s


def loop(pi: PI, reference: np.ndarray, dt: float, angle: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Angles and pressures of a first-order plant under `pi`, its pressure held between samples: exact."""
    kept, angles, pressures = math.exp(-dt / LAG), [], []
    for wanted in reference:
        angles.append(angle)
        pressures.append(pi.pressure_MPa(wanted, wanted, angle, dt))
        angle = K * pressures[-1] + (angle - K * pressures[-1]) * kept
    return np.array(angles), np.array(pressures)


def test_step_response_on_a_first_order_plant() -> None:
    """With ki = kp/τ the loop is a/s, a = kp·K/τ; the start without a bump is a step of −kp·r before the plant."""
    kp, r, dt = 1e-3, 60.0, 1e-4
    pi = PI(kp, kp / LAG, ceiling_MPa=1.0)
    pi.start(0.0)
    t = np.arange(0, 3, dt)
    angle, _ = loop(pi, np.full(len(t), r), dt)
    a = kp * K / LAG
    exact = r * (1 - np.exp(-a * t)) - K * kp * r / LAG * (np.exp(-a * t) - np.exp(-t / LAG)) / (1 / LAG - a)
    assert angle == pytest.approx(exact, abs=0.01)


@given(st.lists(st.floats(1e-3, 0.1), min_size=1, max_size=30))
def test_the_integral_of_a_linear_error_is_exact_at_any_times(steps: list[float]) -> None:
    pi = PI(0.0, 1e-3, ceiling_MPa=1.0)
    pi.start(0.1)
    pi.pressure_MPa(1.0, 1.0, 0.0, steps[0])
    time = 0.0
    for dt in steps:
        time += dt
        found = pi.pressure_MPa(1.0 + 5 * time, 0.0, 0.0, dt)
    assert found == pytest.approx(0.1 + 1e-3 * (time + 2.5 * time**2), rel=1e-12)


@given(
    st.floats(0, 0.1),
    st.floats(0, 1),
    st.lists(st.tuples(st.floats(-400, 400), st.floats(-1, 1)), min_size=1, max_size=50),
)
def test_never_outside_its_limits(kp: float, ki: float, errors: list[tuple[float, float]]) -> None:
    pi = PI(kp, ki, ceiling_MPa=0.35)
    pi.start(0.2)
    for error, base in errors:
        assert 0 <= pi.around(base, error, 0.0, 0.01) <= 0.35


def test_it_starts_without_a_bump() -> None:
    pi = PI(0.01, 0.1, ceiling_MPa=0.35)
    pi.start(0.123)
    assert pi.around(0.3, 100.0, 20.0, 0.01) == pytest.approx(0.123, abs=1e-15)


def test_coming_back_from_a_limit_takes_as_long_however_long_it_was() -> None:
    dt, angles = 0.01, []
    for beyond_s in (5.0, 300.0):
        pi = PI(1e-3, 5e-3, ceiling_MPa=0.35)
        reference = np.concatenate([np.full(round(beyond_s / dt), 150.0), np.full(500, 50.0)])
        angle, pressure = loop(pi, reference, dt)
        assert pressure[round(beyond_s / dt) - 1] == 0.35 and pi.limited > 100
        angles.append(angle[-500:])
        assert np.min(pressure[-500:]) >= 0
    assert np.abs(angles[0] - angles[1]).max() < 0.5
    assert angles[1][150:] == pytest.approx(50.0, abs=3)


def test_no_angle_for_a_moment_keeps_the_pressure_and_for_longer_ends_the_run() -> None:
    pi = PI(1e-3, 1e-2, ceiling_MPa=0.35, missing_s=0.05)
    pi.start(0.1)
    for _ in range(3):
        before = pi.pressure_MPa(10.0, 10.0, 0.0, 0.01)
    assert [pi.pressure_MPa(10.0, 10.0, math.nan, 0.01) for _ in range(5)] == [before] * 5
    # Back again: the time without an angle is not integrated, the last step is.
    back = before + 1e-3 * (20 - 10) + 1e-2 * 0.01 * 20
    assert pi.pressure_MPa(20.0, 20.0, 0.0, 0.01) == pytest.approx(back, rel=1e-12)
    for _ in range(5):
        pi.pressure_MPa(10.0, 10.0, math.nan, 0.01)
    with pytest.raises(BenchError, match=r"no bending angle measured for 0\.06 s; 0\.05 s are allowed"):
        pi.pressure_MPa(10.0, 10.0, math.nan, 0.01)


@pytest.mark.parametrize(("kp", "ki", "ceiling"), [(-1, 0, 0.3), (math.nan, 0, 0.3), (0, math.inf, 0.3), (0, 0, 0)])
def test_impossible_gains_are_refused(kp: float, ki: float, ceiling: float) -> None:
    with pytest.raises(InputError):
        PI(kp, ki, ceiling)


def test_a_reference_that_is_missing_is_a_bug() -> None:
    with pytest.raises(ValueError, match="reference"):
        PI(0.1, 0.1, 0.35).pressure_MPa(math.nan, 0.0, 0.0, 0.01)
