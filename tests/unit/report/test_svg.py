"""Figures as SVG text: the same each time, and fit to stand beside each other in one page."""

import re
import xml.etree.ElementTree as ET

import numpy as np

from benchlab.report.figures import figure_class
from benchlab.report.svg import inline_svg, panel_of, size_in

SVG = "{http://www.w3.org/2000/svg}"


def figure(title: str = "<a & b> $x_{$"):
    made = figure_class()(figsize=(3, 2))
    ax = made.add_axes((0.2, 0.2, 0.7, 0.6))
    ax.plot(np.linspace(0, 1, 7), np.linspace(0, 1 / 3, 7), "o-")
    ax.set_ylim(0, 0.2)  # clipped
    ax.set_title(title, parse_math=False)
    return made


def test_the_same_figure_gives_the_same_bytes() -> None:
    one, other = panel_of(figure(), "a", "words"), panel_of(figure(), "a", "words")
    assert one.svg == other.svg and one.png == other.png
    assert one.png.startswith(b"\x89PNG") and size_in(one) == (3.0, 2.0)


def test_it_is_xml_without_what_a_reader_of_it_does_not_need() -> None:
    svg = panel_of(figure(), "a", "words").svg
    root = ET.fromstring(svg)
    assert root.tag == f"{SVG}svg"
    assert "<!--" not in svg and "metadata" not in svg and not list(root.iter(f"{SVG}text"))
    long = [n for path in root.iter(f"{SVG}path") for n in re.findall(r"\d+\.(\d{3,})", path.get("d", ""))]
    assert not long


def test_shortened_paths_stay_where_they_were() -> None:
    import io

    from matplotlib.backends.backend_svg import FigureCanvasSVG

    whole = figure()
    FigureCanvasSVG(whole)
    file = io.StringIO()
    whole.savefig(file, format="svg")
    numbers = [[float(n) for d in re.findall(r' d="([^"]*)"', text) for n in re.findall(r"-?\d+(?:\.\d+)?", d)]
               for text in (file.getvalue(), panel_of(figure(), "a", "").svg)]  # fmt: skip
    assert len(numbers[0]) == len(numbers[1]) > 100
    np.testing.assert_allclose(numbers[1], numbers[0], atol=0.0051)


def test_panels_on_one_page_share_letters_and_nothing_else() -> None:
    letters: set[str] = set()
    parts = [inline_svg(panel_of(figure(), name, '"quoted" <words>'), letters) for name in ("a", "b")]
    ids = [re.findall(r' id="([^"]+)"', part) for part in parts]
    assert ids[0] and not set(ids[0]) & set(ids[1])
    assert len(ids[0]) == len(set(ids[0]))
    page = ET.fromstring(f"<body>{''.join(parts)}</body>")
    known = {element.get("id") for element in page.iter() if element.get("id")}
    used = {element.get("{http://www.w3.org/1999/xlink}href") for element in page.iter(f"{SVG}use")}
    clips = {match for part in parts for match in re.findall(r"url\((#[^)]+)\)", part)}
    assert len(used) > 5 and clips and {name.removeprefix("#") for name in used | clips if name} <= known
    assert len(parts[1]) < 0.7 * len(parts[0])
    assert "&quot;quoted&quot; &lt;words&gt;" in parts[0]
