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


def test_layers_lie_in_the_middle_or_on_the_film():
    pieces = pieces_of(DESIGN, Layup("test", "none", FILM, fabric_thickness_mm=0.4))
    middle, outside = (laminate_at(pieces, 12.0, 0.5, stacking) for stacking in ("middle", "outside"))
    assert [(layer.bottom_mm, layer.top_mm) for layer in middle] == [(-0.15, 0.15), (-0.2, 0.2)]
    assert [(layer.bottom_mm, round(layer.top_mm, 9)) for layer in outside] == [(-0.15, 0.15), (0.15, 0.55)]


@pytest.mark.parametrize(
    "wrong", [{"film_thickness_mm": 0.0}, {"strip_thickness_mm": math.nan}, {"weld_width_mm": -1.0}]
)
def test_impossible_layups(wrong):
    with pytest.raises(UsageError, match=next(iter(wrong))):
        Layup("test", "none", FILM, **wrong)
