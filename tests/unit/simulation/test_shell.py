"""The director shell at a point: derivatives against differences, energies against closed forms, frames that do not matter."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from benchlab.simulation import shell
from benchlab.simulation.laws import Polynomial, StVenantKirchhoff
from benchlab.simulation.layup import Layer
from benchlab.simulation.shell import Laminate, potential_density

FILM = Polynomial(C10=1.2, C01=0.4, C20=2.0, C11=0.1, C02=0.05)
FABRIC = StVenantKirchhoff(498.0, 0.35)
RIB = Laminate((Layer("film", FILM, -0.15, 0.15), Layer("rib", FABRIC, 0.15, 0.45)), 0.15)
WINDOW = Laminate((Layer("film", FILM, -0.15, 0.15),))


def points(n=5, seed=0):
    """Fields of a strained, bent sheet at n points, (n, 3, 6)."""
    rng = np.random.default_rng(seed)
    q = 0.1 * rng.standard_normal((n, 3, 6))
    q[:, 0, :2] += (3.0, 2.0)
    q[:, 1] += (0.6, 0.8, 0, 0.1, -0.1, 0)
    q[:, 2] += (0, 0, 1.0, 0, 0, 0)
    q[:, 0, 3:] += (0.8, -0.6, 0)
    return q


def density(variables, laminate=RIB, pressure=0.2):
    """The density as a function of (n, 20): fields, k, λ."""
    q, k, lam = variables[:, :18].reshape(-1, 3, 6), variables[0, 18], variables[0, 19]
    return potential_density(q, k, lam, laminate, pressure, inner_mm=-0.15)


@pytest.mark.parametrize("laminate", [RIB, WINDOW])
def test_gradient_and_hessian_are_those_of_the_energy(laminate):
    q = points()
    at = np.column_stack([q.reshape(-1, 18), np.full(5, 0.01), np.full(5, 1.05)])
    exact = density(at, laminate)
    assert np.allclose(exact.hessian, exact.hessian.transpose(0, 2, 1))
    step = 1e-6
    for i in range(20):
        move = np.zeros(20)
        move[i] = step
        up, down = density(at + move, laminate), density(at - move, laminate)
        assert (up.value - down.value) / (2 * step) == pytest.approx(exact.gradient[:, i], rel=1e-6, abs=1e-6)
        assert (up.gradient - down.gradient) / (2 * step) == pytest.approx(exact.hessian[:, i], rel=1e-5, abs=1e-4)


def flat(stretch_s, stretch_Z, thickness_stretch):
    """Fields of a sheet stretched in its plane, with λ = 1 and k = 0; its director has the length of the thickness."""
    q = np.zeros((1, 3, 6))
    q[0, 1, 1], q[0, 2, 2] = stretch_s, stretch_Z
    q[0, 0, 3] = thickness_stretch
    return q


@pytest.mark.parametrize("stretches", [(1.4, 1.4**-0.5), (1.3, 1.3), (1.5, 1.0)])
def test_stretched_film_has_the_energy_of_its_law(stretches):
    one, two = stretches
    three = 1 / (one * two)
    I1 = one**2 + two**2 + three**2 - 3
    I2 = one**-2 + two**-2 + three**-2 - 3
    W = FILM.C10 * I1 + FILM.C01 * I2 + FILM.C20 * I1**2 + FILM.C11 * I1 * I2 + FILM.C02 * I2**2
    found = potential_density(flat(one, two, three), 0.0, 1.0, WINDOW, 0.0, 0.0)
    assert found.value[0] == pytest.approx(0.3 * W, rel=1e-12)


def test_stress_resultants_of_film_are_nominal_stress_times_thickness():
    # Equibiaxial Neo-Hooke: P = 2·C10·(λ − λ⁻⁵) (Treloar 1975); uniaxial: 2·C10·(λ − λ⁻²) with no force across.
    laminate = Laminate((Layer("film", Polynomial(C10=1.5), -0.15, 0.15),))
    s_force, Z_force = 6 + 1, 12 + 2  # ∂/∂y_s, ∂/∂t_Z
    two = potential_density(flat(1.4, 1.4, 1.4**-2), 0.0, 1.0, laminate, 0.0, 0.0).gradient[0]
    assert two[[s_force, Z_force]] == pytest.approx(0.3 * 3.0 * (1.4 - 1.4**-5), rel=1e-12)
    one = potential_density(flat(1.4**-0.5, 1.4, 1.4**-0.5), 0.0, 1.0, laminate, 0.0, 0.0).gradient[0]
    assert one[Z_force] == pytest.approx(0.3 * 3.0 * (1.4 - 1.4**-2), rel=1e-12)
    assert one[s_force] == pytest.approx(0, abs=1e-12)


def test_the_frame_does_not_matter():
    rng = np.random.default_rng(3)
    v = rng.standard_normal((4, 16)) * 0.1
    v[:, :15] += np.array([[0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0.1, 0, 0, 0, 0]])
    turned = v.copy()
    turned[:, :15] = (v[:, :15].reshape(4, 5, 3) @ Rotation.random(rng=rng).as_matrix()).reshape(4, 15)
    assert shell._strain_energy(turned, RIB)[0] == pytest.approx(shell._strain_energy(v, RIB)[0], rel=1e-12)


def test_the_origin_of_x_does_not_matter():
    # (x, λ) and (x + c, λ − k c) are the same deformation.
    q, k, lam, c = points(), 0.02, 1.1, 0.7
    moved = q.copy()
    moved[:, 0, 0] += c
    here = potential_density(q, k, lam, RIB, 0.2, -0.15)
    there = potential_density(moved, k, lam - k * c, RIB, 0.2, -0.15)
    assert there.value == pytest.approx(here.value, rel=1e-12)


def test_units_do_not_matter():
    q, size = points(), 25.4
    scaled = q.copy()
    scaled[:, 0, :3] *= size  # lengths; the director and slopes of lengths have no unit
    scaled[:, 1:, 3:] /= size
    layers = tuple(Layer(layer.name, layer.law, layer.bottom_mm * size, layer.top_mm * size) for layer in RIB.layers)
    here = potential_density(q, 0.02, 1.1, RIB, 0.2, -0.15)
    there = potential_density(scaled, 0.02 / size, 1.1, Laminate(layers, 0.15 / size), 0.2, -0.15 * size)
    assert there.value == pytest.approx(size * here.value, rel=1e-12)


def test_energy_of_a_rolled_plate():
    # St Venant–Kirchhoff rolled to the radius R: E = z/R + z²/2R² around; energy ½ E'∫E² dz with E' = E/(1−ν²).
    h, R = 0.4, 6.0
    q = np.zeros((1, 3, 6))
    q[0, 1, 1], q[0, 2, 2], q[0, 0, 3], q[0, 1, 4] = 1.0, 1.0, 1.0, 1 / R
    found = potential_density(q, 0.0, 1.0, Laminate((Layer("plate", FABRIC, -h / 2, h / 2),)), 0.0, 0.0)
    plane = 498.0 / (1 - 0.35**2)
    stiffness = plane * h**3 / 12
    assert found.value[0] == pytest.approx(stiffness / (2 * R**2), rel=1e-3)
    assert found.value[0] == pytest.approx(stiffness / (2 * R**2) + plane * h**5 / (640 * R**4), rel=1e-4)


def test_a_crushed_sheet_is_no_state():
    crushed = flat(1.0, 1.0, 1.0)
    crushed[0, 2, 2] = 0.0
    assert np.isnan(potential_density(crushed, 0.0, 1.0, WINDOW, 0.0, 0.0).value[0])
