"""A report as one HTML page that needs nothing else: style and figures inside, no script, everything escaped."""

from __future__ import annotations

import re
from importlib.resources import files

from benchlab.errors import printable
from benchlab.report.document import Block, Document, Items, Panel, Pictures, Table, Tiles, Words
from benchlab.report.svg import inline_svg

# Where a line must not be broken: within `p = 0.04`, `3 mm` and `2e-5`.
_EXPONENT = re.compile(r"(?<=\de-)(?=\d)")
_BINDS = re.compile(r"(?<=\bp) (?=[<=])|(?<=\bp [<=]) |(?<=\d) (?=mm|MPa|%)| (?=\(°\))")


_CONTROL = re.compile("[\\x00-\\x08\\x0b-\\x1f\\x7f-\\x9f]")


def render_page(document: Document) -> str:
    """The page as text. It asks for nothing: its policy forbids every request."""
    from jinja2 import Environment, FunctionLoader, StrictUndefined
    from markupsafe import Markup

    letters: set[str] = set()

    def inline(panel: Panel) -> Markup:
        return Markup(inline_svg(panel, letters))

    environment = Environment(
        loader=FunctionLoader(template),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_without_controls,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["inline"] = inline
    environment.filters["bound"] = lambda text: _EXPONENT.sub("\u2060", _BINDS.sub("\u00a0", text))
    for name, kind in {"words": Words, "tiles": Tiles, "items": Items, "pictures": Pictures}.items():
        environment.tests[name] = lambda block, kind=kind: isinstance(block, kind)
    page = environment.get_template("report.html.j2")
    return page.render(document=document, zip=zip, css=Markup(template("report.css")), numbers=numbered(document))


def _without_controls(value: object) -> object:
    """What an expression gives, with control characters in texts as escapes: HTML has no place for them."""
    return _CONTROL.sub(lambda found: printable(found[0]), value) if type(value) is str else value


def template(name: str) -> str:
    """The text of a file in `report/templates`."""
    return (files("benchlab.report") / "templates" / name).read_text(encoding="utf-8")


def numbered(document: Document) -> dict[Block, int]:
    """The numbers of figures and of tables, each counted from 1 in the order of the page."""
    counts = {Table: 0, Pictures: 0}
    found: dict[Block, int] = {}
    for block in document.blocks():
        if isinstance(block, Table | Pictures):
            counts[type(block)] += 1
            found[block] = counts[type(block)]
    return found
