"""One comparison of groups as tables, for a terminal and for CSV files. `value`: what was compared, with its unit (`angle_deg`)."""

from __future__ import annotations

from collections.abc import Iterator

from benchlab.report.document import NONE, Cell, Column, Table, cut
from benchlab.report.rounding import count, decimals_of, digits, number, probability, words
from benchlab.stats.comparison import Comparison
from benchlab.stats.comparison_json import mean_interval
from benchlab.stats.components import Component
from benchlab.stats.pairs import Pair
from benchlab.stats.power import WANTED, Power
from benchlab.stats.wording import STARS_LEGEND, stars


def comparison_tables(found: Comparison, value: str) -> Iterator[Table]:
    """All tables, in the order in which they are read."""
    places = decimals_of(found.anova.ms_within**0.5)
    yield groups_table(found, value, places)
    yield tests_table(found)
    if found.tukey:
        yield pairs_table(found, value, places)
    yield components_table(found, value, places)
    yield consistency_table(found, value, places)
    if found.power is not None:
        yield power_table(found.power, value, places)


def groups_table(found: Comparison, value: str, places: int) -> Table:
    nested = found.cycles is not None
    columns = (
        Column("group", "group", False), Column("n", "samples"), Column("cycles" * nested, "cycles" * nested),
        Column(f"mean_{value}", "mean"), Column(f"sd_{value}", "SD"), Column(f"low_{value}"), Column(f"high_{value}"),
        Column("", f"{100 * found.confidence:g} % interval of the mean"),
    )  # fmt: skip
    rows = []
    for group, cycles in zip(found.groups, found.cycles or (None,) * len(found.groups)):
        low, high = mean_interval(group, found.confidence) or (None, None)
        rows.append((
            words(group.name, 30), count(group.n), count(cycles), number(group.mean, places), number(group.sd, places + 1),
            number(low, places), number(high, places), _span(low, high, places),
        ))  # fmt: skip
    note = "Each sample counts once, with the mean of its cycles." * nested
    return Table("groups", "Groups", columns, tuple(rows), note)


def tests_table(found: Comparison) -> Table:
    """The classical ANOVA and Welch's, and beside them what the first assumes."""
    columns = (
        Column("test", "test", False), Column("statistic", "", False), Column("value", ""), Column("", "statistic", False),
        Column("df_1"), Column("df_2"), Column("", "df", False), Column("p", "p"), Column("note", "", False), Column("", "note", False),
    )  # fmt: skip
    anova, welch, levene, shapiro = found.anova, found.welch, found.assumptions.levene, found.assumptions.shapiro
    low, high = anova.interval or (None, None)
    effect = (
        "" if anova.eta_squared is None
        else f"η² {anova.eta_squared:.3f} ({number(low, 3).text} to {number(high, 3).text}), ω² {anova.omega_squared:.3f}"
    )  # fmt: skip
    assumed = "assumed by the ANOVA; reported, not used to choose"
    rows = (
        _test("one-way ANOVA", "F", anova.F, anova.df, anova.p, anova.reason or effect),
        _test("Welch's ANOVA", "F", welch.F, welch.df, welch.p, welch.reason or "variances need not be equal"),
        _test("Levene (medians)", "F", levene.F, levene.df, levene.p, levene.reason or f"equal variances: {assumed}"),
        _test("Shapiro–Wilk", "W", shapiro.W, None, shapiro.p, shapiro.reason or f"normal residuals: {assumed}"),
    )
    return Table("tests", "Tests", columns, rows)


def _test(
    name: str, letter: str, value: float | None, df: tuple[float, float] | None, p: float | None, note: str
) -> tuple[Cell, ...]:
    a, b = df or (None, None)
    text = NONE if value is None else f"{letter} = {digits(value, 5).text}"
    return (
        words(name), Cell(letter, letter), digits(value, 5), Cell(None, text), digits(a), digits(b),
        Cell(None, "" if a is None or b is None else f"{a:g}, {b:.4g}"), probability(p, 0.0),
        Cell(note, ""), words(note, 90),
    )  # fmt: skip


def pairs_table(found: Comparison, value: str, places: int) -> Table:
    columns = (
        Column("a"), Column("b"), Column("", "pair", False), Column(f"difference_{value}", "difference"),
        Column(f"tukey_low_{value}"), Column(f"tukey_high_{value}"), Column("", "Tukey HSD"), Column("tukey_p"), Column("stars"),
        Column("", "p", False), Column(f"games_howell_low_{value}"), Column(f"games_howell_high_{value}"),
        Column("", "Games–Howell"), Column("games_howell_p", "p"), Column("hedges_g", "Hedges' g"),
        Column("hedges_g_low"), Column("hedges_g_high"), Column("", "interval"), Column("note"),
    )  # fmt: skip
    rows = tuple(_pair(one, other, places) for one, other in zip(found.tukey, found.games_howell))
    caption = f"Pairs, with {100 * found.confidence:g} % intervals"
    return Table("pairs", caption, columns, rows, f"Stars of Tukey's p, as the paper defines them: {STARS_LEGEND}.")


