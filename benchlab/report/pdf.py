"""A report as PDF, set by typst (extra `pdf`): the same sections as the page, handed over as data, so that no text is taken for markup."""

from __future__ import annotations

import json
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from benchlab.errors import UsageError
from benchlab.report.document import Block, Document, Items, Pictures, Tiles, Words
from benchlab.report.page import numbered, template
from benchlab.report.svg import size_in


def check_pdf() -> None:
    """Raises UsageError where the extra is missing."""
    if find_spec("typst") is None:
        raise UsageError("--pdf needs the typst wheel", hint="pip install 'benchlab[pdf]'")


def render_pdf(document: Document) -> bytes:
    """The PDF's bytes, A4."""
    import typst

    with tempfile.TemporaryDirectory(prefix="benchlab-") as folder:
        for panel in document.panels:
            (Path(folder) / f"{panel.name}.svg").write_text(panel.svg, encoding="utf-8")
        (Path(folder) / "document.json").write_text(json.dumps(_plain(document)), encoding="utf-8")
        main = Path(folder) / "report.typ"
        main.write_text(template("report.typ"), encoding="utf-8")
        return bytes(typst.compile(str(main), root=folder))


def _plain(document: Document) -> dict[str, Any]:
    numbers = numbered(document)
    return {
        "title": document.title,
        "statement": document.statement,
        "facts": list(document.facts),
        "foot": document.foot,
        "sections": [
            {"title": section.title, "blocks": [_block(block, numbers.get(block)) for block in section.blocks]}
            for section in document.sections
        ],
    }


def _block(block: Block, number: int | None) -> dict[str, Any]:
    if isinstance(block, Words):
        return {"kind": "words", "style": block.kind, "head": block.head, "text": block.text}
    if isinstance(block, Tiles):
        return {"kind": "tiles", "row": [list(tile) for tile in block.row]}
    if isinstance(block, Items):
        return {"kind": "items", "rows": [list(row) for row in block.rows]}
    if isinstance(block, Pictures):
        panels = [
            {"file": f"{panel.name}.svg", "words": panel.words, "inches": size_in(panel)[0]} for panel in block.panels
        ]
        split = _half(block) if block.stacked else None
        return {
            "kind": "pictures",
            "panels": panels,
            "split": split,
            "number": number,
            "caption": block.caption,
        }
    return {
        "kind": "table",
        "number": number,
        "caption": block.caption,
        "columns": [{"head": column.head, "number": column.number} for column in block.heads],
        "rows": [{"line": line, "cells": list(row)} for line, row in zip(block.lines, block.shown)],
        "notes": list(block.notes),
    }


def _half(block: Pictures) -> int:
    """How many panels stand in the first of two columns that are as alike in height as can be."""
    heights = [size_in(panel)[1] for panel in block.panels]
    return min(range(1, len(heights) + 1), key=lambda count: max(sum(heights[:count]), sum(heights[count:])))
