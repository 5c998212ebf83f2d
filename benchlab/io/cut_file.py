"""Cut sheets as files: DXF (R2000, mm) and SVG (true size), with a layer and a colour for each way of cutting."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import ezdxf
from ezdxf import units
from ezdxf.layouts import Modelspace

from benchlab.cutting.layout import LAYERS, CutSheet
from benchlab.cutting.layout import Path as CutPath
from benchlab.cutting.outline import Circle, Outline, Point
from benchlab.errors import UsageError
from benchlab.io.files import cannot_write, written_whole

COLOURS = {
    "FABRIC_CUT": (1, "#ff0000"),
    "FILM_CUT": (3, "#00ff00"),
    "STRIP_CUT": (6, "#ff00ff"),
    "HOLES": (30, "#ff7f00"),
    "ENGRAVE": (5, "#0000ff"),
}
"""Of each layer: AutoCAD colour index and the same in RGB. Cutters' drivers choose power and speed by pure colours."""

HAIRLINE_MM = 0.01
"""Stroke of an SVG; drivers take what is thinner than 0.025 mm (0.001 inch) for a line to follow."""

RECORD, RECORD_CHARACTERS = "BENCHLAB", 250
"""Key of the title and the facts in a DXF's root dictionary, and how long a text in DXF may be."""

INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
SVG = "http://www.w3.org/2000/svg"


def check_cut_path(path: Path) -> None:
    """Raises UsageError where the extension is not that of a format that can be written."""
    if path.suffix.lower() not in WRITERS:
        raise UsageError(
            f"{path.suffix or 'no extension'!r} is not a format for cutting",
            file=path,
            hint="end the name in .dxf or .svg",
        )


def write_cut(path: Path, sheet: CutSheet, title: str, about: Mapping[str, Any]) -> None:
    """Write a sheet; the extension of `path` says in which format. Whole or not at all.

    title: what the drawing is called. about: the design, settings and program, kept in the file as JSON.
    Raises UsageError for another extension, InputError where the disk refuses.
    """
    check_cut_path(path)
    with written_whole(path) as temporary:
        try:
            WRITERS[path.suffix.lower()](temporary, sheet, title, json.dumps(about))
        except OSError as error:
            raise cannot_write(error, path) from error


def _write_dxf(path: Path, sheet: CutSheet, title: str, about: str) -> None:
    document = ezdxf.new("R2000", units=units.MM)
    document.header["$MEASUREMENT"] = 1
    document.header["$EXTMIN"] = (0.0, 0.0, 0.0)
    document.header["$EXTMAX"] = (sheet.width_mm, sheet.height_mm, 0.0)
    # R2000 has no custom properties; a record in the root dictionary is kept, and is drawn by nobody.
    chunks = [about[i : i + RECORD_CHARACTERS] for i in range(0, len(about), RECORD_CHARACTERS)]
    document.rootdict.add_xrecord(RECORD).reset([(1, title), *((1, chunk) for chunk in chunks)])
    for layer in LAYERS:
        document.layers.add(layer, color=COLOURS[layer][0], lineweight=0)
    space = document.modelspace()
    for layer, path_mm in sheet.paths():
        _add_dxf(space, layer, path_mm)
    document.set_modelspace_vport(sheet.height_mm * 1.1, (sheet.width_mm / 2, sheet.height_mm / 2))
    document.saveas(path)


def _add_dxf(space: Modelspace, layer: str, path: CutPath) -> None:
    attributes = {"layer": layer}
    if isinstance(path, Circle):
        space.add_circle(path.centre_mm, path.diameter_mm / 2, dxfattribs=attributes)
    elif isinstance(path, Outline):
        corners = [(x, y, bulge) for (x, y), bulge in zip(path.points_mm, path.bulges, strict=True)]
        space.add_lwpolyline(corners, format="xyb", close=True, dxfattribs=attributes)
    else:
        space.add_lwpolyline(path, format="xy", dxfattribs=attributes)


def _write_svg(path: Path, sheet: CutSheet, title: str, about: str) -> None:
    ET.register_namespace("", SVG)
    ET.register_namespace("inkscape", INKSCAPE)
    width, height = _number(sheet.width_mm), _number(sheet.height_mm)
    root = ET.Element(
        f"{{{SVG}}}svg", width=f"{width}mm", height=f"{height}mm", viewBox=f"0 0 {width} {height}", version="1.1"
    )
    ET.SubElement(root, f"{{{SVG}}}title").text = title
    ET.SubElement(root, f"{{{SVG}}}desc").text = about
    groups: dict[str, ET.Element] = {}
    for layer, path_mm in sheet.paths():
        if layer not in groups:
            groups[layer] = _group(root, layer)
        groups[layer].append(_svg_of(path_mm, sheet.height_mm))
    ET.indent(root)
    ET.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def _group(root: ET.Element, layer: str) -> ET.Element:
    return ET.SubElement(
        root,
        f"{{{SVG}}}g",
        {
            "id": layer,
            f"{{{INKSCAPE}}}groupmode": "layer",
            f"{{{INKSCAPE}}}label": layer,
            "fill": "none",
            "stroke": COLOURS[layer][1],
            "stroke-width": str(HAIRLINE_MM),
        },
    )


def _svg_of(path: CutPath, height: float) -> ET.Element:
    """The element of a path; y of a picture runs downwards."""
    if isinstance(path, Circle):
        x, y = path.centre_mm
        place = {"cx": _number(x), "cy": _number(height - y), "r": _number(path.diameter_mm / 2)}
        return ET.Element(f"{{{SVG}}}circle", place)
    if isinstance(path, Outline):
        return ET.Element(f"{{{SVG}}}path", d=_svg_outline(path, height))
    return ET.Element(f"{{{SVG}}}polyline", points=" ".join(_pair(point, height) for point in path))


def _svg_outline(path: Outline, height: float) -> str:
    words = [f"M {_pair(path.points_mm[0], height)}"]
    for start, end, bulge in path.edges():
        if bulge:
            radius = _number(path.radius_mm(start, end, bulge))
            words.append(f"A {radius} {radius} 0 0 0 {_pair(end, height)}")
        elif end != path.points_mm[0]:
            words.append(f"L {_pair(end, height)}")
    return " ".join([*words, "Z"])


def _pair(point: Point, height: float) -> str:
    return f"{_number(point[0])},{_number(height - point[1])}"


def _number(value: float) -> str:
    """To a tenth of a micrometre, without exponent."""
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


WRITERS = {".dxf": _write_dxf, ".svg": _write_svg}
"""By the extension of the file."""
