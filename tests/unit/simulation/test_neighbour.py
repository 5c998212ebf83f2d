"""States found beside a neighbour's are those of the path from the round tube."""

from dataclasses import replace

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.simulation.actuator_response import actuator_response
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup
from benchlab.simulation.neighbour import Neighbour, neighbour_at

LAYUP = Layup("test", "guessed", film=Polynomial(C10=1.5, C20=3.0))
DESIGN = ShellDesign(10, 3)
PRESSURES = [0.0, 0.03, 0.08, 0.15]


@pytest.mark.parametrize(
    "changed", [{"film": Polynomial(C10=0.9, C20=1.8)}, {"bladder_N_per_mm": 2.0}, {"seam_margin_mm": 0.4}]
)
def test_beside_a_neighbour_as_from_the_round_tube(changed):
    # The last has another mesh, so that it is followed from the round tube either way.
    neutral = actuator_response(DESIGN, LAYUP, PRESSURES)
    layup = replace(LAYUP, **changed)
    beside = actuator_response(DESIGN, layup, PRESSURES[::3], beside=neutral)
    alone = actuator_response(DESIGN, layup, PRESSURES[::3])
    assert np.abs(beside.angle_deg - alone.angle_deg).max() < 0.02
    assert beside.moment_Nmm == pytest.approx(alone.moment_Nmm, rel=1e-3, abs=1e-3)
    assert beside.volume_mL == pytest.approx(alone.volume_mL, rel=1e-4)


def test_a_pressure_that_the_neighbour_lacks_is_followed_to():
    neutral = actuator_response(DESIGN, LAYUP, PRESSURES[:3], blocked=False)
    soft = replace(LAYUP, film=Polynomial(C10=1.2, C20=2.4))
    found = actuator_response(DESIGN, soft, [0.08, 0.12], blocked=False, beside=neutral)
    assert found.angle_deg == pytest.approx(
        actuator_response(DESIGN, soft, [0.08, 0.12], blocked=False).angle_deg, abs=1e-3
    )


def test_states_between_neighbours_are_nearly_those_of_the_cell():
    def solved(c10: float) -> Neighbour:
        layup = replace(LAYUP, film=Polynomial(C10=c10, C20=2 * c10))
        found = actuator_response(DESIGN, layup, [0.05, 0.1])
        return Neighbour(found.free, found.held)

    truth = solved(1.4)
    known = {c10: solved(c10) for c10 in (1.2, 1.5, 1.9)}
    line, parabola = neighbour_at(1.4, {c10: known[c10] for c10 in (1.2, 1.5)}), neighbour_at(1.4, known)
    off = [
        abs(found.free.points[1].state.k / truth.free.points[1].state.k - 1)
        for found in (Neighbour(known[1.5].free), line, parabola)
    ]
    assert off[2] < off[1] / 4 < off[0] / 16
    assert parabola.held is not None and parabola.held.points[1].state.k == 0.0
    assert neighbour_at(1.5, known).free.points[0].state.k == pytest.approx(known[1.5].free.points[0].state.k)


def test_states_of_other_meshes_are_no_neighbours():
    plain, seamed = (
        actuator_response(DESIGN, replace(LAYUP, seam_margin_mm=mm), [0.05], blocked=False).free for mm in (0.0, 0.4)
    )
    assert len(plain.points[0].state.fields) != len(seamed.points[0].state.fields)
    assert not neighbour_at(0.8, {0.0: Neighbour(plain), 0.4: Neighbour(seamed)}).free.points
