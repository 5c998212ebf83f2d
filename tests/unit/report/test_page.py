"""The page: everything escaped, nothing asked of the network, numbers as computed elsewhere."""

from __future__ import annotations

import re
from html.parser import HTMLParser

import pytest

from benchlab.report.document import Column, Document, Items, Panel, Pictures, Section, Table, Tile, Tiles, Words
from benchlab.report.page import render_page, template
from benchlab.report.rounding import words
from benchlab.report.study.document import study_document
from tests.unit.report import studies

HOSTILE = "<script>alert(1)</script>\"'&amp;\x1b[31m\x00"
SVG = '<svg width="72pt" height="72pt"><path id="m1" d="M 0 0"/></svg>'


class Seen(HTMLParser):
    """Tags with their attributes, and the text between them."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.fixture(scope="module")
def paper() -> Seen:
    return Seen(render_page(study_document(studies.report(studies.paper_study()))))


def everywhere(text: str) -> Document:
    """A document with a text in each place that takes one."""
    table = Table("t", text, (Column("a", text, False),), ((words(text),),), text, by="a")
    blocks = (
        Words(text, "lead", text),
        Tiles((Tile(text, text, text),)),
        Items(((text, text),)),
        table,
        Pictures((Panel("p", SVG, text),), text),
    )
    return Document(text, text, (text,), (Section(text, blocks),), text)


def test_text_is_text_wherever_it_stands() -> None:
    page = Seen(render_page(everywhere(HOSTILE)))
    assert not [tag for tag, _ in page.tags if tag == "script"]
    assert page.text.count("<script>alert(1)</script>\"'&amp;") == 20
    assert not [name for _, attributes in page.tags for name in attributes if name.startswith("on")]
    assert "\x1b" not in page.text and "\x00" not in page.text and "\\x1b[31m" in page.text


def test_the_page_forbids_itself_every_request(paper: Seen) -> None:
    (policy,) = [
        a["content"] for tag, a in paper.tags if tag == "meta" and a.get("http-equiv") == "Content-Security-Policy"
    ]
    assert (
        policy is not None
        and policy.startswith("default-src 'none'")
        and "http" not in policy
        and "script" not in policy
    )
    for tag, attributes in paper.tags:
        assert tag not in ("script", "link", "iframe", "img", "object", "embed", "base", "form")
        for name in ("src", "href", "xlink:href", "action", "srcset"):
            assert (attributes.get(name) or "#").startswith("#"), (tag, attributes)
    assert not re.search(r"@import|url\((?!#)", template("report.css"))


def test_links_lead_to_sections_and_names_are_unique(paper: Seen) -> None:
    ids = [name for _, attributes in paper.tags if (name := attributes.get("id"))]
    assert len(ids) == len(set(ids))
    links = {str(attributes["href"]).removeprefix("#") for tag, attributes in paper.tags if tag == "a"}
    assert len(links) > 8 and links <= set(ids)


def test_it_prints() -> None:
    printed = template("report.css").split("@media print")[1]
    for rule in ("@page", "size: A4", "break-inside: avoid", "table-header-group"):
        assert rule in printed


def test_what_a_reader_looks_for_first_stands_first(paper: Seen) -> None:
    titles = [attributes for tag, attributes in paper.tags if tag == "h2"]
    order = ["Verdict", "The designs", "Angle against pressure", "Do they differ?", "How well do they repeat?", "How far to trust this",
             "Beside the paper", "Left out and failed", "Every sample", "Provenance"]  # fmt: skip
    places = [
        paper.text.rindex(f"\n{title}\n") if f"\n{title}\n" in paper.text else paper.text.rindex(title)
        for title in order
    ]
    assert len(titles) == len(order) and paper.text.index("Drawn data") < places[0]


def test_the_same_report_gives_the_same_page() -> None:
    document = everywhere("a")
    assert render_page(document) == render_page(document)


def test_500_groups_and_long_names_stay_small() -> None:
    names = ["n" * 5000, "$x_{$", "bell\x07", *(f"d{i}" for i in range(497))]
    many = studies.values(
        tuple(studies.design(name, 60 + i % 7, 2, samples=2, cycles=1) for i, name in enumerate(names))
    )
    page = render_page(study_document(studies.report(many)))
    assert len(page) < 1_500_000
    assert "n" * 200 not in page and "\x07" not in page and "$x_{$" in page
    assert "The first 60 of 500 rows" in page
