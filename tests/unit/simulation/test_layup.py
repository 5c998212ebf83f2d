"""Which layers lie where on the sheet."""

import math

import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup, laminate_at, pieces_of

FILM = Polynomial(C10=1.5, C20=3.0)
DESIGN = ShellDesign(strip_width_mm=10, window_width_mm=3)


def names(layup: Layup, s: float, Z: float) -> list[str]:
    return [layer.name for layer in laminate_at(pieces_of(DESIGN, layup), s, Z, layup.stacking)]


def test_window_rib_and_strip():
    layup = Layup("test", "none", FILM)
    assert names(layup, 12.0, 2.0) == ["film"]
    assert names(layup, 12.0, 0.5) == ["film", "rib"]
    assert names(layup, 2.0, 2.0) == ["film", "strip"]
    assert names(layup, 2.0, 0.5) == ["film", "strip"]


def test_a_weld_doubles_the_fabric_at_the_edge_of_the_strip():
    layup = Layup("test", "none", FILM, weld_width_mm=2.0)
    assert names(layup, 2.0, 2.0) == ["film", "strip"]
    assert names(layup, 4.0, 2.0) == ["film", "weld", "strip"]
    assert names(layup, 4.0, 0.5) == ["film", "rib", "strip"]
    assert names(Layup("test", "none", FILM, weld_width_mm=50.0), 0.1, 2.0) == ["film", "weld", "strip"]


def test_the_film_may_end_where_the_fabric_does():
    layup = Layup("test", "none", FILM, film_under_strip=False, weld_width_mm=2.0)
    assert names(layup, 2.0, 2.0) == ["strip"]
    assert names(layup, 4.0, 2.0) == ["film", "weld", "strip"]


def test_a_seam_margin_is_held_by_fabric():
    # The window of 3 mm between ribs of 2 mm is open from Z = 1.5 and s = 5.5 on.
    layup = Layup("test", "none", FILM, seam_margin_mm=0.5)
    assert names(layup, 12.0, 1.4) == ["film", "rib"]
    assert names(layup, 12.0, 1.6) == ["film"]
    assert names(layup, 5.4, 2.0) == ["film", "weld"]
    assert names(layup, 5.6, 2.0) == ["film"]
    assert names(layup, 4.0, 2.0) == ["film", "strip"]
    with pytest.raises(UsageError, match=r"seam_margin_mm is 1\.5 and closes the windows of tw3_slw10"):
        pieces_of(DESIGN, Layup("test", "none", FILM, seam_margin_mm=1.5))


def test_a_bladder_lies_inside_with_its_stiffness():
    layup = Layup("test", "none", FILM, bladder_N_per_mm=0.4)
    assert names(layup, 12.0, 2.0) == ["bladder", "film"]
    assert names(layup, 2.0, 2.0) == ["bladder", "film", "strip"]
    for stacking in ("middle", "outside"):
        bladder, film = laminate_at(pieces_of(DESIGN, layup), 12.0, 2.0, stacking)
        assert (film.bottom_mm, film.top_mm) == pytest.approx((-0.15, 0.15))
        assert 3 * bladder.law.shear_modulus_MPa * bladder.thickness_mm == pytest.approx(0.4)  # E·h, E = 3 mu
    assert bladder.top_mm == pytest.approx(film.bottom_mm)


def test_layers_lie_in_the_middle_or_on_the_film():
    pieces = pieces_of(DESIGN, Layup("test", "none", FILM, fabric_thickness_mm=0.4))
    middle, outside = (laminate_at(pieces, 12.0, 0.5, stacking) for stacking in ("middle", "outside"))
    assert [(layer.bottom_mm, layer.top_mm) for layer in middle] == [(-0.15, 0.15), (-0.2, 0.2)]
    assert [(layer.bottom_mm, round(layer.top_mm, 9)) for layer in outside] == [(-0.15, 0.15), (0.15, 0.55)]


@pytest.mark.parametrize(
    "wrong",
    [
        {"film_thickness_mm": 0.0},
        {"strip_thickness_mm": math.nan},
        {"weld_width_mm": -1.0},
        {"seam_margin_mm": -0.1},
        {"bladder_N_per_mm": math.inf},
    ],
)
def test_impossible_layups(wrong):
    with pytest.raises(UsageError, match=next(iter(wrong))):
        Layup("test", "none", FILM, **wrong)
