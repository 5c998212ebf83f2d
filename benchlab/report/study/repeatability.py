"""How well designs repeat, as tables and words: where the scatter comes from, limits, and samples that stand apart."""

from __future__ import annotations

from collections.abc import Iterator

from benchlab.report.document import Block, Cell, Column, Table, Words, cut
from benchlab.report.rounding import count, number, words
from benchlab.report.study.consistency_figure import what_of
from benchlab.report.study.report import StudyReport, found_sets, joined, span_text
from benchlab.stats.comparison import Comparison
from benchlab.stats.components import Component


def components_blocks(report: StudyReport) -> Iterator[Block]:
    """Variance components and repeatability limits of each set, and of each design."""
    sets = found_sets(report)
    if not sets:
        return
    places = report.places
    columns = (
        Column("set", "set", False), Column("cycle_sd_deg", "cycles of a sample, SD (°)"), Column("cycle_low_deg"),
        Column("cycle_high_deg"), Column("sample_sd_deg", "samples of a design, SD (°)"), Column("sample_low_deg"),
        Column("sample_high_deg"), Column("", f"{report.percent} interval (°)"), Column("design_sd_deg", "designs, SD (°)"),
        Column("s_r_deg", "s_r (°)"), Column("r_deg", "r (°)"), Column("s_R_deg", "s_R (°)"), Column("R_deg", "R (°)"),
        Column("method", "method", False),
    )  # fmt: skip
    rows = []
    for one, found in sets:
        parts, pooled = found.components, found.repeatability.pooled
        rows.append((
            words(one.chosen.title, 70), *_component(parts.cycle, places + 1), *_component(parts.sample, places),
            Cell(None, span_text(parts.sample.low, parts.sample.high, places)), number(parts.design.sd, places),
            number(pooled.s_r, places + 1), number(pooled.r, places + 1), number(pooled.s_R, places), number(pooled.R, places),
            words(parts.method),
        ))  # fmt: skip
    yield Table("components", "Where the scatter comes from.", columns, tuple(rows), _roles(sets[0][1]))
    yield _precisions(report)


def _precisions(report: StudyReport) -> Table:
    places, found = report.places, report.whole.found
    columns = (
        Column("design", "design", False), Column("samples", "n"), Column("sd_deg", "SD of samples (°)"), Column("s_r_deg", "s_r (°)"),
        Column("r_deg", "r (°)"), Column("s_R_deg", "s_R (°)"), Column("R_deg", "R (°)"),
    )  # fmt: skip
    rows = [] if found is None else [
        (
            words(one.name, 40), count(group.n), number(group.sd, places), number(one.s_r, places + 1), number(one.r, places + 1),
            number(one.s_R, places), number(one.R, places),
        )
        for one, group in zip(found.repeatability.designs, found.groups)
    ]  # fmt: skip
    return Table("repeatability", "Repeatability by design.", columns, tuple(rows))


def _roles(found: Comparison) -> str:
    """What plays which role in the terms of ISO 5725."""
    last = (
        "r and R are 2.8 times these, what two results would stay within in 95 % of cases if the SD were known exactly; with few "
        "degrees of freedom they are uncertain themselves. Designs were chosen, not drawn at random: their SD only describes."
    )
    if found.repeatability.replicate == "cycle":
        return (
            "After ISO 5725-2 and ASTM E691, a sample standing for a laboratory and its cycles for replicates: s_r is the scatter of "
            "cycles, s_R that of one cycle of any sample, r and R the limits for two cycles of one sample, and of two samples. The "
            "verdict has another SD and limit: those of samples, each with the mean of its cycles (by design: “SD of samples”, below). The "
            f"SD of samples in this table is a variance component, without the share of that scatter which comes from cycles. {last}"
        )
    return (
        "After ISO 5725-2 and ASTM E691, with samples as the replicates: s_r is the scatter of samples of one design and r the limit "
        "for two of them, for all designs of the set together; the verdict’s are of all designs. With one cycle a sample there is no "
        f"s_R. {last}"
    )


def consistency_table(report: StudyReport) -> Table:
    """h and k of every cell."""
    found = report.whole.found
    columns = (
        Column("design", "design", False), Column("sample", "sample", False), Column("n", "n"), Column("mean_deg", "mean (°)"),
        Column("sd_deg", "SD (°)"), Column("h", "h"), Column("h_critical", "critical h"), Column("k", "k"),
        Column("k_critical", "critical k"),
    )  # fmt: skip
    rows = tuple(
        (
            words(cell.level, 40), words(cell.laboratory, 40), count(cell.n), number(cell.mean, report.places),
            number(cell.sd, report.places + 1), number(cell.h), number(cell.h_critical), number(cell.k), number(cell.k_critical),
        )
        for cell in (() if found is None else found.repeatability.cells)
    )  # fmt: skip
    return Table("consistency", "h and k.", columns, rows)


def consistency_words(found: Comparison) -> Words:
    """The cells beyond a critical value, or that there is none."""
    cells = found.repeatability.cells
    beyond = []
    for cell in (cell for cell in cells if cell.outside):
        for name in ("h", "k"):
            value, critical = getattr(cell, name), getattr(cell, f"{name}_critical")
            if value is not None and critical is not None and abs(value) > critical:
                beyond.append(
                    f"{cut(f'{cell.level} {cell.laboratory}'.strip(), 40)} ({name} = {number(value).text}, critical {critical:.2f})"
                )
    if beyond:
        return Words(
            f"Beyond a critical value of h or k: {joined(beyond, 8)}. Look at them; nothing was left out for it.",
            "warning",
        )
    tested = any(value is not None for cell in cells for value in (cell.h, cell.k))
    return Words(
        f"No {what_of(cells)} is beyond a critical value of h or k."
        if tested
        else "h and k are not defined here: too few replicates."
    )


def _component(found: Component | None, places: int) -> tuple[Cell, Cell, Cell]:
    if found is None:
        return number(None), number(None), number(None)
    return number(found.sd, places), number(found.low, places), number(found.high, places)
