"""The page: its sections by verdict, its numbers, its marks, and everything as text."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.effects.friction import Friction
from benchlab.discrepancy.explanation import Explanation
from benchlab.errors import UsageError
from benchlab.io.protocol_file import read_protocol
from benchlab.report.document import Document, Pictures, Table, Tiles, Words
from benchlab.report.explain.document import explain_document
from benchlab.report.explain.named import equation_of
from benchlab.report.explain.words import SIMULATED, verdict_words
from benchlab.report.page import render_page
from benchlab.report.pdf import check_pdf, render_pdf
from tests.unit.report import explanations

HOSTILE = "<script>alert(1)</script>$x_{$\x1b"


def fewer(found: Explanation) -> Explanation:
    """With the curves of one design at one rate, so that few panels are drawn; the rest as it is."""
    one = explanations.curves({"tw3_slw5": 100.0}, rates=(0.1,), hold=False)
    return replace(found, curves=one if found.effects else replace(one, explained=one.simulated))


def small(**changes: object) -> Explanation:
    return fewer(explanations.explanation(where=(), **changes))


@cache
def ambiguous() -> Document:
    return explanations.document(fewer(explanations.ambiguous()))


@cache
def plain() -> Document:
    return explanations.document(small())


def titles(document: Document) -> list[str]:
    return [section.title for section in document.sections]


def said(document: Document, title: str) -> str:
    (section,) = [one for one in document.sections if one.title == title]
    return "\n".join(f"{block.head} {block.text}" for block in section.blocks if isinstance(block, Words))


def test_the_story_in_order() -> None:
    document = ambiguous()
    assert titles(document) == [
        "Verdict", "Where", "What", "Rivals", "The gap before and after", "What the fit had not seen", "What is left",
        "What these data cannot judge", "Next experiment", "Warnings", "How to read this", "Provenance",
    ]  # fmt: skip
    assert verdict_words(explanations.ambiguous()) in said(document, "Verdict")
    names = [table.name for table in document.tables]
    assert names == ["regions", "parameters", "rivals", "designs", "held_out", "inputs", "curves"]


def test_agreement_names_nothing() -> None:
    document = explanations.document(fewer(explanations.agreeing()))
    assert not {"What", "Rivals", "What is left", "Next experiment", "Warnings"} & set(titles(document))
    assert "Nowhere do measured and simulated differ" in said(document, "Where")


def test_tiles_are_the_numbers_of_the_explanation() -> None:
    document = ambiguous()
    (tiles,) = [block for block in document.blocks() if isinstance(block, Tiles)]
    assert [tile.value for tile in tiles.row] == ["4.9° → 1.3°", "1.2°", "92 %", "3"]


def test_physics_equation_look_and_test_of_what_was_named() -> None:
    what = said(plain(), "What")
    for text in (
        Friction.physics,
        Friction.looks_like,
        Friction.shown_by,
        "It explains 83 % of what any model could explain.",
    ):
        assert text in what
    assert "h(p) = h·(1 − g + g·p/0.35 MPa)" in what and "equivalent ones" in what


def test_every_effect_has_an_equation() -> None:
    assert not [name for name, effect in built_in().items() if not all(equation_of(effect))]


def test_an_effect_of_a_user_that_is_not_installed_is_told_without_physics() -> None:
    found = replace(explanations.FRICTION, name="snap_through")
    what = said(explanations.document(small(effects=(found,))), "What")
    assert what.startswith("Snap through. It explains 83 % of what any model could explain.")


def test_the_best_of_several_is_not_called_the_cause() -> None:
    assert "the best of the explanations that are left" in said(ambiguous(), "What")


def test_what_cannot_be_judged_has_its_reason_and_its_test() -> None:
    page = render_page(plain())
    assert "no force was measured. What would show it: " in page


def test_simulated_data_are_marked_on_page_captions_and_figures() -> None:
    document = explanations.document(small(simulated=True))
    assert document.statement == SIMULATED and document.title.startswith("Simulated data: ")
    captions = [block.caption for section in document.sections[:-1] for block in section.blocks
                if isinstance(block, Table | Pictures)]  # fmt: skip
    assert captions and all(caption.startswith("Simulated data. ") for caption in captions)
    assert all(panel.words.endswith("(simulated data)") for panel in document.panels)
    measured = plain()
    assert measured.statement == "" and "simulated data" not in render_page(measured).lower()


def test_names_are_text_everywhere() -> None:
    found = explanations.curves({HOSTILE: 100.0, "W" * 300: 50.0}, f"{HOSTILE}_mm", rates=(0.1,), hold=False)
    where = tuple(
        replace(one, design=HOSTILE, quantity=f"{HOSTILE}_mm") for one in explanations.explanation().where[:1]
    )
    effect = replace(explanations.FRICTION, name=HOSTILE, form=HOSTILE, other_forms=(HOSTILE,))
    hostile = explanations.explanation(
        curves=found,
        where=where,
        effects=(effect,),
        held_out=(),
        source=HOSTILE,
        base=HOSTILE,
        warnings=(HOSTILE,),
        remainder=(HOSTILE,),
        judged_not={HOSTILE: HOSTILE},
        next_experiment=replace(explanations.NEXT, protocol=HOSTILE, setup=HOSTILE),
    )
    page = render_page(explanations.document(hostile))
    assert "<script" not in page and "\x1b" not in page and page.count("&lt;script&gt;") > 10
    assert "W" * 200 not in page


def test_the_picture_of_the_next_protocol() -> None:
    plan = read_protocol("linear_ramp")
    document = explanations.document(small(next_experiment=explanations.NEXT), plan)
    assert [panel.name for panel in document.panels][-1] == "next_experiment"
    assert "To run it: benchlab run next.yaml --out results" in said(document, "Next experiment")


def test_the_same_explanation_gives_the_same_page() -> None:
    assert render_page(plain()) == render_page(explanations.document(small()))


def test_names_of_files_are_apart() -> None:
    document = ambiguous()
    names = [panel.name for panel in document.panels]
    assert len(names) == len(set(names)) == 4
    assert all(panel.png.startswith(b"\x89PNG") and panel.svg.startswith("<?xml") for panel in document.panels)


def test_it_is_set_as_pdf() -> None:
    try:
        check_pdf()
    except UsageError as error:
        pytest.skip(str(error))
    pdf = render_pdf(explain_document(small(), built_in(), explanations.MADE))
    assert pdf.startswith(b"%PDF")
