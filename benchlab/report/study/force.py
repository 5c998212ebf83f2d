"""The report's section on blocked force: figures, forces by pressure, lines with their linearity, and what the lever arm is."""

from __future__ import annotations

import math
from collections.abc import Iterator

from benchlab.errors import BenchlabError, counted
from benchlab.force.curve import BlockedForce
from benchlab.io.published import BLOCKED_FORCE
from benchlab.io.study_values import DesignValues
from benchlab.report.document import NONE, Block, Cell, Column, Pictures, Section, Table, Words, cut
from benchlab.report.force_figure import draw_force_panel, linearity_words, places_of
from benchlab.report.rounding import count, decimals_of, digits, number, probability, words
from benchlab.report.study.pictures import file_names
from benchlab.report.study.report import StudyReport, span_text
from benchlab.report.svg import panel_of
from benchlab.stats.comparison import compare_summaries
from benchlab.stats.wording import p_equals

MOST_PANELS = 12

FORCE = "Blocked force"
"""Title of the section."""


def force_section(report: StudyReport) -> Section | None:
    """None where no design of the study has a blocked force."""
    known = [(design, design.force) for design in report.values.designs if design.force is not None]
    return Section(FORCE, tuple(_blocks(known))) if known else None


def _blocks(known: list[tuple[DesignValues, BlockedForce]]) -> Iterator[Block]:
    for design, force in known:
        yield Words(_found(force), head=f"{cut(design.name, 40)}:")
        if (beside := _beside_paper(design, force)) is not None:
            yield Words(beside)
    drawn = known[:MOST_PANELS]
    panels = tuple(
        panel_of(draw_force_panel(force, design.name, _paper(design, force)), f"force_{name}", f"Blocked force of {cut(design.name, 40)}")
        for (design, force), name in zip(drawn, file_names([design.name for design, _ in drawn]))
    )  # fmt: skip
    off = f" The first {MOST_PANELS} of {len(known)} designs are drawn." if len(known) > MOST_PANELS else ""
    yield Pictures(
        panels,
        "Blocked force against pressure. Points: actuators, each the mean of its cycles’ peaks, drawn side by side. Whiskers: ± 1 standard "
        f"deviation between actuators. Line and band: mean of the actuators’ own lines with its interval; dashed: extended.{off}",
    )
    yield _forces_table(known)
    if any(force.line is not None for _, force in known):
        yield _lines_table(known)
    for design, force in known:
        yield Words(_lever(design, force), head=f"Lever arm, {cut(design.name, 40)}:")
    for design, force in known:
        for text in force.notes:
            yield Words(f"{cut(text, 300)}.", "warning", f"{cut(design.name, 40)}:")


def _found(force: BlockedForce) -> str:
    """The largest force and whether the line is straight, in words."""
    last, places = len(force.pressure_MPa) - 1, _places(force)
    spread = "" if not math.isfinite(force.sd_N[last]) else f" ± {number(float(force.sd_N[last]), places).text}"
    bound = "≥ " * bool(force.lower_bound[:, last].any())
    size = f"{counted(int(force.n[last]), 'actuator')}, {counted(int(force.cycles.sum()), 'cycle')} at {counted(last + 1, 'pressure')}"
    text = f"{bound}{number(float(force.over_actuators_N[last]), places).text}{spread} N at {force.pressure_MPa[last]:g} MPa ({size})."
    if force.line is None:
        return f"{text} No line: {force.line_reason}."
    straight = force.line.linearity
    if straight is None:
        return f"{text} Linearity was not tested, which needs two actuators and three pressures."
    shown = straight.p < 1 - force.line.confidence
    verdict = "It is not linear in pressure" if shown else "Nothing speaks against a line"
    return f"{text} {verdict}: {'; '.join(linearity_words(force.line))}."


def _paper(design: DesignValues, force: BlockedForce) -> tuple[float, float, float] | None:
    """Pressure, mean and SD of the paper, where it is the same design at a pressure that was measured."""
    there = BLOCKED_FORCE.design == design.shell and any(
        abs(force.pressure_MPa - BLOCKED_FORCE.pressure_MPa) <= force.tolerance_MPa
    )
    return (BLOCKED_FORCE.pressure_MPa, BLOCKED_FORCE.mean_N, BLOCKED_FORCE.sd_N) if there else None


def _beside_paper(design: DesignValues, force: BlockedForce) -> str | None:
    paper = _paper(design, force)
    if paper is None:
        return None
    at = int(abs(force.pressure_MPa - paper[0]).argmin())
    n, mean, sd = int(force.n[at]), float(force.over_actuators_N[at]), float(force.sd_N[at])
    text = f"The paper gives {paper[1]:g} ± {paper[2]:g} N for this design at {paper[0]:g} MPa ({BLOCKED_FORCE.actuators} actuators)"
    if force.lower_bound[:, at].any() or not (n > 1 and sd > 0):
        return f"{text}."
    try:
        pair = compare_summaries(
            ["paper", "here"], [BLOCKED_FORCE.actuators, n], [paper[1], mean], [paper[2], sd]
        ).games_howell[0]
    except BenchlabError:
        return f"{text}."
    places = _places(force)
    span = span_text(pair.low, pair.high, places)
    return (
        f"{text}: here − paper {number(mean - paper[1], places).text} N ({span} N; Welch’s t test, {p_equals(pair.p)})."
    )


