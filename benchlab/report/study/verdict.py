"""The head of a report: what was found, in a few large numbers and in words."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from benchlab.errors import counted
from benchlab.force.curve import BlockedForce
from benchlab.report.document import Section, Tile, Tiles, Words, cut
from benchlab.report.rounding import decimals_of, number
from benchlab.report.study.origins import origins_mark, origins_words
from benchlab.report.study.published import paper_words
from benchlab.report.study.report import (
    ComparedSet,
    Scatter,
    StudyReport,
    error_of,
    mean_of,
    name_of,
    scatter_of,
    sd_of,
)
from benchlab.stats.comparison import Comparison
from benchlab.stats.pairs import Pair
from benchlab.stats.wording import p_equals

_MOST_PAIRS = 6
_FEW = 10
"""Degrees of freedom below which a limit is said to be uncertain."""


def verdict_section(report: StudyReport) -> Section:
    """Large numbers; then a paragraph a set, and on repeatability, simulation, the paper, and what is missing."""
    tiles = tuple(_tiles(report))
    return Section("Verdict", (*[Tiles(tiles)] * bool(tiles), *verdict_words(report)))


def verdict_words(report: StudyReport) -> list[Words]:
    """The verdict in words alone; first of all, what was not measured."""
    words, mark = origins_words(report.values), origins_mark(report.values)
    found = [Words(words, "warning")] if words else []
    found += [Words(_of_set(one), "lead", f"{name_of(one)}{', ' * bool(mark)}{mark}.") for one in report.compared]
    others = (
        ("Repeatability.", _repeatability(report)),
        ("Simulation.", _simulation(report)),
        ("The paper, which measured." if mark else "The paper.", paper_words(report)),
    )
    found += [Words(text, "lead", head) for head, text in others if text]
    return found + [Words(text, "warning") for text in _missing(report)]


def _tiles(report: StudyReport) -> Iterator[Tile]:
    places, found, own = report.places, report.whole.found, scatter_of(report)
    means = [(mean, design.name) for design in report.values.designs if (mean := mean_of(design)) is not None]
    if means:
        ends = dict.fromkeys((min(means), max(means)))
        value = "–".join(number(mean, places).text for mean, _ in ends)
        names = " to ".join(cut(name, 24) for _, name in ends)
        mark = origins_mark(report.values)
        yield Tile(f"{value}°", f"mean angle at {report.values.pressure_MPa:g} MPa{', ' * bool(mark)}{mark}", names)
    if own is not None:
        name = f"SD between samples of a design{', means of cycles' * _has_cycles(report)}"
        limit = f"{_rests_on(own, report)}; repeatability limit r, 2.8 SD: {number(own.limit_deg, places).text}°{_doubt(own)}"
        yield Tile(f"± {number(own.sd_deg, places).text}°", name, limit)
    tested = [pair for pair in found.tukey if pair.p is not None] if found is not None else []
    if found is not None and tested:
        told = [pair for pair in tested if _differ(pair, found)]
        unsure = len(_not_by_games_howell(found))
        but = f"; {unsure} of them not by Games–Howell" * bool(unsure)
        more = len(_by_games_howell_alone(found))
        but += f"; {more} more by Games–Howell" * bool(more)
        note = f"by Tukey HSD at {found.alpha:.3g}, all designs{but}"
        yield Tile(f"{len(told)} of {len(tested)}", "pairs of designs told apart", note)
    forces = [(force, one.name) for one in report.values.designs if isinstance(force := one.force, BlockedForce)]
    if len(forces) == 1:
        force, name = forces[0]
        note = f"{cut(name, 24)}, mean ± SD of {force.n[-1]} actuators"
        yield Tile(_force(force), f"blocked force at {force.pressure_MPa[-1]:g} MPa", note)
    errors = _errors(report)
    if len(errors) > 1:
        yield Tile(f"{number(_rms(errors), places).text}°", "error of the simulation, RMS", _span(errors, places))
    elif errors:
        yield Tile(_span(errors, places), "error of the simulation", "simulated less measured")


def _force(force: BlockedForce) -> str:
    mean, sd = float(force.over_actuators_N[-1]), float(force.sd_N[-1])
    places = decimals_of(sd) if math.isfinite(sd) else 1
    spread = f" ± {number(sd, places).text}" * math.isfinite(sd)
    return f"{'≥ ' * bool(force.lower_bound[:, -1].any())}{number(mean, places).text}{spread} N".replace(" ", "\u00a0")


def _of_set(one: ComparedSet) -> str:
    found = one.found
    if found is None:
        return f"Not compared: {one.reason}"
    anova, welch = found.anova, found.welch
    if anova.p is None:
        return f"No test: {anova.reason}."
    differ = anova.p < found.alpha
    head = "The designs differ" if differ else "No difference between the designs is shown"
    second = f"Welch {welch.reason}"
    if welch.p is not None:
        second = f"Welch {'agrees' if (welch.p < found.alpha) == differ else 'DISAGREES'}, {p_equals(welch.p, 0)}"
    return " ".join(filter(None, (f"{head} (ANOVA {p_equals(anova.p, 0)}; {second}).", _of_pairs(found))))


def _of_pairs(found: Comparison) -> str:
    """Which pairs Tukey's test tells apart, and which not."""
    tested = [pair for pair in found.tukey if pair.p is not None]
    if len(tested) < 2:
        return ""
    alike = [pair for pair in tested if not _differ(pair, found)]
    if not alike:
        largest = max(pair.p for pair in tested if pair.p is not None)
        text = f"Each of the {len(tested)} pairs differs too (Tukey HSD, largest {p_equals(largest)})"
    elif len(alike) == len(tested):
        text = f"Tukey HSD tells none of the {len(tested)} pairs apart"
    else:
        listed = _listed(alike, " and ")
        text = f"Tukey HSD tells {len(tested) - len(alike)} of {len(tested)} pairs apart; not shown to differ: {listed}"
    return f"{text}.{_but_games_howell(found)}"


