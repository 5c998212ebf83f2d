"""The statistics of a report as tables: tests, pairs, where the scatter comes from, what the tests assume, power."""

from __future__ import annotations

from collections.abc import Iterator

from benchlab.report.document import Block, Cell, Column, Table, Words, cut
from benchlab.report.rounding import NONE, count, digits, number, words
from benchlab.report.study.report import ComparedSet, StudyReport
from benchlab.report.study.verdict import joined, name_of
from benchlab.stats.comparison import Comparison
from benchlab.stats.components import Component
from benchlab.stats.pairs import Pair
from benchlab.stats.power import WANTED
from benchlab.stats.wording import STARS_LEGEND, p_text, stars


def found_sets(report: StudyReport) -> list[tuple[ComparedSet, Comparison]]:
    """The sets that could be compared, with what was found."""
    return [(one, one.found) for one in report.compared if one.found is not None]


def tests_table(report: StudyReport) -> Table:
    """A row a set: the classical ANOVA and Welch's."""
    columns = (
        Column("set", "set", False), Column("groups", "designs"), Column("samples", "samples"), Column("F", "F"),
        Column("df_between"), Column("df_within"), Column("", "df"), Column("p", "p"), Column("eta_squared", "η²"),
        Column("effect_low"), Column("effect_high"), Column("", "95 % interval"), Column("omega_squared", "ω²"),
        Column("welch_F", "Welch F"), Column("welch_df_between"), Column("welch_df_within"), Column("", "df"),
        Column("welch_p", "Welch p"),
    )  # fmt: skip
    rows = tuple(_test_row(one, found) for one, found in found_sets(report))
    note = (
        "F: one-way analysis of variance of sample means. η²: share of the sum of squares between designs, with the interval of "
        "its population value λ/(λ + N); ω²: the same without its bias. Welch's test does not take variances to be equal."
    )
    return Table("tests", "Do the designs of a set differ?", columns, rows, note)


def _test_row(one: ComparedSet, found: Comparison) -> tuple[Cell, ...]:
    anova, welch = found.anova, found.welch
    low, high = anova.interval or (None, None)
    of_welch: tuple[float | None, float | None] = welch.df or (None, None)
    return (
        words(name_of(one)), count(len(found.groups)), count(sum(group.n for group in found.groups)),
        digits(anova.F, 5), count(anova.df[0]), count(anova.df[1]), Cell(None, f"{anova.df[0]}, {anova.df[1]}"),
        probability(anova.p, 0.0), number(anova.eta_squared, 3), number(low, 3), number(high, 3),
        Cell(None, _span(low, high, 3)), number(anova.omega_squared, 3), digits(welch.F, 5), number(of_welch[0], 2),
        number(of_welch[1], 2), Cell(None, NONE if welch.df is None else f"{welch.df[0]:g}, {welch.df[1]:.2f}"),
        probability(welch.p, 0.0),
    )  # fmt: skip


def pairs_table(report: StudyReport) -> Table:
    """A row a pair and set: its difference with both intervals and p-values, and Hedges' g."""
    columns = (
        Column("set", "set", False), Column("a", "a", False), Column("b", "b", False),
        Column("difference_deg", "b − a (°)"), Column("tukey_low_deg"), Column("tukey_high_deg"), Column("", "Tukey interval (°)"),
        Column("tukey_p", "Tukey p"), Column("stars", "stars", False), Column("games_howell_low_deg"),
        Column("games_howell_high_deg"), Column("", "Games–Howell interval (°)"), Column("games_howell_p", "Games–Howell p"),
        Column("hedges_g", "Hedges’ g"), Column("hedges_g_low"), Column("hedges_g_high"),
    )  # fmt: skip
    rows = [
        _pair_row(one, pair, other, report.places)
        for one, found in found_sets(report)
        for pair, other in zip(found.tukey, found.games_howell)
    ]
    note = f"Simultaneous 95 % intervals for all pairs of a set. Stars of Tukey’s p as the paper defines them: {STARS_LEGEND}."
    return Table("pairs", "All pairs.", columns, tuple(rows), note)


def _pair_row(one: ComparedSet, pair: Pair, other: Pair, places: int) -> tuple[Cell, ...]:
    return (
        words(name_of(one)), words(pair.a, 30), words(pair.b, 30), number(pair.difference, places),
        number(pair.low, places), number(pair.high, places), Cell(None, _span(pair.low, pair.high, places)),
        probability(pair.p), words(stars(pair.p)), number(other.low, places), number(other.high, places),
        Cell(None, _span(other.low, other.high, places)), probability(other.p), digits(pair.g, 3), digits(pair.g_low, 3),
        digits(pair.g_high, 3),
    )  # fmt: skip


