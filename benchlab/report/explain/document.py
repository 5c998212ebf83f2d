"""What was explained as a document: verdict, where, what, rivals, gap before and after, held-out data, what is left, next experiment."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from benchlab.discrepancy.bank import DRAWS as VERDICT_DRAWS
from benchlab.discrepancy.effects.effect import Effect
from benchlab.discrepancy.explanation import Explanation
from benchlab.discrepancy.locate import DRAWS as PLACES_DRAWS
from benchlab.errors import counted
from benchlab.protocol.plan import Plan
from benchlab.report.document import Block, Document, Section, Tile, Tiles, Words, cut, listed, marked
from benchlab.report.explain.change_figure import Change
from benchlab.report.explain.named import named_blocks
from benchlab.report.explain.names import mark_of
from benchlab.report.explain.pictures import changes_picture, curves_pictures, map_pictures, protocol_pictures
from benchlab.report.explain.quantity import effect_words, main_quantity
from benchlab.report.explain.regions import told_regions
from benchlab.report.explain.tables import (
    curves_table,
    designs_table,
    held_out_table,
    regions_table,
    rivals_table,
)
from benchlab.report.explain.words import (
    SIMULATED,
    false_naming_words,
    floor_words,
    next_lines,
    percent,
    set_words,
    unseen,
    verdict_title,
    verdict_words,
)
from benchlab.report.provenance import PROVENANCE, provenance_section

NUMBERS = "explain.json"

_READ = (
    ("Gap", "measured less model, of the means of the samples, in bins of pressure (in holds: of time); RMSE: its root mean square."),
    ("Noise floor", "by how much a sample scatters about the mean of its own design,"
     " an estimate from these samples: a faultless model is expected to come as near to an unseen one, give or take."),
    ("Explains", "of the misfit (−2 log likelihood) that any model could take away, the share that this one does."),
    ("Ceiling", "the share of the mean square gap of the means that is no scatter of them: another measure than the one before."),
    ("p of the verdict", f"how often the scatter of samples alone gives as large a t in any direction of the vocabulary: {VERDICT_DRAWS} "
                         f"draws of it, so that the smallest p is 1/{VERDICT_DRAWS + 1}."),
    ("p of places", f"how often it gives as large a gap anywhere, all places looked at together: {PLACES_DRAWS} draws."),
    ("False names", "the rate is nominal: the rules are calibrated to it on studies in which nothing is hidden (docs/benchmarks)."),
    ("Left", "not to be told from the best explanation by these data. Where several are left, none is known to be the cause."),
    ("Equivalent", "parameters belong to the equation that is shown; another equation of the same effect has other numbers."),
)  # fmt: skip


def explain_document(
    explanation: Explanation,
    vocabulary: Mapping[str, Effect],
    provenance: Mapping[str, Any],
    inputs: Mapping[str, str] | None = None,
    plan: Plan | None = None,
) -> Document:
    """The whole report. vocabulary: effects by name, without those that the model has already.

    provenance: as workflows.provenance.made_by gives it. inputs: SHA-256 by file read.
    plan: of the next experiment, where it is known."""
    mark = mark_of(explanation)
    sections = [
        Section("Verdict", tuple(_verdict(explanation))),
        Section("Where", tuple(_where(explanation))),
        Section("What", tuple(named_blocks(explanation, vocabulary))),
        Section("Rivals", tuple(_rivals(explanation, vocabulary))),
        Section("The gap before and after", tuple(_gap(explanation))),
        Section("What the fit had not seen", tuple(_held_out(explanation))),
        Section("What is left", tuple(_left(explanation))),
        Section("What these data cannot judge", tuple(_not_judged(explanation, vocabulary))),
        Section("Next experiment", tuple(_next(explanation, plan))),
        Section("Warnings", tuple(Words(cut(line, 400), "warning") for line in explanation.warnings)),
        Section("How to read this", (listed(_READ, NUMBERS),)),
        provenance_section((("Simulation", explanation.base),), provenance, inputs or {}, NUMBERS),
    ]
    return Document(
        title=cut(f"{mark.capitalize() or 'Explained'}: {verdict_title(explanation)}", 140),
        statement=SIMULATED * explanation.simulated,
        facts=_facts(explanation, provenance),
        sections=tuple(
            marked(section, mark if section.title != PROVENANCE else "") for section in sections if section.blocks
        ),
        foot=f"Written by benchlab {provenance['versions']['benchlab']}. This page asks nothing of the network.",
        data=(curves_table(explanation),),
    )


def _facts(explanation: Explanation, provenance: Mapping[str, Any]) -> tuple[str, ...]:
    designs = len(set(explanation.curves.design.tolist()))
    return (
        cut(explanation.source, 80),
        f"{counted(designs, 'design')}, {counted(explanation.samples, 'sample')}",
        f"simulation: {cut(explanation.base, 60)}",
        provenance["created"][:10],
    )


def _verdict(explanation: Explanation) -> Iterator[Block]:
    yield Tiles(tuple(_tiles(explanation)))
    yield Words(verdict_words(explanation), "lead")
    if math.isfinite(explanation.false_naming):
        words = false_naming_words(explanation)
        yield Words(f"{words[:1].upper()}{words[1:]}.", "small")


def _tiles(explanation: Explanation) -> Iterator[Tile]:
    quantity, gap = main_quantity(explanation.curves), explanation.gap
    held = math.isfinite(gap.heldout_before) and math.isfinite(gap.heldout_after)
    before, after = (gap.heldout_before, gap.heldout_after) if held else (gap.rmse_before, gap.rmse_after)
    where = f"on held-out {unseen(explanation)}" if held else "on the data of the fit"
    if explanation.only_described:
        where = "measured − simulated"
    if explanation.effects:
        value = f"{quantity.amount(before)} → {quantity.amount(after)}"
        yield Tile(value, f"gap, root mean square, {where}", f"{quantity.noun}, before → after")
    else:
        yield Tile(quantity.amount(before), f"gap, root mean square, {where}", quantity.noun)
    if math.isfinite(gap.noise_floor):
        means = unseen(explanation) == "designs"
        what = "of the means" if means else "a sample about the mean of its design"
        yield Tile(quantity.amount(gap.noise_floor), floor_words(explanation)[0], what)
    if explanation.effects:
        share = sum(found.share_explained for found in explanation.effects)
        ceiling = f"; {percent(gap.ceiling)} of the mean square gap is no scatter" if math.isfinite(gap.ceiling) else ""
        yield Tile(
            percent(share),
            "of what any model could explain",
            f"{set_words([f.name for f in explanation.effects])}{ceiling}",
        )
    if explanation.verdict == "ambiguous":
        yield Tile(str(len(explanation.rivals)), "explanations left", "not to be told apart by these data")


def _where(explanation: Explanation) -> Iterator[Block]:
    sentences = told_regions(explanation.where, explanation.curves)
    if explanation.only_described:
        yield Words(
            "Stretches of pressure with a gap of one sign. How samples scatter is not known, so that none has a p."
        )
    elif not sentences:
        yield Words("Nowhere do measured and simulated differ by more than the scatter of the samples explains.")
    for sentence in sentences:
        begins = sentence.startswith(("all ", "told "))
        yield Words(f"{sentence[:1].upper() if begins else sentence[:1]}{sentence[1:]}.")
    yield map_pictures(explanation)
    if explanation.where:
        yield regions_table(explanation)


def _rivals(explanation: Explanation, vocabulary: Mapping[str, Effect]) -> Iterator[Block]:
    if explanation.verdict == "ambiguous":
        rivals = "; ".join(set_words(names) for names in explanation.rivals)
        yield Words(f"Not told apart by these data: {rivals}.", "lead")
    if explanation.tried:
        yield rivals_table(explanation, vocabulary)


def _gap(explanation: Explanation) -> Iterator[Block]:
    yield from curves_pictures(explanation)
    yield designs_table(explanation)


def _held_out(explanation: Explanation) -> Iterator[Block]:
    if not explanation.held_out:
        return
    rows = [Change(f"{cut(one.kind, 20)} {cut(one.what, 50)}", one.before, one.after, one.noise_floor)
            for one in explanation.held_out if math.isfinite(one.after)]  # fmt: skip
    yield Words("Each was left out of the fit in turn, and then predicted.")
    if rows:
        yield changes_picture(explanation, rows, "held_out", "Left out, and predicted")
    yield held_out_table(explanation)


def _left(explanation: Explanation) -> Iterator[Block]:
    for line in explanation.remainder:
        yield Words(f"{cut(line, 400)}{'' if line.endswith('.') else '.'}")
    if explanation.effects:
        if not explanation.remainder:
            yield Words("In what is left no dependence on design, direction, rate, cycle or pressure was found.")
        yield map_pictures(explanation, "explained")


def _not_judged(explanation: Explanation, vocabulary: Mapping[str, Effect]) -> Iterator[Block]:
    rows = []
    for name, reason in explanation.judged_not.items():
        shown_by = f" What would show it: {vocabulary[name].shown_by}." if name in vocabulary else ""
        rows.append((effect_words(name), f"{cut(reason, 200)}.{shown_by}"))
    if rows:
        yield Words("That these are not named says nothing about them: data like these cannot show them.")
        yield listed(rows, NUMBERS)


def _next(explanation: Explanation, plan: Plan | None) -> Iterator[Block]:
    for index, line in enumerate(next_lines(explanation.next_experiment)):
        command = line.startswith("benchlab run")
        yield Words(line if command else f"{line[:1].upper()}{line[1:]}{'' if line.endswith('.') else '.'}",
                    "plain" if index else "lead", "To run it:" * command)  # fmt: skip
    if plan is not None:
        yield protocol_pictures(plan)