def _but_games_howell(found: Comparison) -> str:
    """The pairs on which Games–Howell, which does not take variances to be equal, disagrees with Tukey."""
    fewer, more = _not_by_games_howell(found), _by_games_howell_alone(found)
    text = f" But Games–Howell does not tell apart {_listed(fewer, '–')}." if fewer else ""
    return text + (f" But Games–Howell does tell apart {_listed(more, '–')}." if more else "")


def _not_by_games_howell(found: Comparison) -> list[Pair]:
    return [
        other
        for pair, other in zip(found.tukey, found.games_howell)
        if _differ(pair, found) and other.p is not None and not _differ(other, found)
    ]


def _by_games_howell_alone(found: Comparison) -> list[Pair]:
    return [
        other
        for pair, other in zip(found.tukey, found.games_howell)
        if pair.p is not None and not _differ(pair, found) and _differ(other, found)
    ]


def _listed(pairs: Sequence[Pair], between: str) -> str:
    listed = "; ".join(
        f"{cut(pair.a, 30)}{between}{cut(pair.b, 30)} ({p_equals(pair.p)})" for pair in pairs[:_MOST_PAIRS]
    )
    return listed + (f"; and {len(pairs) - _MOST_PAIRS} more" if len(pairs) > _MOST_PAIRS else "")


def _differ(pair: Pair, found: Comparison) -> bool:
    return pair.p is not None and pair.p < found.alpha


def _repeatability(report: StudyReport) -> str:
    own, places, found = scatter_of(report), report.places, report.whole.found
    if own is None:
        return ""
    spreads = [sd for design in report.values.designs if (sd := sd_of(design)) is not None]
    low, high = (number(sd, places).text for sd in (min(spreads), max(spreads)))
    by_design = f"; {low} to {high}° by design" * (low != high)
    each = ", each with the mean of its cycles," * _has_cycles(report)
    text = (
        f"Samples of one design{each} scatter about their mean with SD {number(own.sd_deg, places).text}° "
        f"({_rests_on(own, report)}{by_design}); the repeatability limit r, 2.8 SD, is {number(own.limit_deg, places).text}°{_doubt(own)}."
    )
    if found is not None and found.repeatability.replicate == "cycle":
        text += f" Cycles of one sample scatter with SD {number(found.repeatability.pooled.s_r, places + 1).text}°."
    return text


def _has_cycles(report: StudyReport) -> bool:
    return any(len(sample.cycles) > 1 for design in report.values.designs for sample in design.counted)


def _doubt(own: Scatter) -> str:
    return "; few degrees of freedom: r is itself uncertain" * (own.df < _FEW)


def _rests_on(own: Scatter, report: StudyReport) -> str:
    """The interval of a scatter and its degrees of freedom; no interval where nothing scatters."""
    degrees = f"{own.df} {'degree' if own.df == 1 else 'degrees'} of freedom"
    low, high = (number(end, report.places).text for end in (own.low_deg, own.high_deg))
    return f"{report.percent} interval {low} to {high}°, {degrees}" if own.sd_deg > 0 else degrees


def _simulation(report: StudyReport) -> str:
    errors, places = _errors(report), report.places
    if not errors:
        return ""
    text = f"Simulated less measured angle is {_span(errors, places)} ({counted(len(errors), 'design')})"
    if len(errors) > 1:
        mean = sum(map(abs, errors)) / len(errors)
        text += f"; mean |error| {number(mean, places).text}°, RMSE {number(_rms(errors), places).text}°"
    return f"{text}."


def _missing(report: StudyReport) -> list[str]:
    values = report.values
    told = (
        (len(values.failures), "without a value (failed or missing)"),
        (len(values.left_out), "left out"),
    )
    parts = [f"{count} {what}" for count, what in told if count]
    return [f"Not everything counts: {'; '.join(parts)}. See “Left out and failed”."] if parts else []


def _errors(report: StudyReport) -> list[float]:
    return [error for design in report.values.designs if (error := error_of(design)) is not None]


def _rms(errors: Sequence[float]) -> float:
    return math.sqrt(sum(error * error for error in errors) / len(errors))


def _span(errors: Sequence[float], places: int) -> str:
    signed = [f"+{text}" if error > 0 and text.strip("0.") else text for error in (min(errors), max(errors))
              if (text := number(error, places).text)]  # fmt: skip
    return f"{signed[0]}°" if len(errors) == 1 else f"{signed[0]} to {signed[1]}°"
