"""The parts of any design: areas by Eq 6, symmetry, holes that meet, and what cannot be cut."""

import math
from itertools import pairwise

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from benchlab.actuator import ShellDesign
from benchlab.cutting.outline import rectangle
from benchlab.cutting.parts import Part, cut_parts
from benchlab.cutting.settings import CutSettings
from benchlab.errors import UsageError

PAPER = ShellDesign(10, 3)


@st.composite
def designs(draw: st.DrawFn) -> ShellDesign:
    perimeter = draw(st.floats(20, 120))
    rib = draw(st.floats(0.5, 10))
    length = draw(st.floats(40, 400))
    return ShellDesign(
        strip_width_mm=draw(st.floats(0.05, 0.95)) * perimeter,
        window_width_mm=draw(st.floats(0.5, length - 2 * rib)),
        rib_width_mm=rib,
        perimeter_mm=perimeter,
        length_mm=length,
    )


@settings(max_examples=60)
@given(designs())
def test_windows_have_the_area_of_eq_6_with_whole_windows(design: ShellDesign) -> None:
    fabric, film, strip = cut_parts(design, CutSettings())
    n = math.floor((design.length_mm - design.rib_width_mm) / (design.window_width_mm + design.rib_width_mm) + 1e-9)
    wl = design.perimeter_mm - design.strip_width_mm
    assert len(fabric.windows) == n and not film.windows and not strip.windows
    assert sum(w.area_mm2 for w in fabric.windows) == pytest.approx(n * wl * design.window_width_mm)


@settings(max_examples=60)
@given(designs(), st.floats(0, 0.4))
def test_windows_lie_in_the_middle_with_ribs_between(design: ShellDesign, kerf: float) -> None:
    boxes = [w.box_mm for w in cut_parts(design, CutSettings(kerf_mm=kerf))[0].windows]
    assert boxes[0][0] == pytest.approx(-boxes[-1][2]) and boxes[0][1] == pytest.approx(-boxes[0][3])
    for left, right in pairwise(boxes):
        assert right[0] - left[2] - kerf == pytest.approx(design.rib_width_mm)
    margin = boxes[0][0] - kerf / 2 + design.length_mm / 2
    assert margin == pytest.approx(design.rib_width_mm + design.end_margin_mm, abs=1e-6)
    assert margin < design.rib_width_mm + (design.window_width_mm + design.rib_width_mm) / 2


@settings(max_examples=60)
@given(designs(), st.floats(0.05, 1), st.floats(0.5, 4), st.floats(0, 20), st.floats(0, 0.4))
def test_pins_go_through_all_parts_outside_of_the_pressurised_length(
    design: ShellDesign, weld: float, hole: float, cap: float, kerf: float
) -> None:
    weld *= design.strip_width_mm / 2
    assume(6 * hole <= design.window_length_mm + 2 * weld)
    fabric, film, strip = cut_parts(design, CutSettings(weld, cap, hole, kerf))
    assert fabric.holes == film.holes and len(strip.holes) == 4
    assert fabric.outer == film.outer and fabric.size_mm[0] == strip.size_mm[0]
    sheet_edge = fabric.size_mm[1] / 2
    for on_sheet, on_strip in zip(fabric.holes, strip.holes):
        (x, y), (u, v) = on_sheet.centre_mm, on_strip.centre_mm
        assert x == u and on_sheet.diameter_mm == on_strip.diameter_mm == pytest.approx(hole - kerf)
        # The sheet's long edge lies `weld` inside the edge of the strip, on either side of its middle line.
        assert sheet_edge - abs(y) + design.strip_width_mm / 2 - weld == pytest.approx(abs(v))
        assert abs(x) - hole / 2 >= design.length_mm / 2 + cap + hole - 1e-9
        for part in (fabric, strip):
            assert_inside(part, hole)
    assert strip.size_mm[1] <= design.perimeter_mm + 1e-9


def assert_inside(part: Part, hole: float) -> None:
    """A diameter of material stays around each hole."""
    length, width = part.size_mm
    for circle in part.holes:
        x, y = circle.centre_mm
        assert abs(x) + 1.5 * hole <= length / 2 + 1e-9 and abs(y) + 1.5 * hole <= width / 2 + 1e-9


