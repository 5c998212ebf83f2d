"""The story in words, for the terminal and for the page: verdict, where, what, rivals, the gap before and after, the next experiment."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from benchlab.discrepancy.explanation import Estimate, Explanation, Found, Gap, NextExperiment
from benchlab.errors import counted, printable
from benchlab.report.document import cut
from benchlab.report.explain.quantity import Quantity, effect_words, main_quantity
from benchlab.report.explain.regions import and_words, p_told, told_regions
from benchlab.report.rounding import decimals_of, digits, number

SIMULATED = "Simulated data: what is called measured here came from a twin or was drawn; nothing was measured."

CLEARLY_SD = 10
"""Beyond this distance its number says nothing more."""

NO_WIDTH = 1e-11
"""An interval that is narrower has no digits."""

UNWRITTEN = "next.yaml"
"""What a protocol is called that has no file yet."""


def told(explanation: Explanation) -> list[str]:
    """The story for a terminal, a line each: the verdict first; under each head its lines, set in.

    Control characters of names are shown as escapes.
    """
    lines = [SIMULATED] * explanation.simulated + [verdict_words(explanation)]
    for head, parts in _parts(explanation):
        if body := list(parts):
            lines += ["", f"{head}:", *(f"  {line}" for line in body)]
    return [printable(line) for line in lines]


def _parts(explanation: Explanation) -> Iterator[tuple[str, Iterable[str]]]:
    yield "Where", told_regions(explanation.where, explanation.curves)
    what = (
        "What"
        if explanation.verdict != "ambiguous"
        else "What (best fit of those that are left, not known to be the cause)"
    )
    yield what, [line for found in explanation.effects for line in effect_lines(found)]
    if explanation.verdict == "ambiguous":
        yield "Rivals", [set_words(names) for names in explanation.rivals]
    yield "Gap", gap_lines(explanation)
    yield "Left", [cut(line, 300) for line in explanation.remainder]
    yield "Not to be judged from these data", [not_judged_words(explanation)] * bool(explanation.judged_not)
    yield "Next experiment", next_lines(explanation.next_experiment)
    yield "Warnings", [cut(line, 300) for line in explanation.warnings]


def verdict_words(explanation: Explanation) -> str:
    """The verdict in a sentence or two, with numbers."""
    quantity, gap = main_quantity(explanation.curves), explanation.gap
    words = {"agree": _agree, "named": _named, "ambiguous": _ambiguous, "unexplained": _unexplained}
    return words[explanation.verdict](explanation, quantity, gap) + left_out_words(explanation)


def left_out_words(explanation: Explanation) -> str:
    """A sentence on the measured designs that were not compared, after the verdict; empty where there are none."""
    left = [f"{cut(name, 40)}, {cut(why, 160)}" for name, why in explanation.left_out.items()]
    if not left:
        return ""
    shown = "; ".join([*left[:5], *[f"{len(left) - 5} more"] * (len(left) > 5)])
    measured = len(set(explanation.curves.design.tolist())) + len(left)
    return f" {len(left)} of {measured} measured designs {'is' if len(left) == 1 else 'are'} left out: {shown}."


def verdict_title(explanation: Explanation) -> str:
    """In a few words, for titles."""
    if explanation.verdict == "agree":
        return "simulation and measurement agree"
    if explanation.verdict == "named":
        verb = "is" if len(explanation.effects) == 1 else "are"
        return f"{set_words([found.name for found in explanation.effects])} {verb} missing"
    if explanation.verdict == "ambiguous":
        return f"{len(explanation.rivals)} explanations are left"
    if explanation.only_described:
        return "a gap, described only"
    return "a gap that no known effect explains"


def _agree(explanation: Explanation, quantity: Quantity, gap: Gap) -> str:
    return (
        f"Simulation and measurement agree: measured and simulated {quantity.noun} differ by {quantity.amount(gap.rmse_before)} "
        f"(root mean square), no more than the scatter of {counted(explanation.samples, 'sample')} explains "
        f"({_p_gap(explanation)})."
    )


def _named(explanation: Explanation, quantity: Quantity, gap: Gap) -> str:
    names = [found.name for found in explanation.effects]
    with_it = "it" if len(names) == 1 else "them"
    return f"The simulation lacks {set_words(names)} ({_p_gap(explanation)}). With {with_it} {_shrinks(explanation, quantity)}."


def _ambiguous(explanation: Explanation, quantity: Quantity, gap: Gap) -> str:
    rivals = [set_words(names) for names in explanation.rivals]
    shown = [*rivals[:5], *[f"{len(rivals) - 5} more"] * (len(rivals) > 5)]
    best = f" With the best of them {_shrinks(explanation, quantity)}." if explanation.effects else ""
    return (
        f"{_disagree(explanation, quantity, gap)}, and these data cannot tell {counted(len(rivals), 'explanation')} apart: "
        f"{'; '.join(shown)}.{best}"
    )


def _unexplained(explanation: Explanation, quantity: Quantity, gap: Gap) -> str:
    if explanation.only_described:
        return (
            f"Measured and simulated {quantity.noun} differ by {quantity.amount(gap.rmse_before)} (root mean square). Whether that is more "
            "than samples scatter, and what is missing, these data cannot tell; where and how they differ is described."
        )
    text = f"{_disagree(explanation, quantity, gap)}, and no effect of the vocabulary explains it"
    if explanation.effects:
        names = set_words([found.name for found in explanation.effects])
        text += f": {names} {'come' if len(explanation.effects) > 1 else 'comes'} nearest, and {_shrinks(explanation, quantity)}"
    return f"{text}."


def _disagree(explanation: Explanation, quantity: Quantity, gap: Gap) -> str:
    return (
        f"Simulation and measurement disagree: {quantity.noun} is off by {quantity.amount(gap.rmse_before)} "
        f"(root mean square, {_p_gap(explanation)})"
    )


def unseen(explanation: Explanation) -> str:
    """What the numbers of held-out data belong to: samples or, of a table of means, designs."""
    kinds = {one.kind for one in explanation.held_out}
    return "designs" if "design" in kinds and "sample" not in kinds else "samples"


def floor_words(explanation: Explanation) -> tuple[str, str]:
    """What the noise floor is called, and what it is: of a table of means, their standard error."""
    if unseen(explanation) == "designs":
        return "standard error", "of the means, which a faultless model misses by as much"
    return (
        "noise floor",
        "a faultless model is expected to come as near to a held-out sample, estimated from the samples' own scatter",
    )


def _shrinks(explanation: Explanation, quantity: Quantity) -> str:
    """How the gap falls: on held-out data where there are any."""
    gap = explanation.gap
    if math.isfinite(gap.heldout_before) and math.isfinite(gap.heldout_after):
        before, after, where = (
            gap.heldout_before,
            gap.heldout_after,
            f"on {unseen(explanation)} that the fit has not seen",
        )
    else:
        before, after, where = gap.rmse_before, gap.rmse_after, "on the data of the fit (nothing could be held out)"
    verb = "falls" if after < before else "does not fall: it goes"
    text = f"the gap {verb} from {quantity.amount(before)} to {quantity.amount(after)} {where}"
    if math.isfinite(gap.noise_floor):
        means = unseen(explanation) == "designs"
        what = "the standard error of the means" if means else "what samples of one design scatter by"
        text += f"; {quantity.amount(gap.noise_floor)} is {what}"
    return text


def _p_gap(explanation: Explanation) -> str:
    if not math.isfinite(explanation.p_gap):
        return "p not known"
    text = p_told(explanation.p_gap)
    return f"p {text}" if text.startswith("<") else f"p = {text}"


def set_words(names: Sequence[str]) -> str:
    """Effects that act together.

    >>> set_words(["friction", "seam_margin"]), set_words([])
    ('friction and seam margin', 'nothing')
    """
    return and_words([effect_words(name) for name in names]) or "nothing"


def effect_lines(found: Found) -> Iterator[str]:
    """What was named, its share, and its parameters with 95 % intervals."""
    form = f", form {cut(found.form, 30)}" if found.form not in ("", "plain") else ""
    yield f"{effect_words(found.name)}{form}: {explains_words(found)}"
    for name, estimate in found.parameters.items():
        yield f"  {parameter_words(name, estimate)}"
    if found.other_forms:
        forms = and_words([cut(name, 30) for name in found.other_forms])
        yield f"  other forms of its equation fit alike ({forms}): read the numbers as those of an equivalent effect"


def explains_words(found: Found) -> str:
    return f"explains {percent(found.share_explained)} of what any model could explain"


def parameter_words(name: str, estimate: Estimate) -> str:
    """
    >>> parameter_words("end_length_mm", Estimate(4.123, 3.2, 5.1, "mm", "rigid at each end"))
    'end_length_mm = 4.12 mm (95 % 3.20 to 5.10): rigid at each end'
    """
    unit = "" if estimate.unit in ("", "1", "-") else f" {cut(estimate.unit, 20)}"
    value, interval = parameter_text(estimate)
    what = f": {cut(estimate.what, 120)}" * bool(estimate.what)
    return f"{cut(name, 40)} = {value}{unit} ({interval if interval.startswith('not') else f'95 % {interval}'}){what}"


def parameter_text(estimate: Estimate) -> tuple[str, str]:
    """Value and interval as written: two digits of the interval; what bounds it if not the data. One without width says nothing."""
    low, high = estimate.low, estimate.high
    if high - low < NO_WIDTH:
        return digits(estimate.value).text, "not determined" + ": it stays at a bound of the effect" * estimate.at_bound
    known = math.isfinite(low) and math.isfinite(high)
    places = decimals_of((high - low) / 2) if known else None
    value, first, last = (
        (digits(each) if places is None else number(each, places)).text for each in (estimate.value, low, high)
    )
    if known:
        interval = f"{first} to {last}"
    elif math.isfinite(low) or math.isfinite(high):
        interval = f"at least {first}" if math.isfinite(low) else f"at most {last}"
    else:
        interval = "not bounded by the data"
    return value, interval + ", at a bound of the effect" * estimate.at_bound


def gap_lines(explanation: Explanation) -> Iterator[str]:
    """Before and after, on the data of the fit and on held-out samples, and between which limits that has to be read."""
    quantity, gap = main_quantity(explanation.curves), explanation.gap
    if explanation.only_described:
        yield f"{quantity.amount(gap.rmse_before)} (root mean square of measured − simulated)"
        return
    yield f"on the data of the fit {_change(quantity, gap.rmse_before, gap.rmse_after)} (root mean square of measured − model)"
    if math.isfinite(gap.heldout_before) and math.isfinite(gap.heldout_after):
        yield f"on held-out {unseen(explanation)} {_change(quantity, gap.heldout_before, gap.heldout_after)}"
    if math.isfinite(gap.noise_floor):
        name, what = floor_words(explanation)
        yield f"{name} {quantity.amount(gap.noise_floor)}: {what}"
    if math.isfinite(gap.ceiling):
        yield f"ceiling {percent(gap.ceiling)}: the share of the mean square gap that is no scatter"
    if math.isfinite(explanation.false_naming):
        yield false_naming_words(explanation)


def false_naming_words(explanation: Explanation) -> str:
    rate = percent(explanation.false_naming)
    return (
        f"nominal rate of false names {rate}: of studies in which nothing is missing, to which the rules are calibrated"
    )


def not_judged_words(explanation: Explanation) -> str:
    """The effects alone; the page has the reasons."""
    return and_words([effect_words(name) for name in explanation.judged_not])


def next_lines(proposed: NextExperiment | None) -> Iterator[str]:
    """What to run, how, and what it is expected to tell."""
    if proposed is None:
        return
    if proposed.cannot:
        why = proposed.cannot.removeprefix("cannot be separated on this bench: ")
        yield f"cannot be separated on this bench: {cut(why, 900)}"
    if proposed.separates:
        yield f"separates {cut(proposed.separates, 300)}{_expected(proposed)}"
    if proposed.setup:
        yield f"first: {cut(proposed.setup, 900)}"
    if proposed.protocol:
        yield run_command(proposed)


def _expected(proposed: NextExperiment) -> str:
    if not math.isfinite(proposed.expected_sd):
        return ""
    if proposed.expected_sd > CLEARLY_SD:
        return f", expected to lie clearly apart (more than {CLEARLY_SD} standard deviations)"
    return f", expected to lie {digits(proposed.expected_sd, 2).text} standard deviations apart at least"


def run_command(proposed: NextExperiment) -> str:
    """The command line that runs the protocol; one that has no file yet is called UNWRITTEN, and of one that has only a name it is said
    how to get it."""
    written = "\n" not in proposed.protocol
    if written and not proposed.protocol.endswith((".yaml", ".yml")):
        return f"with --out its protocol ({cut(proposed.protocol, 200)}) is written, for `benchlab run`"
    return f"benchlab run {shlex.quote(cut(proposed.protocol, 200) if written else UNWRITTEN)} --out results"


def percent(share: float) -> str:
    """
    >>> percent(0.834), percent(float("nan")), percent(0.004)
    ('83 %', '–', '0.4 %')
    """
    if not np.isfinite(share):
        return "–"
    return f"{number(100 * share, 1 if abs(share) < 0.0095 and share else 0).text} %"


def _change(quantity: Quantity, before: float, after: float) -> str:
    return f"{quantity.amount(before)} → {quantity.amount(after)}"
