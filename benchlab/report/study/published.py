"""The published table of the paper, recomputed from its means, standard deviations and sample sizes."""

from __future__ import annotations

from collections.abc import Iterator

from benchlab.report.document import Block, Column, Section, Table, Words
from benchlab.report.rounding import number, words
from benchlab.report.study.report import PublishedSet, StudyReport
from benchlab.report.study.statistics import probability
from benchlab.report.study.verdict import pair_name
from benchlab.stats.wording import STARS_LEGEND, p_equals, stars, verdict


def published_section(report: StudyReport) -> Section | None:
    """None where no design of the study is one of the paper's."""
    if not report.published_sets:
        return None
    return Section("The published table, recomputed", tuple(_blocks(report)))


def _blocks(report: StudyReport) -> Iterator[Block]:
    yield Words(
        "Not from the data of this study: the paper’s Table I gives mean, SD and n of five designs, and that is enough for the same "
        f"tests. The captions of its Figs 6 and 7 define stars as {STARS_LEGEND}, and no others."
    )
    for one in report.published_sets:
        yield Words(f"{one.title}: {verdict(one.found)}")
    yield from (Words(text, "warning") for text in _short_of_four(report.published_sets))
    columns = (
        Column("set", "set", False), Column("a", "a", False), Column("b", "b", False), Column("difference_deg", "b − a (°)"),
        Column("low_deg", "low (°)"), Column("high_deg", "high (°)"), Column("p", "Tukey p"), Column("stars", "stars", False),
        Column("games_howell_p", "Games–Howell p"),
    )  # fmt: skip
    rows = tuple(
        (
            words(one.title), words(pair.a), words(pair.b), number(pair.difference, 1), number(pair.low, 1), number(pair.high, 1),
            probability(pair.p), words(stars(pair.p)), probability(other.p),
        )
        for one in report.published_sets
        for pair, other in zip(one.found.tukey, one.found.games_howell)
    )  # fmt: skip
    yield Table("published_pairs", "Pairs of the published designs, from published means, SDs and n.", columns, rows)


def _short_of_four(sets: tuple[PublishedSet, ...]) -> Iterator[str]:
    """Pairs of the paper's figures that its legend gives fewer than four stars, in words."""
    for one in (one for one in sets if one.figure):
        for pair in one.found.tukey:
            if pair.p is not None and (mark := stars(pair.p)) != "****":
                earned = f"{mark}, not ****" if mark else "no star"
                limit = "0.00001" if mark else "0.0001"
                yield (
                    f"{one.figure}: {pair_name(pair)} differ with {p_equals(pair.p)}. That is not below {limit}, so by the legend the pair "
                    f"has {earned}; a stronger mark over it does not follow from the published means and SDs."
                )
