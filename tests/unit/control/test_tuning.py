"""Gains and margins against Skogestad's numbers and closed forms."""

import math

import numpy as np
import pytest

from benchlab.control.tuning import Lag, margins, simc, tune
from benchlab.errors import InputError


@pytest.mark.parametrize(
    ("lag", "dead", "kp", "integral_s"),
    [(1.1, 0.1, 5.5, 0.8), (1.5, 2.5, 0.30, 1.5), (1.1, 0.148, 3.72, 1.1)],
    ids=["E1", "E5", "E4"],
)
def test_skogestads_examples(lag: float, dead: float, kp: float, integral_s: float) -> None:
    """Skogestad 2003, table of examples: PI after the half rule, k = 1, τc = θ."""
    found = simc(Lag(1.0, lag, dead), closed_loop_s=dead)
    assert found[0] == pytest.approx(kp, abs=0.005) and found[0] / found[1] == pytest.approx(integral_s, abs=0.005)


@pytest.mark.parametrize(
    ("plant", "gain_margin", "phase_deg", "sensitivity", "delay"),
    [  # Skogestad 2003, Table 1: first order with τ1 ≤ 8θ, and integrating, τc = θ = 1
        (Lag(2.0, 1.0, 1.0), 3.14, 61.4, 1.59, 2.14),
        (Lag(1e5, 1e5, 1.0), 2.96, 46.9, 1.70, 1.59),
    ],
)
def test_margins_of_simc_as_published(plant, gain_margin, phase_deg, sensitivity, delay) -> None:
    found = margins(*simc(plant, closed_loop_s=1.0), plant)
    assert found.gain_margin == pytest.approx(gain_margin, abs=0.005)
    assert found.phase_margin_deg == pytest.approx(phase_deg, abs=0.05)
    assert found.max_sensitivity == pytest.approx(sensitivity, abs=0.005)
    assert found.delay_margin_s == pytest.approx(delay, abs=0.005)


@pytest.mark.parametrize(("kp", "lag", "dead"), [(2e-3, 0.2, 0.05), (1e-3, 0.1, 0.08), (6e-3, 0.5, 0.01)])
def test_margins_in_closed_form(kp: float, lag: float, dead: float) -> None:
    """With ki = kp/τ the loop is k·exp(−L·s)/s: crossover k, phase margin π/2 − k·L, gain margin π/(2·k·L)."""
    found = margins(kp, kp / lag, Lag(300.0, lag, dead))
    k = kp * 300 / lag
    assert found.crossover_rad_per_s == pytest.approx(k, rel=1e-5)
    assert math.radians(found.phase_margin_deg) == pytest.approx(math.pi / 2 - k * dead, rel=1e-4)
    assert found.gain_margin == pytest.approx(math.pi / (2 * k * dead), rel=1e-4)
    w = np.linspace(1e-3, 10 / dead, 2_000_000)
    assert found.max_sensitivity == pytest.approx(
        np.max(1 / np.abs(1 + k * np.exp(-1j * w * dead) / (1j * w))), rel=1e-4
    )


def test_at_its_gain_margin_a_loop_swings_without_end() -> None:
    """In time: a loop simulated with 0.97 of the gain margin dies out, with 1.03 it grows."""
    plant = Lag(300.0, 0.3, 0.2)
    kp, ki = simc(plant, 0.2)
    factor = margins(kp, ki, plant).gain_margin
    assert (
        _swing(kp * factor * 0.97, ki * factor * 0.97, plant)
        < 1
        < _swing(kp * factor * 1.03, ki * factor * 1.03, plant)
    )


def _swing(kp: float, ki: float, plant: Lag, dt: float = 1e-3) -> float:
    """By what factor the swing grows from the first to the second half of 20 s."""
    late = round(plant.dead_time_s / dt)
    u, y, integral, angle = [0.0] * late, [], 0.0, 0.0
    kept = math.exp(-dt / plant.lag_s)
    for _ in range(round(20 / dt)):
        integral += ki * (1.0 - angle) * dt
        u.append(kp * (1.0 - angle) + integral)
        goal = plant.gain_deg_per_MPa * u[-1 - late]
        angle = goal + (angle - goal) * kept
        y.append(angle - 1)
    half = len(y) // 2
    return float(np.abs(y[half + half // 2 :]).max() / np.abs(y[half // 2 : half]).max())


def test_no_dead_time_has_no_gain_margin() -> None:
    found = margins(1e-3, 1e-2, Lag(300.0, 0.2, 0.0))
    assert math.isinf(found.gain_margin) and found.phase_margin_deg > 0 and found.stable


def test_tuning_is_safe_at_every_operating_point() -> None:
    plants = [Lag(600.0, 0.2, 0.06), Lag(250.0, 0.15, 0.05), Lag(350.0, 0.35, 0.04)]
    found = tune(plants, rate_Hz=100)
    assert all(m.max_sensitivity <= 1.6 and m.stable for m in found.margins)
    assert found.margins[found.worst].max_sensitivity == pytest.approx(1.6, abs=0.005)
    assert found.lead_s == pytest.approx(np.median([0.265, 0.205, 0.395]))
    assert found.margins[found.worst].max_sensitivity == max(m.max_sensitivity for m in found.margins)


def test_one_plant_gets_what_the_rule_says_with_the_loops_own_dead_time() -> None:
    found = tune([Lag(300.0, 0.3, 0.085)], rate_Hz=100, max_sensitivity=1.5905)  # Ms of τc = L, as published
    assert found.closed_loop_s == pytest.approx(0.1, rel=2e-3)
    assert found.kp_MPa_per_deg == pytest.approx(0.3 / (300 * 0.2), rel=2e-3)
    assert found.kp_MPa_per_deg / found.ki_MPa_per_deg_s == pytest.approx(0.3)


def test_the_rule_is_applied_where_it_allows_least() -> None:
    found = tune([Lag(200.0, 0.5, 0.02), Lag(400.0, 0.05, 0.02)], 100)
    assert found.kp_MPa_per_deg / found.ki_MPa_per_deg_s == pytest.approx(0.05)  # the second's lag


def test_a_wished_time_is_kept_or_refused() -> None:
    assert tune([Lag(300.0, 0.3, 0.05)], 100, closed_loop_s=0.5).closed_loop_s == 0.5
    with pytest.raises(InputError, match=r"closed-loop time of 0\.001 s gives Ms"):
        tune([Lag(300.0, 0.3, 0.05)], 100, closed_loop_s=0.001)


@pytest.mark.parametrize(
    ("plant", "named"),
    [(Lag(-3, 0.1, 0.1), "gain above 0"), (Lag(3, 0, 0.1), "lag above 0"), (Lag(3, 0.1, math.nan), "dead time of 0")],
)
def test_what_no_bench_has_cannot_be_tuned(plant: Lag, named: str) -> None:
    with pytest.raises(InputError, match=named):
        tune([Lag(300.0, 0.2, 0.05), plant], 100)
    with pytest.raises(InputError, match="no operating point"):
        tune([], 100)
