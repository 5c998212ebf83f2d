"""The cell as a whole: derivatives against differences, tubes with closed forms, invariance."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import fsolve

from benchlab.actuator import ShellDesign
from benchlab.simulation.cell import Cell, State
from benchlab.simulation.laws import Polynomial, StVenantKirchhoff
from benchlab.simulation.layup import Layup
from benchlab.simulation.newton import minimise
from benchlab.simulation.response import follow, hold
from tests.unit.simulation.cells import HALF_LENGTH, R, dense, shaken, uniform_tube

LAYUP = Layup("test", "guessed", film=Polynomial(C10=1.5, C20=3.0), weld_width_mm=1.0)
DESIGN = ShellDesign(strip_width_mm=10, window_width_mm=3)


def test_gradient_and_hessian_are_those_of_the_potential():
    cell = Cell.of(DESIGN, LAYUP)
    state, move = shaken(cell), shaken(cell, seed=2)
    direction = np.where(cell.held, 0, move.fields - cell.round_tube().fields)
    dk, dlam, step, pressure = 1e-3, 0.1, 1e-5, 0.2

    def at(e):
        return cell.potential(State(state.fields + e * direction, state.k + e * dk, state.lam + e * dlam), pressure)

    here, up, down = at(0.0), at(step), at(-step)
    slope = here.gradient @ direction + here.border_gradient @ [dk, dlam]
    assert (up.value - down.value) / (2 * step) == pytest.approx(slope, rel=1e-6)
    change = dense(here.band) @ direction + here.coupling @ [dk, dlam]
    change[cell.held] = 0
    found = (up.gradient - down.gradient) / (2 * step)
    assert np.abs(found - change).max() < 1e-7 * np.abs(found).max()
    border = here.coupling.T @ direction + here.border @ [dk, dlam]
    assert (up.border_gradient - down.border_gradient) / (2 * step) == pytest.approx(border, rel=1e-6)


def test_volume_of_the_round_tube_is_that_inside_the_film():
    cell = Cell.of(DESIGN, LAYUP)
    inner = 40 / (2 * np.pi) - 0.15
    assert cell.volume_mm3(cell.round_tube()) == pytest.approx(np.pi * inner**2 * 5, rel=2e-4)


def test_moment_of_a_bent_elastic_tube_is_that_of_the_beam():
    # M = E I k with I = π (R_o⁴ − R_i⁴)/4; the wall is thin, the curvature small, and the section free to deform.
    h, k = 0.05, 1e-6
    cell = uniform_tube(StVenantKirchhoff(498.0, 0.35), h, around=12)
    start = replace(cell.round_tube(), k=k)
    solved = minimise(lambda at: cell.potential(at, 0.0), start, free=(False, True))
    moment = 2 * solved.potential.border_gradient[0] / HALF_LENGTH
    inertia = np.pi / 4 * ((R + h / 2) ** 4 - (R - h / 2) ** 4)
    assert solved.converged
    assert moment == pytest.approx(498.0 * inertia * k, rel=1e-3)


def thick_cylinder(C10, thickness, pressure):
    """Inner radius and axial stretch of a closed Neo-Hookean cylinder under internal pressure (Rivlin 1949), exact."""
    A, B = R - thickness / 2, R + thickness / 2

    def residual(unknown):
        a, lam = unknown
        b = np.sqrt(a**2 + (B**2 - A**2) / lam)

        def hoop_minus_radial(r):
            reference = np.sqrt(A**2 + lam * (r**2 - a**2))
            around = r / reference
            return 2 * C10 * (around**2 - 1 / (around * lam) ** 2)

        def axial(r):
            reference = np.sqrt(A**2 + lam * (r**2 - a**2))
            around = r / reference
            radial = -quad(lambda x: hoop_minus_radial(x) / x, r, b)[0]
            return (radial + 2 * C10 * (lam**2 - 1 / (around * lam) ** 2)) * 2 * np.pi * r

        inside = quad(lambda r: hoop_minus_radial(r) / r, a, b)[0]
        return [inside - pressure, quad(axial, a, b)[0] / (np.pi * a**2) - pressure]

    return fsolve(residual, (A * 1.05, 1.0), xtol=1e-12)


@pytest.mark.parametrize("pressure", [0.02, 0.06])
def test_an_inflated_cylinder_is_that_of_rivlin(pressure):
    thickness, C10 = 0.3, 1.5
    path = follow(uniform_tube(Polynomial(C10=C10), thickness), [pressure])
    cell, state = uniform_tube(Polynomial(C10=C10), thickness), path.points[0].state
    inner, lam = thick_cylinder(C10, thickness, pressure)
    length = 2 * HALF_LENGTH * lam
    volume = np.pi * inner**2 * length
    assert state.k == pytest.approx(0, abs=1e-9)
    assert inner > 1.01 * (R - thickness / 2)
    # The round tube of nine-node elements encloses a little less than a circle.
    round_off = cell.volume_mm3(cell.round_tube()) / (np.pi * (R - thickness / 2) ** 2 * 2 * HALF_LENGTH)
    assert cell.volume_mm3(state) / round_off == pytest.approx(volume, rel=1e-3)
    # With caps a tube keeps its length nearly: the axial stretch is far smaller than the one around.
    assert state.lam - state.k == pytest.approx(lam, abs=3e-4)


def test_the_moment_is_the_derivative_of_the_least_potential():
    cell, pressure, k, step = Cell.of(DESIGN, LAYUP), 0.2, 0.004, 1e-5

    free = follow(cell, [0.1, pressure]).points[-1]
    held = hold(cell, free, k)

    def least(at):
        start = replace(held.state, k=at)
        return minimise(lambda state: cell.potential(state, pressure), start, free=(False, True)).potential.value

    slope = (8 * (least(k + step) - least(k - step)) - (least(k + 2 * step) - least(k - 2 * step))) / (12 * step)
    assert held.moment_Nmm == pytest.approx(-2 * slope / cell.half_length_mm, rel=1e-6)


def test_energy_and_moment_converge_with_the_fourth_order():
    # Quadratic elements: errors of the energy fall 16 times when elements halve, where nothing jumps.
    found = []
    for around in (8, 16, 32):
        cell = uniform_tube(Polynomial(C10=1.5, C20=3.0), 0.3, around=around, along=1)
        start = replace(cell.round_tube(), k=0.01)
        solved = minimise(lambda at, cell=cell: cell.potential(at, 0.05), start, free=(False, True), most_steps=60)
        found.append((solved.potential.value, solved.potential.border_gradient[0]))
    first, second = np.diff(np.array(found), axis=0)
    assert np.log2(first / second) == pytest.approx(4, abs=0.3)


def test_lengths_and_moduli_have_no_scale():
    # All lengths times 3, moduli and pressure times 7: the same angle of a cell.
    small = Cell.of(DESIGN, LAYUP)
    design = ShellDesign(30, 9, rib_width_mm=6, perimeter_mm=120, length_mm=540)
    layup = Layup(
        "big",
        "scaled",
        Polynomial(C10=10.5, C20=21.0),
        StVenantKirchhoff(7 * 498.0, 0.35),
        0.9,
        0.9,
        0.9,
        weld_width_mm=3.0,
    )
    big = Cell.of(design, layup)
    one = follow(small, [0.1, 0.3]).points[-1].state
    two = follow(big, [0.7, 2.1]).points[-1].state
    assert len(small.mesh.elements) == len(big.mesh.elements)
    assert two.k * 3 == pytest.approx(one.k, rel=1e-7)
    assert two.lam == pytest.approx(one.lam, rel=1e-8)


def test_further_energies_enter_as_terms():
    # A spring on the bending, ½ c k² for the quarter cell, takes the moment that it should from the free cell.
    stiffness = 400.0

    def spring(k, lam):
        return 0.5 * stiffness * k**2, np.array([stiffness * k, 0.0]), np.diag([stiffness, 0.0])

    with_spring = Cell.of(DESIGN, LAYUP, terms=[spring])
    state = follow(with_spring, [0.1, 0.2]).points[-1].state
    plain = Cell.of(DESIGN, LAYUP)
    held = hold(plain, follow(plain, [0.1, 0.2]).points[-1], state.k)
    assert held.moment_Nmm == pytest.approx(2 * stiffness * state.k / plain.half_length_mm, rel=1e-6)


@pytest.mark.parametrize("window, strip", [(3, 10), (1, 10), (3, 30)])
def test_the_default_mesh_gives_the_angle_of_a_finer_one(window, strip):
    design = ShellDesign(strip, window)
    coarse, fine = (follow(Cell.of(design, LAYUP, refine=n), [0.05, 0.2, 0.35]).points[-1] for n in (1, 2))
    assert coarse.state.k == pytest.approx(fine.state.k, rel=5e-3, abs=np.radians(0.05) / 180)