def components_blocks(report: StudyReport) -> Iterator[Block]:
    """Variance components and repeatability limits of each set, and of each design."""
    sets = found_sets(report)
    if not sets:
        return
    places = report.places
    columns = (
        Column("set", "set", False), Column("cycle_sd_deg", "cycles of a sample, SD (°)"), Column("cycle_low_deg"),
        Column("cycle_high_deg"), Column("sample_sd_deg", "samples of a design, SD (°)"), Column("sample_low_deg"),
        Column("sample_high_deg"), Column("", "95 % interval (°)"), Column("design_sd_deg", "designs, SD (°)"),
        Column("s_r_deg", "s_r (°)"), Column("r_deg", "r (°)"), Column("s_R_deg", "s_R (°)"), Column("R_deg", "R (°)"),
        Column("method", "method", False),
    )  # fmt: skip
    rows = []
    for one, found in sets:
        parts, pooled = found.components, found.repeatability.pooled
        rows.append((
            words(name_of(one)), *_component(parts.cycle, places + 1), *_component(parts.sample, places),
            Cell(None, _span(parts.sample.low, parts.sample.high, places)), number(parts.design.sd, places),
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
    if found.repeatability.replicate == "cycle":
        return (
            "After ISO 5725-2 and ASTM E691, a sample standing for a laboratory and its cycles for replicates: s_r is the scatter of "
            "cycles, s_R that of one cycle of any sample; r and R are 2.8 times these: two cycles of one sample, and of two samples, "
            "differ by less in 95 % of cases. Designs were chosen, not drawn at random: their SD only describes."
        )
    return (
        "After ISO 5725-2 and ASTM E691, with samples as the replicates: s_r is the scatter of samples of one design and r, 2.8 times "
        "that, the difference that two of them stay below in 95 % of cases. With one cycle a sample there is no s_R. Designs were "
        "chosen, not drawn at random: their SD only describes."
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
            f"Beyond a critical value of h or k: {joined(beyond, 8)}. Look at these samples; nothing was left out for it.",
            "warning",
        )
    tested = any(value is not None for cell in cells for value in (cell.h, cell.k))
    return Words(
        "No sample is beyond a critical value of h or k."
        if tested
        else "h and k are not defined here: too few replicates."
    )


def assumptions_table(report: StudyReport) -> Table:
    """A row a set: Levene and Shapiro–Wilk."""
    columns: tuple[Column, ...] = (
        Column("set", "set", False), Column("levene_F", "Levene F"), Column("levene_p", "Levene p"),
        Column("shapiro_W", "Shapiro–Wilk W"), Column("shapiro_p", "Shapiro–Wilk p"), Column("note", "note", False),
    )  # fmt: skip
    rows: list[tuple[Cell, ...]] = []
    for one, found in found_sets(report):
        levene, shapiro = found.assumptions.levene, found.assumptions.shapiro
        why = "; ".join(dict.fromkeys(reason for reason in (levene.reason, shapiro.reason) if reason))
        rows.append((
            words(name_of(one)), digits(levene.F), probability(levene.p), digits(shapiro.W), probability(shapiro.p), words(why, 90),
        ))  # fmt: skip
    if not any(row[-1].value for row in rows):
        columns, rows = columns[:-1], [row[:-1] for row in rows]
    note = (
        "Equal variances (Brown and Forsythe’s form of Levene’s test, about medians) and normal residuals. Reported, not used to "
        "choose a test: with so few samples they see little, so both kinds of test are always given."
    )
    return Table("assumptions", "What the classical tests assume.", columns, tuple(rows), note)


def power_blocks(report: StudyReport) -> Iterator[Block]:
    """The smallest differences that the present scatter lets one see, and the samples that a wanted difference takes."""
    known = [(one, found.power) for one, found in found_sets(report) if found.power is not None]
    if not known:
        yield Words("Nothing scatters: there is no power to tell.")
        return
    wanted = known[0][1].difference
    columns = [Column("set", "set", False), Column("sd_deg", "pooled SD (°)"), Column("n", "n a design")]
    for test, name in (("anova", "F test"), ("pair", "a pair, Tukey")):
        columns += [
            Column(f"{test}_smallest_{100 * share:.0f}_deg", f"{name}: seen with {100 * share:.0f} % (°)")
            for share in WANTED
        ]
        if wanted is not None:
            columns += [Column(f"{test}_power", f"{name}: power for {wanted:g}°")]
            columns += [
                Column(f"{test}_samples_{100 * share:.0f}", f"{name}: n for {100 * share:.0f} %") for share in WANTED
            ]
    rows = []
    for one, power in known:
        row = [words(name_of(one)), number(power.sd, report.places), digits(power.n)]
        for of_test in (power.anova, power.pair):
            row += [number(value, report.places) for value in of_test.smallest]
            if wanted is not None:
                row += [number(of_test.power, 3), *map(count, of_test.samples or (None, None))]
        rows.append(tuple(row))
    note = (
        f"At a significance of {known[0][1].alpha:.2g} and with the scatter found here. F test: two designs differ by so much and all "
        "others lie midway, the least that it can see."
    )
    yield Table(
        "power", "The smallest difference of two designs that such a study sees.", tuple(columns), tuple(rows), note
    )


def warnings_of(report: StudyReport) -> list[tuple[str, str]]:
    """What the comparisons warn of, each once, with the sets that it is about."""
    told: dict[str, list[str]] = {}
    for one, found in found_sets(report):
        for warning in found.warnings:
            told.setdefault(warning, []).append(name_of(one))
    return [(joined(names), warning) for warning, names in told.items()]


def probability(p: float | None, floor: float | None = None) -> Cell:
    """A probability as the page shows it; for tests of pairs not below what can be known."""
    if p is None:
        return Cell(None, NONE)
    return Cell(p, p_text(p) if floor is None else p_text(p, floor))


def _component(found: Component | None, places: int) -> tuple[Cell, Cell, Cell]:
    if found is None:
        return number(None), number(None), number(None)
    return number(found.sd, places), number(found.low, places), number(found.high, places)


def _span(low: float | None, high: float | None, places: int) -> str:
    return NONE if low is None or high is None else f"{number(low, places).text} to {number(high, places).text}"
