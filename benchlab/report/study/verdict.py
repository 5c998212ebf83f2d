"""The words at the head of a report: do the designs differ, how well do they repeat, how well were they foretold."""

from __future__ import annotations

import math
from collections.abc import Sequence

from benchlab.report.document import Section, Words, cut
from benchlab.report.rounding import number
from benchlab.report.study.report import ComparedSet, StudyReport, error_of
from benchlab.stats.comparison import Comparison
from benchlab.stats.pairs import Pair
from benchlab.stats.wording import p_equals, verdict

_MOST_PAIRS = 6


def verdict_section(report: StudyReport) -> Section:
    """One paragraph a set; then repeatability, simulation, and what is missing."""
    blocks = [Words(_of_set(one), "lead") for one in report.compared]
    for text in (_repeatability(report), _simulation(report)):
        if text:
            blocks.append(Words(text, "lead"))
    blocks += [Words(text, "warning") for text in _missing(report)]
    return Section("Verdict", tuple(blocks))


def name_of(one: ComparedSet) -> str:
    """The title of a set, cut."""
    return cut(one.chosen.title, 70)


def pair_name(pair: Pair, length: int = 30) -> str:
    """Two designs as words of a sentence."""
    return f"{cut(pair.a, length)} and {cut(pair.b, length)}"


def _of_set(one: ComparedSet) -> str:
    if one.found is None:
        return f"{name_of(one)}: not compared. {one.reason}"
    first = verdict(one.found)
    return " ".join(filter(None, (f"{name_of(one)}: {first[0].lower()}{first[1:]}", _of_pairs(one.found))))


def _of_pairs(found: Comparison) -> str:
    """Which pairs Tukey's test tells apart, and which not."""
    tested = [pair for pair in found.tukey if pair.p is not None]
    if not tested:
        return ""
    alike = [pair for pair in tested if pair.p is not None and pair.p >= found.alpha]
    largest = max(pair.p for pair in tested if pair.p is not None)
    if not alike:
        every = "Its one pair differs" if len(tested) == 1 else f"Each of the {len(tested)} pairs differs"
        return f"{every} (Tukey HSD, {'largest ' * (len(tested) > 1)}{p_equals(largest)})."
    listed = "; ".join(f"{pair_name(pair)} ({p_equals(pair.p)})" for pair in alike[:_MOST_PAIRS])
    more = f"; and {len(alike) - _MOST_PAIRS} more" if len(alike) > _MOST_PAIRS else ""
    differ = len(tested) - len(alike)
    return f"Tukey HSD tells {differ} of {len(tested)} pairs apart; not shown to differ: {listed}{more}."


def _repeatability(report: StudyReport) -> str:
    found = report.whole.found
    if found is None:
        return ""
    places = report.places
    own, limit = found.repeatability.sample_sd, 2.8 * found.repeatability.sample_sd
    spreads = [group.sd for group in found.groups if group.sd is not None]
    text = (
        f"Repeatability: samples of one design scatter with SD {number(own, places).text}° about its mean (pooled; "
        f"{number(min(spreads), places).text} to {number(max(spreads), places).text}° by design), so two samples of one design differ "
        f"by less than {number(limit, places).text}° in 95 % of cases."
    )
    if found.repeatability.replicate == "cycle" and found.repeatability.pooled.s_r is not None:
        text += f" Cycles of one sample scatter with SD {number(found.repeatability.pooled.s_r, places + 1).text}°."
    return text


def _simulation(report: StudyReport) -> str:
    errors = [error for design in report.values.designs if (error := error_of(design)) is not None]
    if not errors:
        return ""
    places, many = report.places, len(errors) > 1
    rmse = math.sqrt(sum(error * error for error in errors) / len(errors))
    span = (
        f"{_signed(min(errors), places)} to {_signed(max(errors), places)}°"
        if many
        else f"{_signed(errors[0], places)}°"
    )
    ends = (
        f": mean |error| {number(sum(map(abs, errors)) / len(errors), places).text}°, RMSE {number(rmse, places).text}°"
    )
    return f"Simulated less measured angle: {span} ({len(errors)} design{'s' * many}){ends * many}."


def _missing(report: StudyReport) -> list[str]:
    values = report.values
    told = [
        (len(values.failures), "without a value", "failed or missing"),
        (len(values.left_out), "left out", "by the study file"),
    ]
    parts = [f"{count} {what} ({how})" for count, what, how in told if count]
    return [f"Not everything counts: {'; '.join(parts)}. See “Left out and failed”."] if parts else []


def _signed(value: float, places: int) -> str:
    text = number(value, places).text
    return f"+{text}" if value > 0 and text.strip("0.") else text


def joined(items: Sequence[str], most: int = 5) -> str:
    """Items as words; of many, the first.

    >>> joined(["a", "b", "c"], 2)
    'a, b and 1 more'
    """
    return ", ".join(items[:most]) + (f" and {len(items) - most} more" if len(items) > most else "")
