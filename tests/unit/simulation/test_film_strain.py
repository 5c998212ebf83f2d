"""Peak strain of the film where the deformation is known."""

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.simulation.cell import FIELDS, Cell, State
from benchlab.simulation.film_strain import peak_film_strain
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup
from benchlab.simulation.shell import X, Y


@pytest.fixture(scope="module")
def cell():
    return Cell.of(ShellDesign(10, 6), Layup("trial", "guessed", film=Polynomial(C10=1.5, C20=3.0)))


def test_a_stretched_tube_is_strained_along(cell):
    tube = cell.round_tube()
    assert peak_film_strain(cell, State(tube.fields, 0.0, 1.3)) == pytest.approx(0.3, abs=2e-3)


def test_a_wider_tube_is_strained_around(cell):
    tube = cell.round_tube()
    fields = tube.fields.reshape(-1, FIELDS).copy()
    fields[:, [X, Y]] *= 1.2
    assert peak_film_strain(cell, State(fields.ravel(), 0.0, 1.0)) == pytest.approx(
        0.2, abs=6e-3
    )  # the tube is made of parabolas


def test_bending_strains_the_far_side_by_its_distance(cell):
    tube = cell.round_tube()
    k = 0.02
    far = tube.fields.reshape(-1, FIELDS)[:, X].max()
    found = peak_film_strain(cell, State(tube.fields, k, 1.0))
    assert found == pytest.approx(k * far, rel=0.03) and found < k * far
    assert np.isfinite(found)
