"""What was named: each effect with its physics, its equation, how it looks, which test shows it, and its parameters."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator, Mapping

from benchlab.discrepancy.effects.effect import Effect
from benchlab.discrepancy.explanation import Explanation, Found
from benchlab.report.document import Block, Words, cut
from benchlab.report.explain.quantity import effect_words
from benchlab.report.explain.regions import and_words
from benchlab.report.explain.tables import parameters_table
from benchlab.report.explain.words import explains_words

_WIDE = re.compile(r"\s{2,}")
_BLANK = re.compile(r"\n\s*\n")


def named_blocks(explanation: Explanation, vocabulary: Mapping[str, Effect]) -> Iterator[Block]:
    """Nothing where nothing was named."""
    if not explanation.effects:
        return
    if explanation.verdict == "ambiguous":
        yield Words(
            "This is the best of the explanations that are left; see the rivals before building on it.", "warning"
        )
    if explanation.verdict == "unexplained":
        yield Words("This comes nearest, but does not explain the gap: it is not named as a cause.", "warning")
    for found in explanation.effects:
        yield from _effect(found, vocabulary.get(found.name), len(explanation.effects) == 1)
    yield parameters_table(explanation)
    if any(found.form not in ("", "plain") or found.other_forms for found in explanation.effects):
        yield Words("Where other forms fit alike, the parameters are equivalent ones: they reproduce the curves, and a constant of the "
                    "material that enters another equation will differ from them.", "small")  # fmt: skip


def _effect(found: Found, effect: Effect | None, alone: bool) -> Iterator[Block]:
    """alone: all its forms were fitted."""
    name = effect_words(found.name)
    head = f"{name[:1].upper()}{name[1:]}"
    share = f"It {explains_words(found)}."
    if effect is None:
        yield Words(share, "lead", f"{head}.")
        return
    yield Words(f"{share} {cut(effect.physics, 1200)}", "lead", f"{head}.")
    equation, letters = equation_of(effect)
    if equation:
        yield Words(equation, head="Equation.")
        yield Words(letters, "small")
    forms = (
        f"; other forms fit alike: {and_words([cut(form, 30) for form in found.other_forms])}"
        if found.other_forms
        else ""
    )
    worse = [cut(form, 30) for form in effect.forms if form not in (found.form, *found.other_forms)]
    if worse and alone:
        forms += f"; {and_words(worse)} {'fits' if len(worse) == 1 else 'fit'} worse by 4 in misfit (−2 log likelihood) at least"
    yield Words(f"{cut(found.form, 30)}{forms}.", head="Form.")
    yield Words(f"{cut(effect.looks_like, 400)}. Shown by: {cut(effect.shown_by, 400)}.", head="Looks like:")


def equation_of(effect: Effect) -> tuple[str, str]:
    """The equations in the documentation of an effect's file, those lines of it that are set in, and the paragraph after them: what
    letters mean. "" where the file has none.

    >>> from benchlab.discrepancy.effects.frame_compliance import FrameCompliance
    >>> equation_of(FrameCompliance())[0]
    'F → F·(1 − s)'
    """
    module = sys.modules.get(effect.__module__)
    parts = _BLANK.split(inspect.getdoc(module) or "") if module else []
    at = next((i for i, part in enumerate(parts) if part.startswith("    ") and ">>>" not in part), None)
    if at is None:
        return "", ""
    lines = [_WIDE.sub("; ", line.strip()) for line in parts[at].splitlines()]
    letters = " ".join(" ".join(parts[at + 1 : at + 2]).replace("`", "").split())
    return cut("; ".join(lines), 400), cut(letters.removesuffix("."), 900) + "." * bool(letters)
