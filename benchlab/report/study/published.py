"""The study beside the paper: the same designs, the same pairs, and the paper's stars recomputed from its published table."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal

from benchlab.actuator import ShellDesign
from benchlab.io.published import PublishedAngle
from benchlab.io.study_values import DesignValues
from benchlab.report.document import NONE, Block, Cell, Column, Section, Table, Words, cut
from benchlab.report.rounding import count, number, probability, words
from benchlab.report.study.report import PublishedSet, StudyReport, mean_of, sd_of, span_text
from benchlab.stats.groups import groups_of_summaries
from benchlab.stats.pairs import Pair, games_howell
from benchlab.stats.wording import STARS_LEGEND, p_equals, stars


@dataclass(frozen=True)
class SharedPair:
    """A pair of designs that the paper compares and the study has too. here, paper: b less a in both. a, b: named as in the study."""

    figure: str
    a: str
    b: str
    here: Pair
    paper: Pair
    turned: bool
    differs_here: bool
    differs_there: bool

    @property
    def agrees(self) -> bool:
        """Told apart in both, in the same direction; or in neither."""
        same = (self.here.difference > 0) == ((self.paper.difference > 0) != self.turned)
        return self.differs_here == self.differs_there and (same or not self.differs_here)


def published_section(report: StudyReport) -> Section | None:
    """None where no design of the study is one of the paper's."""
    if not report.published_sets:
        return None
    return Section("Beside the paper", tuple(_blocks(report)))


def paper_words(report: StudyReport) -> str:
    """In a sentence or two, whether what the paper claims is found here; "" where the study has none of its figures' sets."""
    shared = shared_pairs(report)
    if not shared:
        return ""
    figures = " and ".join(dict.fromkeys(pair.figure for pair in shared))
    others = [pair for pair in shared if not pair.agrees]
    marks = [pair for pair in shared if pair.agrees and stars(pair.here.p) != stars(pair.paper.p)]
    starred = "; ".join(
        f"{cut(pair.a, 30)} and {cut(pair.b, 30)} earn {stars(pair.here.p) or 'none'} here ({p_equals(pair.here.p)}), "
        f"{stars(pair.paper.p) or 'none'} by the published table ({p_equals(pair.paper.p)})"
        for pair in marks
    )
    more = f" Stars differ: {starred}." * bool(marks)
    if not others:
        return f"As in the paper ({figures}), each of the {len(shared)} pairs compared there differs, in the same direction.{more}"
    listed = "; ".join(
        f"{cut(pair.a, 30)} and {cut(pair.b, 30)} {_found_here(pair)} ({p_equals(pair.here.p)})" for pair in others
    )
    return f"Of {len(shared)} pairs that the paper compares ({figures}), {len(others)} come out otherwise here: {listed}.{more}"


def shared_pairs(report: StudyReport) -> list[SharedPair]:
    """The pairs of the paper's Figs 6c and 7c, each from the smallest set of the study that has all designs of the figure."""
    return [pair for one in report.published_sets if one.figure for pair in _shared(report, one)]


def _shared(report: StudyReport, one: PublishedSet) -> Iterator[SharedPair]:
    wanted = [angle.design for angle in one.angles]
    fitting = [
        (shells, compared.found)
        for compared in report.compared
        if compared.found is not None and set(wanted) <= set(shells := _shells(report.values.of(compared.chosen)))
    ]
    if not fitting:
        return
    shells, found = min(fitting, key=lambda item: len(item[0]))
    names = {group.name: shells[angle.design] for group, angle in zip(one.found.groups, one.angles)}
    own = {frozenset((pair.a, pair.b)): pair for pair in found.tukey}
    for paper in one.found.tukey:
        here = own.get(frozenset((names[paper.a], names[paper.b])))
        if here is not None and here.p is not None and paper.p is not None:
            turned = here.a != names[paper.a]
            differs = here.p < found.alpha, paper.p < one.found.alpha
            yield SharedPair(one.figure, here.a, here.b, here, paper, turned, *differs)


def _shells(designs: tuple[DesignValues, ...]) -> dict[ShellDesign, str]:
    return {design.shell: design.name for design in reversed(designs) if design.shell is not None}


def _found_here(pair: SharedPair) -> str:
    if not pair.differs_here:
        return "are not shown to differ"
    return "differ, the other way" if pair.differs_there else "differ"


def _blocks(report: StudyReport) -> Iterator[Block]:
    yield _means_table(report)
    yield Words(
        f"The captions of the paper’s Figs 6 and 7 define stars as {STARS_LEGEND}, and no others. Its Table I gives mean, SD and n of "
        f"each design, and that is enough to do its tests again: {'; '.join(map(_test, report.published_sets))}."
    )
    yield from (Words(text, "warning") for text in _short_of_four(report.published_sets))
    yield _pairs_table(report)


def _test(one: PublishedSet) -> str:
    anova = one.found.anova
    title = one.figure or one.title
    return (
        title if anova.F is None else f"{title} F({anova.df[0]}, {anova.df[1]}) = {anova.F:.2f}, {p_equals(anova.p, 0)}"
    )


