"""Drawings read back by other programs' libraries (ezdxf, fontTools) and measured."""

import json
import math
import xml.etree.ElementTree as ET
from itertools import pairwise
from pathlib import Path

import ezdxf
import pytest
from ezdxf.bbox import extents
from ezdxf.math import area
from ezdxf.path import make_path
from fontTools.pens.areaPen import AreaPen
from fontTools.svgLib.path import parse_path

from benchlab.actuator import ShellDesign
from benchlab.cutting.layout import LAYERS, CutSheet, lay_out
from benchlab.cutting.settings import CutSettings
from benchlab.errors import InputError, UsageError
from benchlab.io.cut_file import COLOURS, write_cut

WIDE = ShellDesign(10, 9)
ROUNDED = CutSettings(cap_mm=10, kerf_mm=0.2, corner_radius_mm=0.6)
SVG = "{http://www.w3.org/2000/svg}"
ABOUT = {"program": "benchlab", "note": "<&>" * 200}


def sheet(settings: CutSettings = ROUNDED, design: ShellDesign = WIDE) -> CutSheet:
    return lay_out(design, settings)


def dxf_of(path: Path, drawn: CutSheet) -> ezdxf.document.Drawing:
    write_cut(path, drawn, "A title", ABOUT)
    document = ezdxf.readfile(path)
    assert not document.audit().errors
    return document


def areas_by_layer(document: ezdxf.document.Drawing) -> dict[str, list[float]]:
    found: dict[str, list[float]] = {}
    for entity in document.modelspace():
        if entity.dxf.layer != "ENGRAVE":
            found.setdefault(entity.dxf.layer, []).append(area(make_path(entity).flattening(1e-5)))
    return found


def test_dxf_is_in_mm_with_a_layer_for_each_way_of_cutting(tmp_path: Path) -> None:
    document = dxf_of(tmp_path / "a.dxf", sheet())
    assert document.units == ezdxf.units.MM and document.header["$INSUNITS"] == 4
    for layer in LAYERS:
        assert document.layers.get(layer).color == COLOURS[layer][0]
    assert len({COLOURS[layer] for layer in LAYERS}) == len(LAYERS)
    entities = list(document.modelspace())
    assert {e.dxf.layer for e in entities} == set(LAYERS)
    order = [LAYERS.index(e.dxf.layer) for e in entities]
    assert order == sorted(order)
    for entity in entities:
        assert entity.dxf.color == 256  # by layer
        if entity.dxf.layer.endswith("_CUT"):
            assert entity.dxftype() == "LWPOLYLINE" and entity.closed
        elif entity.dxf.layer == "HOLES":
            assert entity.dxftype() == "CIRCLE" and entity.dxf.radius == pytest.approx(0.9)


def test_dxf_measures_what_was_designed(tmp_path: Path) -> None:
    areas = areas_by_layer(dxf_of(tmp_path / "a.dxf", sheet()))
    length = 180 + 2 * 10 + 2 * 6 + 0.2
    assert len(areas["FABRIC_CUT"]) == 17 and len(areas["FILM_CUT"]) == len(areas["STRIP_CUT"]) == 1
    window = (9 - 0.2) * (30 - 0.2) - (4 - math.pi) * 0.5**2
    assert areas["FABRIC_CUT"][:16] == pytest.approx([window] * 16, abs=1e-3)
    assert [areas["FABRIC_CUT"][16], *areas["FILM_CUT"]] == pytest.approx([length * 40.2] * 2)
    assert areas["STRIP_CUT"][0] == pytest.approx(length * 10.2 + 2 * (6 + 0.2) * (12 - 10))
    assert areas["HOLES"] == pytest.approx([math.pi * 0.9**2] * 12, rel=1e-3)


