"""Sheets: nothing overlaps, marks and holes come before contours, letters stay in their place."""

from itertools import combinations, pairwise

import pytest

from benchlab.actuator import ShellDesign
from benchlab.cutting.layout import LAYERS, SPACING_MM, lay_out
from benchlab.cutting.lettering import letters, width_of
from benchlab.cutting.outline import Outline
from benchlab.cutting.settings import CutSettings

CASES = [
    (ShellDesign(10, 3), CutSettings()),
    (ShellDesign(1, 15), CutSettings(kerf_mm=0.3, cap_mm=12)),
    (ShellDesign(30, 3), CutSettings(hole_mm=0)),
    (ShellDesign(5, 4, 2, 20, 12), CutSettings(hole_mm=1)),
]


@pytest.mark.parametrize(("design", "settings"), CASES)
@pytest.mark.parametrize(
    ("sheet", "names"), [("all", "fabric film strip"), ("fabric", "fabric strip"), ("film", "film")]
)
def test_parts_lie_apart_on_the_sheet(design: ShellDesign, settings: CutSettings, sheet: str, names: str) -> None:
    drawn = lay_out(design, settings, sheet)
    assert [part.name for part in drawn.parts] == names.split()
    boxes = [part.outer.box_mm for part in drawn.parts]
    strokes = [(min(x), min(y), max(x), max(y)) for x, y in (zip(*stroke) for stroke in drawn.beside)]
    for a, b in [*combinations(boxes, 2), *((a, b) for a in boxes for b in strokes)]:
        gap = max(a[0] - b[2], b[0] - a[2], a[1] - b[3], b[1] - a[3])
        assert gap >= (SPACING_MM - 1e-9 if b in boxes else 0.5)
    for box in boxes + strokes:
        assert box[0] >= SPACING_MM - 1e-9 and box[2] <= drawn.width_mm - SPACING_MM + 1e-9
        assert box[1] >= 1 and box[3] <= drawn.height_mm - SPACING_MM + 1e-9
    middles = {round((box[0] + box[2]) / 2, 9) for box in boxes}
    assert len(middles) == 1  # equal x is equal place along the actuator


@pytest.mark.parametrize(("design", "settings"), CASES)
def test_the_order_of_cutting(design: ShellDesign, settings: CutSettings) -> None:
    drawn = lay_out(design, settings)
    paths = list(drawn.paths())
    order = [LAYERS.index(layer) for layer, _ in paths]
    assert order == sorted(order)
    areas = [path.area_mm2 for layer, path in paths if layer == "FABRIC_CUT" and isinstance(path, Outline)]
    assert len(areas) == design.whole_windows + 1 and areas[-1] == max(areas)
    assert all(a == pytest.approx(b) for a, b in pairwise(areas[:-1]))


def test_marks_stay_on_the_tab_or_the_waste() -> None:
    fabric = lay_out(ShellDesign(10, 3), CutSettings()).parts[0]
    left, bottom, _, top = fabric.outer.box_mm
    names = [mark for mark in fabric.marks if len(mark) > 2]
    assert names
    for x, y in (point for mark in names for point in mark):
        assert left < x < left + 6 and bottom + 6 <= y <= top - 6


def test_cut_lengths() -> None:
    lengths = lay_out(ShellDesign(10, 3), CutSettings(hole_mm=0)).cut_length_mm()
    assert lengths == pytest.approx({"FABRIC_CUT": 35 * 66 + 440, "FILM_CUT": 440, "STRIP_CUT": 380})


def test_letters_have_their_height_and_place() -> None:
    strokes = letters("HOH", (10, 20), 2.0)
    x = [u for stroke in strokes for u, _ in stroke]
    assert max(x) + min(x) == pytest.approx(20) and max(x) - min(x) == pytest.approx(2 * width_of("HOH"))
    h_x, h_y = zip(*strokes[0])
    assert (min(h_y), max(h_y)) == pytest.approx((19, 21)) and max(h_x) < 10
    turned = letters("HOH", (10, 20), 2.0, 90)
    assert [30 - v for _, v in strokes[0]] == pytest.approx([u for u, _ in turned[0]])
    assert [10 + u for u, _ in strokes[0]] == pytest.approx([v for _, v in turned[0]])
