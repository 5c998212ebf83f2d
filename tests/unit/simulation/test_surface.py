"""The deformed surface: closed, joined, of the right volume, length and angle."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.actuator import ShellDesign, tip_position_mm
from benchlab.simulation.actuator_response import ActuatorResponse, actuator_response
from benchlab.simulation.deformed import extremes, layer_stresses
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup
from benchlab.simulation.surface import whole_actuator, whole_cell

DESIGN = ShellDesign(strip_width_mm=10, window_width_mm=9)


@pytest.fixture(scope="module")
def response() -> ActuatorResponse:
    layup = Layup("test", "guessed", film=Polynomial(C10=1.5, C20=3.0))
    return actuator_response(DESIGN, layup, [0.1, 0.25], blocked=False)


def test_volume_inside_the_drawn_cell_is_the_cells_to_second_order(response):
    for point in response.free.points:
        true = response.cell.volume_mm3(point.state)
        errors = [
            whole_cell(response.cell, point.state, n, response.cell.inner_mm).volume_mm3 / true - 1 for n in (4, 8, 16)
        ]
        assert abs(errors[-1]) < 2e-4
        assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([2, 2], abs=0.1)


def test_volume_of_the_round_tube():
    layup = Layup("test", "guessed", film=Polynomial(C10=1.5))
    cell = actuator_response(DESIGN, layup, [0.01], blocked=False).cell
    surface = whole_cell(cell, cell.round_tube(), 16)
    assert surface.volume_mm3 == pytest.approx(np.pi * cell.radius_mm**2 * 11, rel=1e-4)
    assert surface.stretch[np.isfinite(surface.stretch)] == pytest.approx(1, abs=0.01)  # circles by quadratics


def test_the_cell_is_symmetric_and_its_pieces_are_where_they_were_cut(response):
    surface = whole_cell(response.cell, response.free.points[-1].state, 4)
    points = surface.points_mm
    assert points[::-1] * [1, -1, 1] == pytest.approx(points, abs=1e-12)
    assert points[0] == pytest.approx(points[-1], abs=1e-9)
    assert points[:, ::-1] * [1, 1, -1] == pytest.approx(points, abs=1e-9)
    middle = surface.piece[len(surface.piece) // 2]
    assert set(middle) == {"strip"}
    opposite = surface.piece[0]
    assert opposite[0] == opposite[-1] == "film" and opposite[len(opposite) // 2] == "rib"
    assert set(np.unique(surface.piece)) == {"film", "rib", "strip"}


def test_film_is_most_stretched_where_the_integration_points_say(response):
    point = response.free.points[-1]
    found = np.nanmax(whole_cell(response.cell, point.state, 5).stretch)
    at_points = extremes(layer_stresses(response.cell, point.state)).film_stretch
    assert found == pytest.approx(at_points, rel=0.01)


@pytest.mark.parametrize("cap_mm", [0.0, 12.0])
def test_the_actuator_is_joined_and_ends_where_constant_curvature_says(response, cap_mm):
    state = response.free.points[-1].state
    surface = whole_actuator(response.cell, state, DESIGN, cap_mm)
    bent = DESIGN.length_mm - 2 * cap_mm
    theta = state.k * bent
    strip = surface.points_mm[len(surface.points_mm) // 2]  # near x = 0 all along
    steps = np.linalg.norm(np.diff(strip, axis=0), axis=1)
    assert steps.sum() == pytest.approx(state.lam * bent + 2 * cap_mm, rel=0.02)
    inner = slice(2, -2) if cap_mm else slice(None)
    start, end = surface.points_mm[:, inner][:, 0], surface.points_mm[:, inner][:, -1]
    # both end sections are plane, the last turned by θ about the centre of bending
    normal = np.array([-np.sin(theta), 0, np.cos(theta)])
    assert start[:, 2] == pytest.approx(np.zeros(len(start)), abs=1e-9)
    assert np.ptp(end @ normal) < 1e-9
    towards, along = tip_position_mm(np.array(theta), state.lam * bent)
    origin = end[len(end) // 2] - start[len(start) // 2][0] * np.array([np.cos(theta), 0, np.sin(theta)])
    assert origin[[0, 2]] == pytest.approx([-towards, along], abs=1e-6)
    if cap_mm:
        assert set(surface.piece[:, 0]) == set(surface.piece[:, -1]) == {"cap"}
        assert np.ptp(surface.points_mm[:, -1] @ normal) < 1e-9


def test_whole_windows_are_drawn(response):
    surface = whole_actuator(response.cell, response.free.points[0].state, DESIGN)
    along = surface.piece[0]
    windows = np.count_nonzero((along[1:] == "film") & (along[:-1] != "film"))
    assert windows == DESIGN.whole_windows == 16
    assert along[0] == along[-1] == "rib"
    quarter = whole_actuator(response.cell, response.free.points[0].state, DESIGN, per_element=4)
    assert quarter.points_mm.shape[0] == 2 * (surface.points_mm.shape[0] - 1) + 1
