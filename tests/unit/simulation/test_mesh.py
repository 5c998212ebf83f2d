"""The mesh: grid lines through every border, finer beside them, and areas that add up."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchlab.simulation.mesh import Grading, cell_mesh, gradings, grid_lines, on_circle


@given(
    st.lists(st.floats(0.05, 20), min_size=1, max_size=4),
    st.integers(1, 3),
)
def test_grid_lines_pass_through_every_break_and_grow(spans, split):
    breaks = np.concatenate([[0.0], np.cumsum(spans)])
    lines = grid_lines(list(breaks), Grading(1.25, 0.1, 1.8, 2.0), split)
    assert (np.diff(lines) > 0).all()
    assert all(np.isclose(lines, place, rtol=0, atol=1e-9).any() for place in breaks)
    assert lines[0] == 0 and lines[-1] == pytest.approx(breaks[-1], abs=1e-12)


def test_the_first_film_element_is_about_a_third_of_the_thickness():
    lines = grid_lines([0.0, 1.0, 2.5], gradings(40.0, 0.3)[1])
    beside = lines[np.searchsorted(lines, 1.0 - 1e-9) :][:2]
    assert 0.05 < np.diff(beside)[0] < 0.15


def test_splitting_halves_every_element():
    one, two = (grid_lines([0.0, 1.0, 4.0], gradings(40.0, 0.3)[0], n) for n in (1, 2))
    assert two[::2] == pytest.approx(one)
    assert len(two) == 2 * len(one) - 1


def test_shape_functions_interpolate_quadratics_and_weights_add_up():
    mesh = cell_mesh(np.array([0.0, 0.3, 1.0, 2.0]), np.array([0.0, 0.5, 0.7]))
    s, Z = mesh.nodes_mm.T
    values = (1 + 2 * s - 3 * Z + 0.5 * s**2 + s * Z - Z**2 + s**2 * Z**2)[mesh.elements]
    found = np.einsum("eqdn,en->deq", mesh.shape, values)
    where_s = np.einsum("eqn,en->eq", mesh.shape[:, :, 0], s[mesh.elements])
    where_Z = np.einsum("eqn,en->eq", mesh.shape[:, :, 0], Z[mesh.elements])
    assert found[0] == pytest.approx(
        1 + 2 * where_s - 3 * where_Z + 0.5 * where_s**2 + where_s * where_Z - where_Z**2 + where_s**2 * where_Z**2
    )
    assert found[1] == pytest.approx(2 + where_s + where_Z + 2 * where_s * where_Z**2)
    assert found[2] == pytest.approx(-3 + where_s - 2 * where_Z + 2 * where_s**2 * where_Z)
    assert mesh.weight_mm2.sum() == pytest.approx(2.0 * 0.7)


def test_nodes_are_sorted_around_first():
    nodes = cell_mesh(np.array([0.0, 1.0, 3.0]), np.array([0.0, 0.5])).nodes_mm
    assert (np.lexsort(nodes.T[::-1]) == np.arange(len(nodes))).all()


def test_the_drawn_circle_is_not_strained():
    mesh = on_circle(cell_mesh(np.linspace(0, 6 * np.pi, 6), np.array([0.0, 1.0])), 6.0)
    phi = mesh.nodes_mm[mesh.elements, 0] / 6.0
    x, y = -6 * np.cos(phi), 6 * np.sin(phi)
    along = np.hypot(*(np.einsum("eqn,en->eq", mesh.shape[:, :, 1], place) for place in (x, y)))
    assert along == pytest.approx(1.0, abs=1e-12)
    assert mesh.weight_mm2.sum() == pytest.approx(6 * np.pi, rel=1e-3)
