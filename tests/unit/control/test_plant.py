"""Plants found from runs that were made with known ones."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchlab.control.first_order import response
from benchlab.control.holds import find_holds
from benchlab.control.plant import identify
from benchlab.control.tuning import Lag, margins, tune
from benchlab.errors import InputError

DT = 0.01


def staircase(hold_s: float = 3.0, step_MPa: float = 0.035, steps: int = 10) -> tuple[np.ndarray, np.ndarray]:
    levels = np.concatenate([np.arange(steps + 1), np.arange(steps - 1, -1, -1)]) * step_MPa
    command = np.repeat(levels, round(hold_s / DT))
    return np.arange(len(command)) * DT, command


def test_response_against_an_ode_solver() -> None:
    rng = np.random.default_rng(1)
    t = np.cumsum(rng.uniform(0.005, 0.02, 200))
    u = np.repeat(rng.uniform(0, 1, 20), 10)
    lag, dead = 0.13, 0.037

    def held(at: float) -> float:
        return float(u[max(np.searchsorted(t, at, side="right") - 1, 0)])

    solved = solve_ivp(
        lambda at, x: (held(at - dead) - x) / lag, (t[0], t[-1]), [u[0]], t_eval=t, max_step=5e-4, rtol=1e-8
    )
    assert response(t, u, lag, dead) == pytest.approx(solved.y[0], abs=2e-3)


def test_steps_give_gain_lag_and_dead_time_with_their_intervals() -> None:
    t, u = staircase()
    rng, inside = np.random.default_rng(4), []
    for _ in range(5):
        angle = 300 * response(t, u, 0.15, 0.043) + rng.normal(0, 0.3, len(t))
        found = identify(t, u, angle)
        assert found.method == "steps" and len(found.plants) == 20 and not found.left_out
        for plant in found.plants:
            assert plant.gain_deg_per_MPa.value == pytest.approx(300, rel=0.03)
            assert plant.lag_s.value == pytest.approx(0.15, rel=0.15)
            assert plant.dead_time_s.value == pytest.approx(0.043, abs=0.015)
            assert plant.residual_sd_deg == pytest.approx(0.3, rel=0.15)
            inside += [_holds(plant.gain_deg_per_MPa, 300), _holds(plant.lag_s, 0.15), _holds(plant.dead_time_s, 0.043)]
    assert 0.90 <= np.mean(inside) <= 0.99


def _holds(interval, truth: float) -> bool:
    return interval.low <= truth <= interval.high


def test_operating_points_of_a_curve_have_its_slopes() -> None:
    t, u = staircase()
    found = identify(t, u, 130 * np.tanh(response(t, u, 0.1, 0.02) / 0.2))
    slopes = [130 / 0.2 / np.cosh(plant.pressure_MPa / 0.2) ** 2 for plant in found.plants]
    assert [plant.gain_deg_per_MPa.value for plant in found.plants] == pytest.approx(slopes, rel=0.03)
    assert [plant.rises for plant in found.plants] == [True] * 10 + [False] * 10


def test_a_slow_ramp_between_holds_is_a_step_too() -> None:
    t, u = staircase()
    ramped = np.convolve(np.concatenate([np.full(29, u[0]), u]), np.ones(30) / 30, mode="valid")
    found = identify(t, ramped, 300 * response(t, ramped, 0.15, 0.05))
    assert [plant.lag_s.value for plant in found.plants] == pytest.approx([0.15] * 20, rel=0.02)


def test_a_sweep_gives_the_slopes_of_its_curve() -> None:
    t = np.arange(0, 30, DT)
    u = 0.15 * (1 - np.cos(2 * np.pi * 0.2 * t))
    x = response(t, u, 0.2, 0.06)
    found = identify(t, u, 500 * x - 600 * x**2 + np.random.default_rng(2).normal(0, 0.2, len(t)))
    assert found.method == "sweep" and len(found.plants) == 3
    for plant in found.plants:
        assert plant.lag_s.value == pytest.approx(0.2, rel=0.15) and plant.dead_time_s.value == pytest.approx(
            0.06, abs=0.03
        )
        assert plant.gain_deg_per_MPa.value == pytest.approx(500 - 1200 * plant.pressure_MPa, rel=0.02)


def test_gains_are_tuned_for_the_cautious_ends_of_the_intervals() -> None:
    """A sine hardly tells lag from dead time; what it leaves open must not become a gain."""
    t = np.arange(0, 40, DT)
    u = 0.15 * (1 - np.cos(2 * np.pi * 0.4 * t))
    lag, dead, gain = 0.05, 0.04, 300.0
    for seed in range(5):
        angle = gain * response(t, u, lag, dead) + np.random.default_rng(seed).normal(0, 0.3, len(t))
        plants = identify(t, u, angle).plants
        for plant in plants:
            assert plant.cautious.dead_time_s >= plant.dead_time_s.value
        tuned = tune([plant.cautious for plant in plants], 100)
        true = margins(tuned.kp_MPa_per_deg, tuned.ki_MPa_per_deg_s, Lag(gain, lag, dead + 0.015))
        assert true.stable and true.max_sensitivity < 1.6


def test_missing_angles_are_left_out() -> None:
    t, u = staircase()
    angle = 300 * response(t, u, 0.15, 0.05)
    angle[::7] = np.nan
    assert identify(t, u, angle).plants[3].lag_s.value == pytest.approx(0.15, rel=0.01)


def test_large_steps_and_noise_are_left_out_with_the_reason() -> None:
    t, u = staircase(steps=2, step_MPa=0.15)
    with pytest.raises(InputError, match=r"no plant found: 0 to 0\.15 MPa at .* larger than 0\.1 MPa.*and 3 more"):
        identify(t, u, 300 * u)
    t, u = staircase()
    with pytest.raises(InputError, match="no plant found"):
        identify(t, u, np.random.default_rng(0).normal(0, 1, len(t)))
    with pytest.raises(InputError, match="too few to identify from"):
        identify(t, np.full(len(t), 0.1), u)


def test_pressure_that_unbends_is_no_plant() -> None:
    t, u = staircase()
    with pytest.raises(InputError, match="not surely above 0"):
        identify(t, u, -300 * response(t, u, 0.1, 0.02))


def test_holds_are_found_with_uneven_times() -> None:
    holds = find_holds(np.array([0.0, 0.5, 1.5, 1.6, 3.0]), np.array([0.1, 0.1, 0.1, 0.2, 0.2]), 1.4)
    assert [(h.first, h.last) for h in holds] == [(0, 2), (3, 4)]
    assert find_holds(np.array([]), np.array([]), 1.0) == []
