"""Paths under pressure: bursting told at its closed-form pressure, paths that do not depend on their steps."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError
from benchlab.simulation.cell import Cell
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup
from benchlab.simulation.newton import minimise
from benchlab.simulation.response import bending_stiffness_Nmm2, follow, hold
from tests.unit.simulation.cells import R, shaken, uniform_tube

LAYUP = Layup("test", "guessed", film=Polynomial(C10=1.5, C20=3.0))
CELL = Cell.of(ShellDesign(strip_width_mm=10, window_width_mm=3), LAYUP)


def test_a_neo_hookean_tube_bursts_at_its_limit_pressure():
    # A closed thin tube: hoop stress p r/h, axial half of it; p has a maximum over the hoop stretch. Held at the axial
    # stretch that balances the cap. Pressure on the middle surface, thin wall.
    C10, h = 1.0, 0.05

    def axial(hoop):
        # N_axial = p r/2 with p = N_hoop/r: σ_axial λ_a = ½ σ_hoop λ_a; Cauchy stresses 2·C10·(λ² − λ₃²).
        candidates = np.linspace(0.9, 1.6, 70001)
        third = 1 / (hoop * candidates)
        balance = (candidates**2 - third**2) - 0.5 * (hoop**2 - third**2)
        return candidates[np.argmin(np.abs(balance))]

    def pressure(hoop):
        lam = axial(hoop)
        third = 1 / (hoop * lam)
        return 2 * C10 * (hoop**2 - third**2) * h * third / (R * hoop)

    limit = -minimize_scalar(lambda hoop: -pressure(hoop), bounds=(1.05, 2.5), method="bounded").fun
    cell = uniform_tube(Polynomial(C10=C10), h, inner=0.0)
    path = follow(cell, [0.3 * limit, 0.6 * limit, 0.9 * limit, 1.5 * limit])
    assert len(path.points) == 3
    assert path.limit_pressure_MPa <= 1.001 * limit
    assert path.limit_pressure_MPa > limit - 1e-3


def test_the_end_of_a_path_does_not_depend_on_its_steps():
    one = follow(CELL, [0.3]).points[-1].state
    many = follow(CELL, list(np.linspace(0.02, 0.3, 8))).points[-1].state
    assert one.k == pytest.approx(many.k, rel=1e-7)
    assert one.lam == pytest.approx(many.lam, rel=1e-7)


def test_held_at_its_free_curvature_nothing_presses():
    free = follow(CELL, [0.1, 0.2]).points[-1]
    held = hold(CELL, free, 0.5 * free.state.k)
    assert held.moment_Nmm > 10
    back = hold(CELL, free, free.state.k)
    assert back.moment_Nmm == pytest.approx(0, abs=1e-5)


def test_held_straight_by_two_ways():
    straight = follow(CELL, [0.1, 0.2], held_k=0.0).points[-1]
    pushed = hold(CELL, follow(CELL, [0.1, 0.2]).points[-1], 0.0)
    assert straight.moment_Nmm == pytest.approx(pushed.moment_Nmm, rel=1e-7)
    assert straight.state.k == 0.0


def test_bending_stiffness_is_the_slope_of_the_held_moment():
    free, more = follow(CELL, [0.2]).points[0], 1e-5
    slope = (hold(CELL, free, free.state.k - more).moment_Nmm - hold(CELL, free, free.state.k + more).moment_Nmm) / 2e-5
    assert bending_stiffness_Nmm2(CELL, free) == pytest.approx(slope, rel=1e-4)


def test_without_pressure_nothing_bends():
    assert abs(np.degrees(follow(CELL, [0.0]).points[0].state.k * 180)) < 1e-3
    assert abs(follow(CELL, [0.0], held_k=0.0).points[0].moment_Nmm) < 1e-3


def test_newton_goes_down_and_says_when_it_does_not_arrive():
    start = shaken(CELL)
    before = CELL.potential(start, 0.1).value
    few = minimise(lambda at: CELL.potential(at, 0.1), start, most_steps=2)
    assert not few.converged and few.potential.value < before
    solved = minimise(lambda at: CELL.potential(at, 0.1), start, most_steps=80)
    assert solved.converged
    assert np.abs(solved.potential.gradient).max() < 1e-6
    assert np.abs(solved.potential.border_gradient).max() < 1e-6
    assert solved.state.k == pytest.approx(follow(CELL, [0.1]).points[0].state.k, rel=1e-6)


def test_pressures_that_add_up_but_for_rounding_are_no_two_states():
    # 0.0006 + 0.0013 < 0.0019 in floating point: a state between the two would make the next extrapolation wild.
    pressures = [0.0006, 0.0019, 0.0032, 0.005]
    assert pressures[0] + (pressures[1] - pressures[0]) != pressures[1]
    path = follow(CELL, pressures)
    assert path.limit_pressure_MPa is None
    k = [point.state.k for point in path.points]
    assert k == pytest.approx(k[-1] / 0.005 * np.array(pressures), rel=0.02)


def test_a_last_step_that_is_not_looked_at_is_the_same_step():
    start = follow(CELL, [0.09]).points[0].state
    seen, unseen = (minimise(lambda at: CELL.potential(at, 0.1), start, look=look) for look in (True, False))
    assert seen.steps == unseen.steps and (seen.state.fields == unseen.state.fields).all()
    assert seen.state.k == unseen.state.k and unseen.converged


@pytest.mark.parametrize(
    "pressures, said", [([], "no pressure"), ([-0.1], "-0.1"), ([0.1, 0.1], "follows"), ([float("nan")], "nan")]
)
def test_impossible_pressures(pressures, said):
    with pytest.raises(UsageError, match=said):
        follow(CELL, pressures)
