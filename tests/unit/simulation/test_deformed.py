"""Where a deformed cell is in space, and its stresses, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.simulation.cell import FIELDS, State
from benchlab.simulation.deformed import (
    LayerStress,
    extremes,
    layer_stresses,
    node_positions_mm,
    sheet_stress,
    to_space,
    unstable_share,
)
from benchlab.simulation.laws import Ogden, Polynomial, StVenantKirchhoff
from benchlab.simulation.laws.law import uniaxial_stress_MPa
from benchlab.simulation.response import follow
from tests.unit.simulation.cells import R, uniform_tube


def test_points_lie_on_circles_about_the_centre_of_bending():
    k, lam = 0.02, 1.1
    x, t = np.array([-1.0, 0.0, 7.0])[:, None], np.linspace(0, 150, 20)
    found = to_space(x, np.array(3.0), t, k, lam)
    radius = np.hypot(found[..., 0] + lam / k, found[..., 2])
    assert radius == pytest.approx(np.broadcast_to(lam / k + x, radius.shape), abs=1e-11)
    angle = np.unwrap(np.arctan2(found[..., 2], found[..., 0] + lam / k), axis=-1)
    assert angle == pytest.approx(np.broadcast_to(k * t, angle.shape), abs=1e-12)
    assert (found[..., 1] == 3).all()


def test_straight_is_the_limit_of_bending_without_loss_of_digits():
    x, t = np.array(2.0), np.linspace(0, 100, 7)
    straight = to_space(x, x, t, 0.0, 1.2)
    assert straight == pytest.approx(np.stack([0 * t + 2, 0 * t + 2, 1.2 * t], axis=1), abs=1e-15)
    for k in (1e-16, 1e-9):  # X = x − λ·k·t²/2 to first order, for a point at x = 0
        bent = to_space(0 * x, x, t, k, 1.2)
        assert bent[:, 0] == pytest.approx(-1.2 * k * t**2 / 2, rel=1e-12)


def test_round_tube_stays_a_round_tube_of_the_radius_at_each_height():
    cell = uniform_tube(Polynomial(C10=1.0), 0.3)
    for height in (-0.15, 0.0, 0.2):
        points = node_positions_mm(cell, cell.round_tube(), height)
        assert np.hypot(points[:, 0] - R, points[:, 1]) == pytest.approx(np.full(len(points), R + height), abs=1e-12)
        assert points[:, 2] == pytest.approx(cell.mesh.nodes_mm[:, 1], abs=1e-12)


@pytest.mark.parametrize(
    "law", [Polynomial(C10=0.4, C01=0.1, C20=0.05), Ogden((0.63, 0.0012, -0.01), (1.3, 5.0, -2.0))]
)
def test_pulled_strip_has_the_stress_of_the_tensile_test(law):
    stretch = np.array([0.7, 1.0, 1.5, 2.5])
    found = sheet_stress(law, np.stack([1 / stretch, stretch**2, 0 * stretch], axis=1))
    nominal = uniaxial_stress_MPa(law, stretch)
    assert found.cauchy_MPa[:, 1] == pytest.approx(nominal * stretch, abs=1e-12)
    assert found.piola_MPa[:, 1] == pytest.approx(nominal / stretch, abs=1e-12)
    assert found.cauchy_MPa[:, [0, 2]] == pytest.approx(np.zeros((4, 2)), abs=1e-12)
    assert found.von_mises_MPa == pytest.approx(np.abs(nominal * stretch), abs=1e-12)
    assert found.strain[:, 1] == pytest.approx((stretch**2 - 1) / 2)
    assert found.stretch[:, 0] == pytest.approx(np.maximum(stretch, stretch**-0.5))


def test_stress_of_fabric_is_hookes_where_strains_are_small():
    E, nu = 498.0, 0.35
    strain = 1e-7 * np.array([[3.0, -1.0, 2.0]])
    found = sheet_stress(StVenantKirchhoff(E, nu), np.array([1.0, 1.0, 0.0]) + 2 * strain)
    s, z, sz = strain.T
    hooke = E / (1 - nu**2) * np.stack([s + nu * z, z + nu * s, (1 - nu) * sz], axis=1)
    assert found.piola_MPa == pytest.approx(hooke, rel=1e-6)
    assert found.cauchy_MPa == pytest.approx(hooke, rel=1e-5)


def test_stress_turns_with_the_axes_of_the_sheet():
    # C = Q·diag·Qᵀ: the same sheet described in turned axes; and simple shear, where σ − σ·I is known.
    law, turn = Polynomial(C10=0.7, C01=0.2), 0.4
    Q = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    own = sheet_stress(law, np.array([[1.96, 0.81, 0.0]]))
    C = Q @ np.diag([1.96, 0.81]) @ Q.T
    turned = sheet_stress(law, np.array([[C[0, 0], C[1, 1], C[0, 1]]]))
    s, z, sz = turned.cauchy_MPa[0]
    assert Q.T @ np.array([[s, sz], [sz, z]]) @ Q == pytest.approx(np.diag(own.cauchy_MPa[0, :2]), abs=1e-12)
    assert turned.von_mises_MPa == pytest.approx(own.von_mises_MPa)
    assert turned.stretch == pytest.approx(np.array([[1.4, 0.9]]))


@pytest.mark.parametrize("law", [Polynomial(C10=1.0, C20=0.5), Polynomial(C10=0.8, C01=0.1)])
def test_inflated_tube_carries_the_pressure(law):
    # Closed ends: hoop stress p·r/h and axial stress p·r²/(2·r_m·h) of the deformed tube, r inside and h its thickness; both
    # above the radial stress, −p/2 on the mean over the wall, which the law of a sheet counts from.
    h, pressure = 0.05, 0.012
    cell = uniform_tube(law, h, around=24)
    (point,) = follow(cell, [pressure]).points
    (layer,) = layer_stresses(cell, point.state)
    C = 1 + 2 * layer.sheet.strain[:, :2]
    thickness = h / np.sqrt(C[:, 0] * C[:, 1])
    middle = R * np.sqrt(C[:, 0])
    inner = middle - thickness / 2
    hoop = pressure * inner / thickness + pressure / 2
    axial = pressure * inner**2 / (2 * middle * thickness) + pressure / 2
    weight = cell.mesh.weight_mm2.ravel() / cell.mesh.weight_mm2.sum()
    assert weight @ layer.sheet.cauchy_MPa == pytest.approx([weight @ hoop, weight @ axial, 0], rel=1e-4, abs=1e-4)
    assert layer.sheet.stretch.max() > 1.1  # far from small strains
    assert layer.sheet.cauchy_MPa[:, 0] == pytest.approx(hoop, rel=5e-3)


def test_stretches_of_a_stretched_tube_and_where_they_are():
    cell = uniform_tube(StVenantKirchhoff(), 0.3, around=48)
    tube = cell.round_tube().fields.reshape(-1, FIELDS).copy()
    tube[:, :2] *= 1.05  # wider by 5 %, and longer by 2 %
    (layer,) = layer_stresses(cell, State(tube.ravel(), 0.0, 1.02))
    assert layer.sheet.stretch == pytest.approx(np.tile([1.05, 1.02], (len(layer.places_mm), 1)), abs=2e-4)
    assert layer.places_mm.min() > 0 and layer.places_mm[:, 0].max() < np.pi * R
    found = extremes((layer,))
    assert np.isnan(found.film_stretch) and found.fabric_stress_MPa == layer.sheet.von_mises_MPa.max()


def test_share_of_the_film_where_the_law_is_not_stable():
    # Mooney and Rivlin's law with C01 < 0: the tangent across a sheet stretched both ways, 4·(C10 + λ²·C01)·(λ² + λ⁻⁴) along
    # (1, −1), is lost at λ² = −C10/C01 = 2.
    law = Polynomial(C10=1.0, C01=-0.5)
    squares = np.array([1.0, 1.2, 1.4, 2.1])
    C = np.stack([squares, squares, 0 * squares], axis=1)
    odd = LayerStress("film", law, np.zeros((4, 2)), sheet_stress(law, C))
    fabric = LayerStress("rib", StVenantKirchhoff(), np.zeros((4, 2)), sheet_stress(StVenantKirchhoff(), C))
    assert unstable_share((odd, fabric)) >= 0.25
    firm = Polynomial(C10=1.0)
    assert unstable_share((LayerStress("film", firm, np.zeros((4, 2)), sheet_stress(firm, C)), fabric)) == 0
    assert unstable_share((fabric,)) == 0