def _means_table(report: StudyReport) -> Table:
    """A row for each design that the paper measured too."""
    columns = (
        Column("design", "design", False), Column("mean_deg"), Column("sd_deg"), Column("n"), Column("", "here, mean ± SD (°)"),
        Column("published_deg"), Column("published_sd_deg"), Column("published_n"), Column("", "paper, mean ± SD (°)"),
        Column("difference_deg", "here − paper (°)"), Column("low_deg"), Column("high_deg"),
        Column("", f"{report.percent} interval (°)"), Column("p", "p (Welch)"), Column("published_fem_deg", "paper, FEM (°)"),
    )  # fmt: skip
    rows = []
    for design in report.values.designs:
        paper = report.published_of(design)
        if paper is not None and paper.measured_angle_deg is not None:
            rows.append(_means_row(report, design, paper, paper.measured_angle_deg))
    note = (
        "Measured angles at the same pressure, of designs with the same dimensions; the paper’s are from its Table I."
    )
    return Table("paper_means", "The same designs in the paper.", columns, tuple(rows), note)


def _means_row(report: StudyReport, design: DesignValues, paper: PublishedAngle, measured: float) -> tuple[Cell, ...]:
    places, mean, sd, n = report.places, mean_of(design), sd_of(design), len(design.counted)
    pair = None
    if mean is not None and sd is not None and paper.measured_sd_deg is not None and paper.samples is not None:
        pair = _welch((n, mean, sd), (paper.samples, measured, paper.measured_sd_deg), report.confidence)
    low, high = (None, None) if pair is None else (pair.low, pair.high)
    return (
        words(design.name, 40), number(mean, places), number(sd, places), count(n), _mean_and_sd(mean, sd, places),
        number(measured, 1), number(paper.measured_sd_deg, 1), count(paper.samples), _mean_and_sd(measured, paper.measured_sd_deg, 1),
        number(None if mean is None else mean - measured, places), number(low, places), number(high, places),
        Cell(None, span_text(low, high, places)), probability(None if pair is None else pair.p), number(paper.fem_angle_deg, 1),
    )  # fmt: skip


def _welch(here: tuple[int, float, float], paper: tuple[int, float, float], confidence: float) -> Pair | None:
    """Here less paper, each (n, mean, SD): with two groups, Games and Howell's test is Welch's t. None for a lone sample."""
    (n, mean, sd), (own_n, own_mean, own_sd) = paper, here
    if min(n, own_n) < 2:
        return None
    means = [Decimal(repr(mean)), Decimal(repr(own_mean))]
    return games_howell(groups_of_summaries(["paper", "here"], [n, own_n], means, [sd, own_sd]), confidence)[0]


def _mean_and_sd(mean: float | None, sd: float | None, places: int) -> Cell:
    text = number(mean, places).text
    return Cell(None, text if sd is None or text == NONE else f"{text} ± {number(sd, places).text}")


def _pairs_table(report: StudyReport) -> Table:
    columns = (
        Column("figure"), Column("a"), Column("b"), Column("", "pair", False),
        Column("difference_deg", "difference (°)"), Column("low_deg"), Column("high_deg"), Column("", "Tukey interval (°)"),
        Column("p", "Tukey p"), Column("stars", "stars", False), Column("games_howell_p", "Games–Howell p"),
        Column("here_p", "Tukey p here"), Column("here_stars", "stars here", False),
    )  # fmt: skip
    here = {(pair.figure, pair.paper.a, pair.paper.b): pair.here.p for pair in shared_pairs(report)}
    rows = tuple(
        (
            words(one.figure or one.title), words(pair.a), words(pair.b), Cell(None, f"{pair.b} − {pair.a}"),
            number(pair.difference, 1), number(pair.low, 1), number(pair.high, 1), Cell(None, span_text(pair.low, pair.high, 1)),
            probability(pair.p), words(stars(pair.p)), probability(other.p),
            probability(own := here.get((one.figure, pair.a, pair.b))), words(stars(own)),
        )
        for one in report.published_sets
        for pair, other in zip(one.found.tukey, one.found.games_howell)
    )  # fmt: skip
    caption = "The paper’s pairs, recomputed from its means, SDs and n."
    return Table("paper_pairs", caption, columns, rows, by="figure")


def _short_of_four(sets: tuple[PublishedSet, ...]) -> Iterator[str]:
    """Pairs of the paper's figures that its legend gives fewer than four stars, in words."""
    for one in (one for one in sets if one.figure):
        for pair in one.found.tukey:
            if pair.p is not None and (mark := stars(pair.p)) != "****":
                earned = f"{mark}, not ****" if mark else "no star"
                limit = "0.00001" if mark else "0.0001"
                yield (
                    f"{one.figure}: “{pair.a}” and “{pair.b}” differ with {p_equals(pair.p)}. That is not below {limit}, so by the "
                    f"legend the pair has {earned}; a stronger mark over it does not follow from the published means and SDs."
                )