@settings(max_examples=60)
@given(designs(), st.floats(0, 0.4), st.floats(0, 3))
def test_kerf_is_taken_out_by_the_beam(design: ShellDesign, kerf: float, hole: float) -> None:
    """A beam of width kerf along the drawn contours leaves the sizes of the design: offset by k/2, area changes by L·k/2 + O(k²)."""
    assume(hole == 0 or kerf < hole)
    plain = cut_parts(design, CutSettings(hole_mm=hole)) if 6 * hole < design.perimeter_mm else None
    assume(plain is not None)
    drawn = cut_parts(design, CutSettings(hole_mm=hole, kerf_mm=kerf))
    for wanted, part in zip(plain, drawn):
        assert wanted.size_mm == part.size_mm
        # Rectilinear contours with the same corners: area of the offset is A + L·k/2 + 4 (k/2)².
        grown = wanted.outer.area_mm2 + wanted.outer.length_mm * kerf / 2 + kerf**2
        assert part.outer.area_mm2 == pytest.approx(grown)
        for before, after in zip(wanted.windows, part.windows):
            assert after.area_mm2 == pytest.approx(before.area_mm2 - before.length_mm * kerf / 2 + kerf**2)


def test_rounded_windows() -> None:
    fabric = cut_parts(PAPER, CutSettings(corner_radius_mm=0.5))[0]
    assert fabric.windows[0].area_mm2 == pytest.approx(90 - (4 - math.pi) * 0.25)
    assert fabric.windows[0].length_mm == pytest.approx(66 - 8 * 0.5 + math.pi)
    drawn = cut_parts(PAPER, CutSettings(corner_radius_mm=0.5, kerf_mm=0.2))[0]
    assert drawn.windows[0] == rectangle((fabric.windows[0].box_mm[0] + 1.5, 0), 2.8, 29.8, 0.4)
    slot = rectangle((0, 0), 3, 30, 1.5)
    assert slot.area_mm2 == pytest.approx(27 * 3 + math.pi * 1.5**2)


def test_the_sheet_closes_under_the_strip() -> None:
    fabric, _, strip = cut_parts(PAPER, CutSettings(hole_mm=0))
    assert fabric.size_mm == (180, 40) and strip.size_mm == (180, 10)
    narrow = cut_parts(PAPER, CutSettings(weld_mm=3, cap_mm=15, hole_mm=0))[0]
    assert narrow.size_mm == (210, 36)
    assert cut_parts(PAPER, CutSettings())[0].size_mm == (192, 40)


@pytest.mark.parametrize(
    ("design", "cut", "words"),
    [
        (PAPER, {"kerf_mm": 2}, ["kerf_mm is 2", "rib width fw is 2 mm", "narrower"]),
        (ShellDesign(10, 1), {"kerf_mm": 1.2}, ["kerf_mm is 1.2", "window width tw is 1 mm"]),
        (ShellDesign(0.5, 3), {"kerf_mm": 0.5}, ["kerf_mm is 0.5", "strip width slw"]),
        (ShellDesign(39.5, 3), {"kerf_mm": 0.6}, ["window length wl is 0.5 mm"]),
        (PAPER, {"kerf_mm": 0.5, "hole_mm": 0.4}, ["hole diameter is 0.4 mm"]),
        (PAPER, {"weld_mm": 5.1}, ["weld_mm is 5.1", "at most", "5 mm"]),
        (PAPER, {"weld_mm": 0}, ["weld_mm is 0", "more than 0"]),
        (PAPER, {"hole_mm": 7}, ["hole_mm is 7", "40 mm", "up to 6.67", "with 0"]),
        (PAPER, {"corner_radius_mm": 1.6}, ["corner_radius_mm is 1.6", "3 x 30", "up to 1.5"]),
        (ShellDesign(10, 0.1, 0.1, 40, 5000), {}, ["24999 windows", "10000"]),
        (ShellDesign(10, 1e-300, 1e-300, 40, 1e30), {}, ["rib width fw is 1e-300 mm", "0.1 mm"]),
        (ShellDesign(39.95, 3), {}, ["window length wl is 0.05 mm", "0.1 mm"]),
        (PAPER, {"cap_mm": 5000}, ["10192 mm long", "up to 10000", "--cap-mm"]),
        (ShellDesign(10, 3, 2, 20_000), {}, ["20000 mm long", "perimeter"]),
    ],
)
def test_what_cannot_be_cut(design: ShellDesign, cut: dict[str, float], words: list[str]) -> None:
    with pytest.raises(UsageError) as caught:
        cut_parts(design, CutSettings(**cut))
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize("name", ["weld_mm", "cap_mm", "hole_mm", "kerf_mm", "corner_radius_mm"])
@pytest.mark.parametrize("value", [-0.1, math.nan, math.inf])
def test_settings_are_lengths(name: str, value: float) -> None:
    with pytest.raises(UsageError, match=f"{name} is {value:g}; give a length"):
        CutSettings(**{name: value})
