"""Whether designs differ, as tables: tests of all at once, of pairs, what the tests assume, what they can see, and warnings."""

from __future__ import annotations

from collections.abc import Iterator

from benchlab.report.document import NONE, Block, Cell, Column, Table, Words, cut
from benchlab.report.rounding import count, digits, number, probability, words
from benchlab.report.study.report import ComparedSet, StudyReport, found_sets, joined, name_of, span_text
from benchlab.stats.comparison import Comparison
from benchlab.stats.pairs import Pair
from benchlab.stats.power import WANTED
from benchlab.stats.wording import STARS_LEGEND, stars


def tests_table(report: StudyReport) -> Table:
    """A row a set: the classical ANOVA and Welch's."""
    columns = (
        Column("set", "set", False), Column("groups"), Column("samples"), Column("F", "F"),
        Column("df_between"), Column("df_within"), Column("", "df"), Column("p", "p"), Column("eta_squared", "η²"),
        Column("effect_low"), Column("effect_high"), Column("", f"η²: {report.percent} interval"), Column("omega_squared", "ω²"),
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
        words(one.chosen.title, 70), count(len(found.groups)), count(sum(group.n for group in found.groups)),
        digits(anova.F, 5), count(anova.df[0]), count(anova.df[1]), Cell(None, f"{anova.df[0]}, {anova.df[1]}"),
        probability(anova.p, 0.0), number(anova.eta_squared, 3), number(low, 3), number(high, 3),
        Cell(None, span_text(low, high, 3)), number(anova.omega_squared, 3), digits(welch.F, 5), number(of_welch[0], 2),
        number(of_welch[1], 2), Cell(None, NONE if welch.df is None else f"{welch.df[0]:g}, {welch.df[1]:.2f}"),
        probability(welch.p, 0.0),
    )  # fmt: skip


def pairs_table(report: StudyReport) -> Table:
    """A row a pair and set: its difference with both intervals and p-values, and Hedges' g."""
    columns = (
        Column("set"), Column("a"), Column("b"), Column("", "pair", False),
        Column("difference_deg", "difference (°)"), Column("tukey_low_deg"), Column("tukey_high_deg"),
        Column("", "Tukey interval (°)"), Column("tukey_p", "Tukey p"), Column("stars", "stars", False),
        Column("games_howell_low_deg"), Column("games_howell_high_deg"),
        Column("", "Games–Howell interval (°)"), Column("games_howell_p", "Games–Howell p"),
        Column("hedges_g", "Hedges’ g"), Column("hedges_g_low"), Column("hedges_g_high"),
    )  # fmt: skip
    rows = [
        _pair_row(one, pair, other, report.places)
        for one, found in found_sets(report)
        for pair, other in zip(found.tukey, found.games_howell)
    ]
    note = f"Simultaneous {report.percent} intervals for all pairs of a set. Stars of Tukey’s p as the paper defines them: {STARS_LEGEND}."
    return Table(
        "pairs", "All pairs of each set: the first design less the second.", columns, tuple(rows), note, by="set"
    )


def _pair_row(one: ComparedSet, pair: Pair, other: Pair, places: int) -> tuple[Cell, ...]:
    return (
        words(one.chosen.title, 70), words(pair.a), words(pair.b),
        Cell(None, f"{cut(pair.b, 28)} − {cut(pair.a, 28)}"), number(pair.difference, places),
        number(pair.low, places), number(pair.high, places), Cell(None, span_text(pair.low, pair.high, places)),
        probability(pair.p), words(stars(pair.p)), number(other.low, places), number(other.high, places),
        Cell(None, span_text(other.low, other.high, places)), probability(other.p), digits(pair.g, 3), digits(pair.g_low, 3),
        digits(pair.g_high, 3),
    )  # fmt: skip


def assumptions_table(report: StudyReport) -> Table:
    """A row a set: Levene and Shapiro–Wilk."""
    columns = (
        Column("set", "set", False), Column("levene_F", "Levene F"), Column("levene_p", "Levene p"),
        Column("shapiro_W", "Shapiro–Wilk W"), Column("shapiro_p", "Shapiro–Wilk p"), Column("note", "note", False),
    )  # fmt: skip
    rows: list[tuple[Cell, ...]] = []
    for one, found in found_sets(report):
        levene, shapiro = found.assumptions.levene, found.assumptions.shapiro
        why = "; ".join(dict.fromkeys(reason for reason in (levene.reason, shapiro.reason) if reason))
        rows.append((
            words(one.chosen.title, 70), digits(levene.F), probability(levene.p), digits(shapiro.W), probability(shapiro.p), words(why, 90),
        ))  # fmt: skip
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
    columns = [
        Column("set"),
        Column("test", "test", False),
        Column("sd_deg", "pooled SD (°)"),
        Column("n", "samples a design"),
    ]
    columns += [Column(f"smallest_{100 * share:.0f}_deg", f"seen in {100 * share:.0f} % (°)") for share in WANTED]
    if wanted is not None:
        columns.append(Column("power", f"power for {wanted:g}°"))
        columns += [Column(f"samples_{100 * share:.0f}", f"samples for {100 * share:.0f} %") for share in WANTED]
    rows = []
    for one, power in known:
        for name, test in (("F test of all", power.anova), ("a pair, Tukey", power.pair)):
            row = [words(one.chosen.title, 70), words(name), number(power.sd, report.places), digits(power.n)]
            row += [number(value, report.places) for value in test.smallest]
            if wanted is not None:
                row += [number(test.power, 3), *map(count, test.samples or (None, None))]
            rows.append(tuple(row))
    note = (
        f"At a significance of {known[0][1].alpha:.2g} and with the scatter found here: the difference that is seen in so many of "
        "repeated studies. F test: two designs differ by so much and all others lie midway, the least that it can see."
    )
    caption = "The smallest difference of two designs that such a study sees."
    yield Table("power", caption, tuple(columns), tuple(rows), note, by="set")


def all_warnings(report: StudyReport) -> list[tuple[str, str]]:
    """(what about, what): warnings of the comparisons, each once with the sets that it is about, then those of recordings."""
    told: dict[str, list[str]] = {}
    for one, found in found_sets(report):
        for warning in found.warnings:
            told.setdefault(warning, []).append(name_of(one))
    of_sets = [(joined(names), warning) for warning, names in told.items()]
    return [*of_sets, *((one.what, one.why) for one in report.values.warnings)]
