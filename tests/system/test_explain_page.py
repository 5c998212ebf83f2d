"""The page of an explanation opened in headless Chromium: nothing overlaps, nothing is cut off, everything can be read."""

from __future__ import annotations

from functools import cache

import pytest

from benchlab.report.page import render_page
from tests.system.chromium import chromium, layouts
from tests.unit.report import explanations


@cache
def page_of(kind: str) -> str:
    return render_page(explanations.document(explanations.ALL[kind]()))


@pytest.mark.parametrize("kind", ["ambiguous", "the published table", "fourteen designs", "one sample"])
def test_layout(kind: str) -> None:
    chromium()
    for seen in layouts(page_of(kind), 1200, 400):
        assert seen.texts > 40 and not seen.faults, seen.width
