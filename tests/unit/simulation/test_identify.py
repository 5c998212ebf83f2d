"""Films identified from angles that a known film gave."""

import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError, UsageError
from benchlab.simulation.identify import AngleModel, Target, identify_film
from benchlab.simulation.laws import Ogden, Polynomial
from benchlab.simulation.layup import Layup

DESIGNS = [ShellDesign(10, 3), ShellDesign(5, 3), ShellDesign(10, 9)]
START = Layup("start", "none", film=Polynomial(C10=0.0, C01=1.5, C20=2.0))


def targets(film):
    bare = [Target(design, 0.3, 0.0) for design in DESIGNS]
    angles = AngleModel(START, bare).angles_deg(film)
    return [Target(design, 0.3, float(angle)) for design, angle in zip(DESIGNS, angles)]


def test_the_film_that_gave_the_angles_is_found():
    found = identify_film(targets(Polynomial(C10=0.0, C01=1.3, C20=2.6)), START, ["C01", "C20"])
    assert found.coefficients_MPa == pytest.approx({"C01": 1.3, "C20": 2.6}, rel=1e-4)
    assert found.rmse_deg < 1e-3
    assert found.coefficients_MPa["C01"] == found.layup.film.C01


def test_what_cannot_be_identified():
    some = [Target(DESIGNS[0], 0.3, 100.0)]
    with pytest.raises(UsageError, match="1 angles for the coefficients C01, C20"):
        identify_film(some, START, ["C01", "C20"])
    with pytest.raises(UsageError, match="polynomial"):
        identify_film(some, Layup("x", "y", film=Ogden((1.0,), (2.0,))), ["C01"])
    soft = Layup("soft", "none", film=Polynomial(C10=0.05))
    with pytest.raises(InputError, match="no stable state"):
        identify_film(some, soft, ["C10"])
