"""Figures as SVG text: letters as outlines, so that they look alike everywhere; the same bytes for the same figure."""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_REFERENCE = re.compile(r'(?<= id=")|(?<=url\(#)|(?<=href="#)')
_HEAD = re.compile(r"^.*?(?=<svg\b)", re.DOTALL)
_COMMENT = re.compile(r"<!--.*?-->\s*", re.DOTALL)


def svg_of(figure: Figure) -> str:
    """A figure as the text of an SVG file, without date, metadata and comments."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    FigureCanvasSVG(figure)
    file = io.StringIO()
    with rc_context({"svg.hashsalt": "benchlab", "svg.fonttype": "path"}):
        figure.savefig(file, format="svg", metadata=dict.fromkeys(("Date", "Creator", "Format", "Type")))
    return _COMMENT.sub("", file.getvalue())


def inline_svg(svg: str, name: str, words: str) -> str:
    """An SVG file's text to stand in an HTML page beside others: its names prefixed, and described by `words`.

    >>> inline_svg('<?xml?>\\n<svg width="1pt"><g id="a"/><use href="#a"/></svg>', "bars", "x < y")
    '<svg role="img" aria-label="x &lt; y" width="1pt"><g id="bars-a"/><use href="#bars-a"/></svg>'
    """
    from html import escape

    body = _REFERENCE.sub(f"{name}-", _HEAD.sub("", svg))
    return body.replace("<svg", f'<svg role="img" aria-label="{escape(words)}"', 1)