def _pair(one: Pair, other: Pair, places: int) -> tuple[Cell, ...]:
    reasons = [reason for reason in (one.reason, other.reason) if reason]
    marks = stars(one.p)
    tests = (("Tukey", one), ("Games–Howell", other))
    floored = [f"{name}: p < {test.p_below:.0e}, its digits are noise" for name, test in tests if test.p_below]
    note = "; ".join(dict.fromkeys([*reasons, *floored]))
    return (
        words(one.a), words(one.b), Cell(None, f"{cut(one.b, 24)} − {cut(one.a, 24)}"), number(one.difference, places),
        number(one.low, places), number(one.high, places), _span(one.low, one.high, places), probability(one.p), words(marks),
        Cell(None, f"{probability(one.p).text} {marks}".strip()),
        number(other.low, places), number(other.high, places), _span(other.low, other.high, places), probability(other.p),
        digits(one.g), digits(one.g_low), digits(one.g_high), _digits_span(one.g_low, one.g_high), words(note),
    )  # fmt: skip


def components_table(found: Comparison, value: str, places: int) -> Table:
    """Where the scatter comes from, and the limits of repeatability that follow."""
    columns = (
        Column("scatter_of", "scatter of", False), Column(f"sd_{value}", "SD"), Column(f"low_{value}"), Column(f"high_{value}"),
        Column("", f"{100 * found.confidence:g} % interval"), Column("df", "df"), Column("limit", "", False),
        Column(f"limit_{value}"), Column("", "limit (2.8 SD)", False), Column("method", "method", False),
    )  # fmt: skip
    parts, pooled, nested = found.components, found.repeatability.pooled, found.components.cycle is not None
    rows = []
    if parts.cycle is not None:
        rows.append(("cycles of a sample (s_r)", parts.cycle, "r", pooled.r))
    rows.append(
        (
            "samples of a group" if nested else "samples of a group (s_r)",
            parts.sample,
            *(("", None) if nested else ("r", pooled.r)),
        )
    )
    rows.append(("groups, as if drawn at random", parts.design, "", None))
    cells = [_component(*row, places, parts.method) for row in rows]
    if pooled.s_R is not None:
        total = Component(pooled.s_R**2, pooled.s_R**2, None, None, 0)
        cells.insert(2, _component("one cycle of any sample (s_R)", total, "R", pooled.R, places, parts.method))
    note = (
        "ISO 5725, ASTM E691, a sample standing for a laboratory: two cycles of one sample differ by less than r in 95 % of cases, of "
        "two samples of a group by less than R."
        if nested
        else "ISO 5725, ASTM E691: two samples of a group differ by less than r in 95 % of cases."
    )
    return Table("components", "Where the scatter comes from", columns, tuple(cells), note)


def _component(
    name: str, one: Component, letter: str, limit: float | None, places: int, method: str
) -> tuple[Cell, ...]:
    return (
        words(name), number(one.sd, places + 1), number(one.low, places + 1), number(one.high, places + 1),
        _span(one.low, one.high, places + 1), count(one.df or None), Cell(letter, letter), number(limit, places),
        Cell(None, f"{letter} = {number(limit, places).text}" if letter else ""), words(method),
    )  # fmt: skip


def consistency_table(found: Comparison, value: str, places: int) -> Table:
    """h and k of every cell; on the terminal only those beyond a critical value."""
    nested = found.repeatability.replicate == "cycle"
    columns = (
        Column("group", "group", False), Column("sample" * nested, "sample" * nested, False), Column("n", "n"),
        Column(f"mean_{value}", "mean"), Column(f"sd_{value}", "SD"), Column("h" * nested, "h" * nested),
        Column("h_critical" * nested, "critical" * nested), Column("k", "k"), Column("k_critical", "critical"),
        Column("outside"),
    )  # fmt: skip
    rows = tuple(
        (
            words(cell.level if nested else cell.laboratory, 30), words(cell.laboratory if nested else "", 30), count(cell.n),
            number(cell.mean, places), number(cell.sd, places + 1), number(cell.h), number(cell.h_critical), number(cell.k),
            number(cell.k_critical), Cell("yes" if cell.outside else "no", ""),
        )
        for cell in found.repeatability.cells
    )  # fmt: skip
    return Table("consistency", "Beyond a critical value of h or k", columns, rows, "Nothing was left out for it.")


def power_table(power: Power, value: str, places: int) -> Table:
    """What the present scatter lets one see."""
    wanted = power.difference
    columns = [Column("test", "test", False)]
    columns += [Column(f"smallest_{100 * share:.0f}_{value}", f"seen, {100 * share:.0f} %") for share in WANTED]
    if wanted is not None:
        columns += [Column(f"difference_{value}"), Column("power", f"power for {wanted:g}")]
        columns += [Column(f"samples_{100 * share:.0f}", f"n for {100 * share:.0f} %") for share in WANTED]
    rows = []
    for name, test in (("F test", power.anova), ("one pair, Tukey HSD", power.pair)):
        row = [words(name), *(number(value, places) for value in test.smallest)]
        if wanted is not None:
            row += [number(wanted), number(test.power, 3), *map(count, test.samples or (None, None))]
        rows.append(tuple(row))
    note = (
        f"With {power.n:.3g} samples a group that scatter by {number(power.sd, places + 1).text}, at {power.alpha:.2g}. F test: two groups "
        "differ by so much and all others lie midway, the least that it can see. n: samples in each group."
    )
    return Table("power", "The smallest difference that such a comparison sees", tuple(columns), tuple(rows), note)


def _span(low: float | None, high: float | None, places: int) -> Cell:
    return Cell(
        None, NONE if low is None and high is None else f"{number(low, places).text} to {number(high, places).text}"
    )


def _digits_span(low: float | None, high: float | None) -> Cell:
    return Cell(None, NONE if low is None or high is None else f"{digits(low).text} to {digits(high).text}")
