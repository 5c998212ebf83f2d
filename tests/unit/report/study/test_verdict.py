"""The head of a report, and its tables: words and numbers that follow from the values, computed here another way."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from benchlab.io.study_values import StudySet
from benchlab.report.document import Pictures, Table, Tile, Tiles
from benchlab.report.study import differences
from benchlab.report.study.differences import pairs_table, power_blocks
from benchlab.report.study.document import study_document
from benchlab.report.study.pictures import bar_of, bars_blocks, brackets_of, file_names
from benchlab.report.study.repeatability import components_blocks
from benchlab.report.study.report import StudyReport, interval_of, scatter_of
from benchlab.report.study.tables import designs_table, samples_table
from benchlab.report.study.verdict import verdict_section, verdict_words
from tests.unit.report import studies


@pytest.fixture(scope="module")
def paper() -> StudyReport:
    return studies.report(studies.paper_study())


def said(report: StudyReport) -> dict[str, str]:
    return {words.head or words.kind: words.text for words in verdict_words(report)}


def column(table: Table, name: str) -> list[object]:
    (at,) = [index for index, one in enumerate(table.columns) if one.name == name]
    return [row[at].value for row in table.rows]


def test_the_verdict_of_the_papers_study(paper: StudyReport) -> None:
    """F(4, 20) = 529.46, p = 5.6e-20; RMSE 5.18, mean |error| 4.32: from the published table by hand."""
    told = said(paper)
    assert "p = 5.6e-20" in told["All designs."] and "9 of 10 pairs" in told["All designs."]
    assert "tw3_slw20 and tw15_slw10 (p = 0.34)" in told["All designs."]
    assert told["Strip width, tw 3 mm."].endswith("Each of the 3 pairs differs too (Tukey HSD, largest p = 2.2e-5).")
    # sqrt(SS / chi2) with SS = 20 * 8.814, chi2(20): 34.170 and 9.591 (tables): 2.27 and 4.29
    assert told["Repeatability."].startswith(
        "Samples of one design, each with the mean of its cycles, scatter about their mean with SD 3.0° (95 % interval 2.3 to 4.3°, "
        "20 degrees of freedom; 1.7 to 4.0° by design); the repeatability limit r, 2.8 SD, is 8.3°. Cycles"
    )
    assert (
        told["Simulation."]
        == "Simulated less measured angle is −1.0 to +9.3° (5 designs); mean |error| 4.3°, RMSE 5.2°."
    )


def test_large_numbers(paper: StudyReport) -> None:
    tiles = verdict_section(paper).blocks[0]
    assert isinstance(tiles, Tiles)
    assert [tile.value for tile in tiles.row] == ["56.7–125.7°", "± 3.0°", "9 of 10", "5.2°"]
    assert tiles.row[1].note == (
        "95 % interval 2.3 to 4.3°, 20 degrees of freedom; repeatability limit r, 2.8 SD: 8.3°"
    )
    assert tiles.row[1].name == "SD between samples of a design, means of cycles"
    assert tiles.row[2].note == "by Tukey HSD at 0.05, all designs"
    assert tiles.row[0] == Tile("56.7–125.7°", "mean angle at 0.35 MPa", "tw15_slw10 to tw3_slw10")


def test_designs_alike_are_not_said_to_differ() -> None:
    report = studies.report(
        studies.values((studies.design("a", 50, 3), studies.design("b", 50.5, 3), studies.design("c", 51, 3)))
    )
    text = said(report)["All designs."]
    assert text.startswith("No difference between the designs is shown (ANOVA p = ") and "none of the 3 pairs" in text


def test_one_design_has_a_repeatability_and_no_comparison() -> None:
    report = studies.report(studies.values((studies.design("a", 50, 2.0),)))
    told = said(report)
    assert told["All designs."].startswith("Not compared: fewer than two designs")
    # chi2(4): 11.143 and 0.4844 (tables): 2 * sqrt(4 / 11.143) = 1.20, 2 * sqrt(4 / 0.4844) = 5.75
    assert "SD 2.0° (95 % interval 1.2 to 5.7°, 4 degrees of freedom); the rep" in told["Repeatability."]
    assert told["Repeatability."].endswith("is 5.6°; few degrees of freedom: r is itself uncertain.")
    assert not [section for section in study_document(report).sections if section.title == "Do they differ?"]


def test_nothing_measured_says_so() -> None:
    lost = tuple(replace(one, samples=()) for one in studies.paper_designs())
    report = studies.report(studies.values(lost))
    assert said(report) == {"All designs.": "Not compared: no sample has a value."}
    assert study_document(report).panels == ()


def test_no_scatter_is_told() -> None:
    report = studies.report(
        studies.values((studies.design("a", 50, 0, cycles=1), studies.design("b", 60, 0, cycles=1)))
    )
    assert said(report)["All designs."].startswith("No test:")
    assert (
        any("no scatter" in why for _, why in [(w.head, w.text) for w in verdict_words(report)])
        or report.whole.found is not None
    )


def test_failures_and_what_was_left_out_are_counted() -> None:
    told = said(studies.report(studies.doubtful_study()))
    assert told["warning"].startswith("Not everything counts: 1 without a value (failed or missing); 1 left out.")


def test_table_of_designs_against_scipy(paper: StudyReport) -> None:
    table = designs_table(paper)
    for index, design in enumerate(paper.values.designs):
        angles = np.array([np.mean([cycle.angle_deg for cycle in sample.cycles]) for sample in design.samples])
        low, high = stats.t.interval(0.95, len(angles) - 1, angles.mean(), stats.sem(angles))
        assert column(table, "mean_deg")[index] == pytest.approx(angles.mean(), rel=1e-12)
        assert column(table, "sd_deg")[index] == pytest.approx(angles.std(ddof=1), rel=1e-12)
        assert (column(table, "mean_low_deg")[index], column(table, "mean_high_deg")[index]) == pytest.approx(
            (low, high), rel=1e-9
        )
    assert table.shown[0] == ("tw3_slw5", "5", "15", "110.2", "1.9", "107.8 to 112.6", "119.5", "9.3")


def test_confidence_is_that_of_all_intervals() -> None:
    report = studies.report(studies.paper_study(), confidence=0.99)
    assert "99 % interval of mean (°)" in [one.head for one in designs_table(report).heads]
    wide, usual = interval_of(report.values.designs[0], 0.99), interval_of(report.values.designs[0], 0.95)
    assert wide[0] is not None and usual[0] is not None and wide[0] < usual[0]
    assert "99 %" in pairs_table(report).note


def test_tests_and_pairs_against_scipy(paper: StudyReport) -> None:
    angles = {design.name: design.angles_deg for design in paper.values.designs}
    for index, one in enumerate(paper.compared):
        groups = [angles[name] for name in one.chosen.designs]
        assert column(differences.tests_table(paper), "F")[index] == pytest.approx(
            stats.f_oneway(*groups).statistic, rel=1e-9
        )
        tukey = stats.tukey_hsd(*groups)
        rows = [row for row in pairs_table(paper).rows if row[0].value == one.chosen.title]
        pairs = [(a, b) for a in range(len(groups)) for b in range(a + 1, len(groups))]
        for (a, b), row in zip(pairs, rows, strict=True):
            assert (row[1].value, row[2].value) == (one.chosen.designs[a], one.chosen.designs[b])
            assert row[4].value == pytest.approx(-tukey.statistic[a, b], rel=1e-9)
            interval = tukey.confidence_interval()
            assert (row[5].value, row[6].value) == pytest.approx((-interval.high[a, b], -interval.low[a, b]), rel=1e-5)


def test_pooled_sd_is_the_one_of_the_comparison(paper: StudyReport) -> None:
    own = scatter_of(paper)
    assert paper.whole.found is not None and own is not None
    assert own.sd_deg == pytest.approx(paper.whole.found.repeatability.sample_sd, rel=1e-12)
    assert own.sd_deg == pytest.approx(math.sqrt(np.mean([1.9**2, 4.0**2, 3.6**2, 1.7**2, 2.9**2])), rel=1e-12)
    low, high = stats.chi2.interval(0.95, 20)
    assert (own.low_deg, own.high_deg) == pytest.approx(
        (own.sd_deg * math.sqrt(20 / high), own.sd_deg * math.sqrt(20 / low)), rel=1e-12
    )
    assert own.limit_deg == 2.8 * own.sd_deg and own.df == 20


def test_one_degree_of_freedom_promises_nothing() -> None:
    """chi2(1): 5.0239 and 0.00098207 (tables), so that an SD of 2 may be 0.9 to 63.8."""
    report = studies.report(studies.values((studies.design("a", 50, 2.0, samples=2, cycles=1),)))
    text = said(report)["Repeatability."]
    assert "SD 2.0° (95 % interval 0.9 to 63.8°, 1 degree of freedom)" in text and "itself uncertain" in text
    assert "cycles" not in text and "95 % of cases" not in text
    tiles = verdict_section(report).blocks[0]
    assert isinstance(tiles, Tiles) and "1 degree of freedom;" in tiles.row[1].note
    assert "itself uncertain" in tiles.row[1].note


def test_the_table_of_components_says_which_sd_is_which(paper: StudyReport) -> None:
    nested = next(block for block in components_blocks(paper) if isinstance(block, Table))
    single = next(
        block for block in components_blocks(studies.report(studies.paper_study(cycles=1))) if isinstance(block, Table)
    )
    assert "The verdict has another SD and limit" in nested.note and "variance component" in nested.note
    assert (
        "another" not in single.note and "uncertain themselves" in nested.note and "uncertain themselves" in single.note
    )


def test_where_games_howell_disagrees_the_verdict_says_so_at_once() -> None:
    """Two designs that scatter little and one much: the pooled scatter of Tukey tells apart what Games–Howell does not."""
    designs = (
        studies.design("flat", 20, 0.5), studies.design("straight", 58, 0.5), studies.design("helix", 50, 6.0, samples=3),
    )  # fmt: skip
    report = studies.report(studies.values(designs))
    assert report.whole.found is not None
    pairs = [(one.p, other.p) for one, other in zip(report.whole.found.tukey, report.whole.found.games_howell)]
    unlike = [other for one, other in pairs if one is not None and other is not None and one < 0.05 <= other]
    assert len(unlike) == 1
    text, tiles = said(report)["All designs."], verdict_section(report).blocks[0]
    assert text.endswith(f" But Games–Howell does not tell apart straight–helix (p = {unlike[0]:.2g}).")
    assert isinstance(tiles, Tiles)
    (tile,) = [tile for tile in tiles.row if tile.name == "pairs of designs told apart"]
    assert tile.note == "by Tukey HSD at 0.05, all designs; 1 of them not by Games–Howell"


def test_where_games_howell_alone_tells_apart_it_is_said_too() -> None:
    designs = (studies.design("a", 50, 0.3), studies.design("b", 52, 0.3), studies.design("wild", 60, 12.0))
    report = studies.report(studies.values(designs))
    assert " But Games–Howell does tell apart a–b (p" in said(report)["All designs."]
    tiles = verdict_section(report).blocks[0]
    assert isinstance(tiles, Tiles)
    (tile,) = [tile for tile in tiles.row if tile.name == "pairs of designs told apart"]
    assert tile.note.endswith("; 1 more by Games–Howell")


def test_brackets_carry_the_stars_of_tukeys_p(paper: StudyReport) -> None:
    slw = paper.compared[0]
    assert brackets_of(slw.found, slw.chosen.designs) == [(0, 1, "***"), (0, 2, "****"), (1, 2, "****")]
    assert (2, 4, "p = 0.34") in brackets_of(paper.whole.found, paper.whole.chosen.designs)
    assert bar_of(replace(paper.values.designs[0], samples=())) is None


def test_a_sample_left_out_stands_in_its_table_with_its_reason() -> None:
    first, *rest = studies.paper_designs()
    bad = replace(first.samples[0], left_out="leaked at the seam")
    report = studies.report(studies.values((replace(first, samples=(bad, *first.samples[1:])), *rest)))
    table = samples_table(report)
    assert column(table, "note")[0] == "left out: leaked at the seam" and column(table, "angle_deg")[0] is None
    assert column(designs_table(report), "samples")[0] == 4


def test_a_wanted_difference_gives_power_and_samples() -> None:
    (table,) = power_blocks(studies.report(studies.paper_study(), difference_deg=5.0))
    assert isinstance(table, Table)
    power = column(table, "power")
    assert len(power) == 6 and all(isinstance(p, float) and 0.2 < p < 0.9 for p in power)
    assert all(isinstance(n, int) and n > 5 for n in column(table, "samples_80"))


def test_names_of_files_are_plain_and_apart() -> None:
    assert file_names(["<script>", "script", "../..", "", "é"]) == [
        "script",
        "script_2",
        "unnamed",
        "unnamed_2",
        "unnamed_3",
    ]


def test_sets_keep_their_order_and_designs() -> None:
    sets = (StudySet("x", "Backwards", ("tw15_slw10", "tw3_slw5")),)
    report = studies.report(studies.values(studies.paper_designs(), sets))
    assert [one.chosen.title for one in report.compared] == ["Backwards", "All designs"]
    assert [row[1].value for row in pairs_table(report).rows if row[0].value == "Backwards"] == ["tw15_slw10"]


@pytest.mark.parametrize(
    ("count", "simulated", "there", "absent"),
    [
        (3, 55.0, ("Bars:", "Whiskers", "Diamonds", "Brackets"), ("rows", "first")),
        (3, None, ("Bars:", "Brackets"), ("Diamonds",)),
        (8, None, ("Squares:", "Whiskers"), ("Brackets", "Bars", "first")),
        (41, None, ("Squares:", "The first 40 designs are drawn."), ("Brackets",)),
        (1, None, ("Bars:", "Whiskers"), ("Brackets",)),
    ],
)
def test_the_caption_speaks_of_what_is_drawn(
    count: int, simulated: float | None, there: tuple[str, ...], absent: tuple[str, ...]
) -> None:
    designs = tuple(studies.design(f"d{i}", 50 + i, 2, 3, 1, simulated_deg=simulated) for i in range(count))
    (pictures,) = bars_blocks(studies.report(studies.values(designs)))
    assert isinstance(pictures, Pictures)
    assert all(word in pictures.caption for word in there) and not any(word in pictures.caption for word in absent)
