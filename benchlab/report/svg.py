"""Figures as panels of a report: SVG text with letters as outlines, so that they look alike everywhere, and the same as PNG."""

from __future__ import annotations

import io
import re
from html import escape
from typing import TYPE_CHECKING

from benchlab.report.document import Panel

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LETTER = r"[A-Z][\w-]*-[0-9a-f]+"
_REFERENCE = re.compile(rf'(?:(?<= id=")|(?<=url\(#)|(?<=href="#))(?!{_LETTER}")')
_HEAD = re.compile(r"^.*?(?=<svg\b)", re.DOTALL)
_SIZE = re.compile(r' width="([0-9.]+)pt" height="([0-9.]+)pt"')
_NOT_NEEDED = re.compile(r'<!--.*?-->\s*|(?<=<g) id="[^"]*"', re.DOTALL)
_OUTLINE = re.compile(rf'<path id="({_LETTER})"[^>]*/>\s*')
_PATH = re.compile(r'(?<= d=")[^"]*(?=")')
_LONG = re.compile(r"-?\d+\.\d{3,}")


def panel_of(figure: Figure, name: str, words: str) -> Panel:
    """A figure as SVG and PNG. words: what it shows, for those who do not see it."""
    from benchlab.report.figures import save_png

    picture = io.BytesIO()
    save_png(figure, picture)
    return Panel(name, svg_of(figure), words, picture.getvalue())


def svg_of(figure: Figure) -> str:
    """The text of an SVG file, the same for the same figure: without date and names of groups, paths to 0.01 pt."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    FigureCanvasSVG(figure)
    file = io.StringIO()
    with rc_context({"svg.hashsalt": "benchlab", "svg.fonttype": "path"}):
        figure.savefig(file, format="svg", metadata=dict.fromkeys(("Date", "Creator", "Format", "Type")))
    return _PATH.sub(lambda path: _shortened(path[0]), _NOT_NEEDED.sub("", file.getvalue()))


def size_in(panel: Panel) -> tuple[float, float]:
    """Width and height of a panel in inches."""
    size = _SIZE.search(panel.svg)
    return (float(size[1]) / 72, float(size[2]) / 72) if size else (0.0, 0.0)


def inline_svg(panel: Panel, letters: set[str]) -> str:
    """An SVG to stand in an HTML page beside others: its width as the CSS variable --inches, its names prefixed with the panel's, and
    described by its words. letters: of which the page has an outline already; those that are added here are put in.

    >>> inline_svg(Panel("bars", '<?xml?><svg width="72pt" height="9pt"><g id="a"/><use href="#a"/></svg>', "x < y"), set())
    '<svg role="img" aria-label="x &lt; y" style="--inches: 1"><g id="bars-a"/><use href="#bars-a"/></svg>'
    """
    body = _OUTLINE.sub(lambda found: "" if found[1] in letters else found[0], _HEAD.sub("", panel.svg))
    letters |= {found[1] for found in _OUTLINE.finditer(body)}
    body = _REFERENCE.sub(f"{panel.name}-", body)
    body = _SIZE.sub(f' style="--inches: {size_in(panel)[0]:.4g}"', body, count=1)
    return body.replace("<svg", f'<svg role="img" aria-label="{escape(panel.words)}"', 1)


def _shortened(path: str) -> str:
    return " ".join(_LONG.sub(lambda number: f"{float(number[0]):.2f}", path).split())