def test_dxf_windows_and_holes_stand_where_they_should(tmp_path: Path) -> None:
    document = dxf_of(tmp_path / "a.dxf", sheet(CutSettings(), ShellDesign(10, 3)))
    boxes = [extents([e]) for e in document.modelspace().query("LWPOLYLINE[layer=='FABRIC_CUT']")]
    *windows, outer = sorted(boxes, key=lambda box: box.size.x)
    assert len(windows) == 35
    windows.sort(key=lambda box: box.extmin.x)
    for window in windows:
        assert (window.size.x, window.size.y) == pytest.approx((3, 30))
    ribs = [b.extmin.x - a.extmax.x for a, b in pairwise(windows)]
    assert ribs == pytest.approx([2] * 34)
    # al = 35 windows of 3, 36 ribs of 2 and 3 mm left over; a tab of 6 mm at either end.
    assert windows[0].extmin.x - outer.extmin.x == pytest.approx(6 + 1.5 + 2)
    assert outer.extmax.x - windows[-1].extmax.x == pytest.approx(6 + 1.5 + 2)
    x = [round(hole.dxf.center.x, 6) for hole in document.modelspace().query("CIRCLE")]
    assert len(x) == 12 and len(set(x)) == 2
    y = sorted(hole.dxf.center.y for hole in document.modelspace().query("CIRCLE"))[::2]
    fabric, film, strip = y[5] - y[4], y[3] - y[2], y[1] - y[0]
    assert fabric == film == pytest.approx(40 - 2 * 3) and fabric + strip == pytest.approx(40)  # the perimeter


def test_dxf_keeps_what_it_was_made_from(tmp_path: Path) -> None:
    document = dxf_of(tmp_path / "a.dxf", sheet())
    record = document.rootdict["BENCHLAB"]
    title, *chunks = [tag.value for tag in record.tags]
    assert title == "A title" and json.loads("".join(chunks)) == ABOUT


def test_svg_has_true_size_and_the_same_shapes_as_dxf(tmp_path: Path) -> None:
    drawn = sheet()
    write_cut(tmp_path / "a.svg", drawn, "A <title>", ABOUT)
    root = ET.parse(tmp_path / "a.svg").getroot()
    assert root.tag == f"{SVG}svg"
    size = [float(root.attrib[side].removesuffix("mm")) for side in ("width", "height")]
    assert size == pytest.approx([drawn.width_mm, drawn.height_mm], abs=1e-4)
    assert [float(n) for n in root.attrib["viewBox"].split()] == [0, 0, *size]
    assert root.findtext(f"{SVG}title") == "A <title>" and json.loads(root.findtext(f"{SVG}desc") or "") == ABOUT
    groups = root.findall(f"{SVG}g")
    assert [g.attrib["id"] for g in groups] == list(LAYERS)
    expected = areas_by_layer(dxf_of(tmp_path / "a.dxf", drawn))
    for group in groups:
        assert group.attrib["stroke"] == COLOURS[group.attrib["id"]][1] and group.attrib["fill"] == "none"
        assert float(group.attrib["stroke-width"]) < 0.025
        if group.attrib["id"].endswith("_CUT"):
            areas = [svg_area(element.attrib["d"]) for element in group]
            assert areas == pytest.approx(expected[group.attrib["id"]], rel=1e-4)
    assert [float(hole.attrib["r"]) for hole in groups[1]] == [0.9] * 12


def svg_area(d: str) -> float:
    assert d.endswith("Z")
    pen = AreaPen()
    parse_path(d, pen)
    return pen.value * -1  # y runs downwards


def test_svg_is_the_dxf_upside_down(tmp_path: Path) -> None:
    drawn = sheet(CutSettings(hole_mm=1.5), ShellDesign(7, 3))
    write_cut(tmp_path / "a.svg", drawn, "", {})
    root = ET.parse(tmp_path / "a.svg").getroot()
    svg = [(float(c.attrib["cx"]), drawn.height_mm - float(c.attrib["cy"])) for c in root.iter(f"{SVG}circle")]
    document = dxf_of(tmp_path / "a.dxf", drawn)
    dxf = [(c.dxf.center.x, c.dxf.center.y) for c in document.modelspace().query("CIRCLE")]
    assert [n for pair in svg for n in pair] == pytest.approx([n for pair in dxf for n in pair], abs=1e-4)


def test_names_that_cannot_be_written(tmp_path: Path) -> None:
    for name in ("a.pdf", "a", "a.dxf.gz"):
        with pytest.raises(UsageError, match=r"\.dxf or \.svg"):
            write_cut(tmp_path / name, sheet(), "", {})
    with pytest.raises(InputError, match="cannot write"):
        write_cut(tmp_path / "none" / "of" / "a.dxf", sheet(), "", {})
    assert not list(tmp_path.iterdir())
    write_cut(tmp_path / "A.DXF", sheet(), "", {})
    assert ezdxf.readfile(tmp_path / "A.DXF").dxfversion == "AC1015"