def _forces_table(known: list[tuple[DesignValues, BlockedForce]]) -> Table:
    columns = (
        Column("design"), Column("pressure_MPa", "pressure (MPa)"), Column("actuators", "actuators"), Column("cycles", "cycles"),
        Column("mean_N", "mean (N)"), Column("sd_N", "SD (N)"), Column("lower_bound"), Column("line_N", "line (N)"), Column("line_low_N"),
        Column("line_high_N"), Column("", "band of the line (N)"),
    )  # fmt: skip
    rows = tuple(row for design, force in known for row in _force_rows(design, force))
    note = "SD: between actuators, each the mean of its cycles."
    return Table("blocked_force", "Blocked force.", columns, rows, note, by="design")


def _force_rows(design: DesignValues, force: BlockedForce) -> Iterator[tuple[Cell, ...]]:
    line = None if force.line is None else force.line.at(force.pressure_MPa)
    places = _places(force)
    for j, pressure in enumerate(force.pressure_MPa.tolist()):
        bound = bool(force.lower_bound[:, j].any())
        mean = number(float(force.over_actuators_N[j]), places)
        middle, low, high = (None, None, None) if line is None else (float(values[j]) for values in line)
        ends = None if low is None or not math.isfinite(low) else span_text(low, high, places)
        yield (
            words(design.name, 40), digits(pressure, 4), count(int(force.n[j])), count(int(force.cycles[:, j].sum())),
            Cell(mean.value, "≥ " * bound + mean.text), number(float(force.sd_N[j]), places), count(int(bound)), number(middle, places),
            number(low, places), number(high, places), Cell(None, ends or NONE),
        )  # fmt: skip


def _lines_table(known: list[tuple[DesignValues, BlockedForce]]) -> Table:
    columns = (
        Column("design", "design", False), Column("slope_N_per_MPa", "slope (N/MPa)"),
        Column("slope_low_N_per_MPa"), Column("slope_high_N_per_MPa"),
        Column("", "interval"), Column("intercept_N", "at 0 MPa (N)"), Column("intercept_low_N"), Column("intercept_high_N"),
        Column("", "interval"), Column("through_origin_N_per_MPa", "slope through 0 (N/MPa)"), Column("r_squared", "R²"),
        Column("residual_sd_N", "residual SD (N)"), Column("lack_of_fit_F", "lack of fit F"), Column("lack_of_fit_p", "p"),
        Column("bow_N"), Column("bow_p"),
    )  # fmt: skip
    rows = tuple(_line_row(design, force) for design, force in known if force.line is not None)
    note = (
        "Mean of the actuators’ own least-squares lines; intervals are t intervals over actuators. Residual SD: about their own lines. "
        "Lack of fit: deviations of the mean from a line against those of single actuators."
    )
    return Table("blocked_force_lines", "Lines of force against pressure.", columns, rows, note)


def _line_row(design: DesignValues, force: BlockedForce) -> tuple[Cell, ...]:
    line = force.line
    assert line is not None
    slope, start, straight, places = line.slope_N_per_MPa, line.intercept_N, line.linearity, _places(force)
    steep = decimals_of((slope.high - slope.low) / 2) if math.isfinite(slope.low) else 1
    ends = [
        span_text(one.low, one.high, decimals) if math.isfinite(one.low) else NONE
        for one, decimals in ((slope, steep), (start, places))
    ]
    return (
        words(design.name, 40), number(slope.value, steep), number(slope.low, steep), number(slope.high, steep), Cell(None, ends[0]),
        number(start.value, places), number(start.low, places), number(start.high, places), Cell(None, ends[1]),
        number(line.through_origin_N_per_MPa.value, steep), number(line.r_squared, 4), digits(line.residual_sd_N, 2),
        digits(None if straight is None else straight.F), probability(None if straight is None else straight.p),
        number(None if straight is None else straight.bow_N.value, places),
        probability(None if straight is None or not math.isfinite(straight.bow_p) else straight.bow_p),
    )  # fmt: skip


def _lever(design: DesignValues, force: BlockedForce) -> str:
    """What a force says of the actuator depends on where it acts; p·π·R³ is the moment of the pressure on the end of a round tube about
    its edge."""
    force_N, pressure = float(force.over_actuators_N[-1]), float(force.pressure_MPa[-1])
    moment = None if design.shell is None else pressure * math.pi * (design.shell.diameter_mm / 2) ** 3
    if force.lever_arm_mm is not None:
        text = f"{force.lever_arm_mm:g} mm, so that the moment at {pressure:g} MPa is {force_N * force.lever_arm_mm:.0f} N·mm"
        return (
            f"{text}."
            if moment is None
            else f"{text}; that of a round tube held straight, p·π·R³, would be {moment:.0f} N·mm."
        )
    text = (
        "the study does not state it (lever_arm_mm), and the paper does not describe its fixture. These forces compare only with those "
        "of the same fixture."
    )
    if moment is None or not force_N > 0:
        return text
    return (
        f"{text} A round tube of this perimeter held straight has a moment of about p·π·R³ = {moment:.0f} N·mm at {pressure:g} MPa; "
        f"the force would be that at a lever arm of {moment / force_N:.1f} mm."
    )


def _places(force: BlockedForce) -> int:
    return places_of(float(force.over_actuators_N[-1]), float(force.sd_N[-1]))
