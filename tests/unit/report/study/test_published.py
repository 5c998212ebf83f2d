"""The study beside the paper: what the published table gives, and where the study comes out otherwise."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest
from scipy import stats

from benchlab.report.document import Table, Words
from benchlab.report.study.published import paper_words, published_section, shared_pairs
from tests.unit.report import studies
from tests.unit.report.studies import PAPER, SETS


@cache
def changed(**means: float):
    designs = [
        studies.design(name, means.get(name, mean), sd, shell=old.shell)
        for (name, *_, mean, sd), old in zip(PAPER, studies.paper_designs())
    ]
    return studies.report(studies.values(tuple(designs), SETS))


def blocks(report):
    section = published_section(report)
    assert section is not None
    return section.blocks


def test_the_published_table_recomputed() -> None:
    """F(4, 20) = 529.46, p = 5.6e-20, from Table I; 5 and 10 mm: p = 2.2e-5, three stars by the captions' legend."""
    found = blocks(changed())
    texts = " ".join(block.text for block in found if isinstance(block, Words))
    assert "all designs F(4, 20) = 529.46, p = 5.6e-20" in texts and "*** p < 0.0001, **** p < 0.00001" in texts
    (short,) = [block for block in found if isinstance(block, Words) and block.kind == "warning"]
    assert "Fig. 6c" in short.text and "p = 2.2e-5" in short.text and "***, not ****" in short.text


def test_pairs_of_the_table_against_scipy() -> None:
    (table,) = [block for block in blocks(changed()) if isinstance(block, Table) and block.name == "paper_pairs"]
    slw = [row for row in table.rows if row[0].value == "Fig. 6c"]
    ms = (1.9**2 + 4.0**2 + 3.6**2) / 3
    for row, difference in zip(slw, (15.5, -49.9, -65.4), strict=True):
        assert row[4].value == pytest.approx(difference)
        assert row[8].value == pytest.approx(
            stats.studentized_range.sf(abs(difference) / (ms / 5) ** 0.5, 3, 12), rel=1e-4, abs=1e-13
        )


def test_a_study_that_agrees() -> None:
    report = changed()
    assert (
        paper_words(report)
        == "As in the paper (Fig. 6c and Fig. 7c), each of the 6 pairs compared there differs, in the same direction."
    )
    assert len(shared_pairs(report)) == 6


def test_a_pair_that_is_not_shown_to_differ_is_named() -> None:
    text = paper_words(changed(tw3_slw5=125.0))
    assert "1 come out otherwise here: tw3_slw5 and tw3_slw10 are not shown to differ (p = " in text


def test_a_pair_that_differs_the_other_way_is_named() -> None:
    text = paper_words(changed(tw3_slw5=145.0))
    assert "tw3_slw5 and tw3_slw10 differ, the other way (p = " in text


def test_other_stars_are_told() -> None:
    text = paper_words(changed(tw3_slw5=90.0))
    assert "tw3_slw5 and tw3_slw10 earn **** here" in text and "*** by the published table (p = 2.2e-5)" in text


def test_welchs_test_against_scipy() -> None:
    (table,) = [
        block for block in blocks(changed(tw3_slw5=112.0)) if isinstance(block, Table) and block.name == "paper_means"
    ]
    row = dict(zip([column.name for column in table.columns], table.rows[0]))
    welch = stats.ttest_ind_from_stats(112.0, 1.9, 5, 110.2, 1.9, 5, equal_var=False)
    assert row["difference_deg"].value == pytest.approx(1.8)
    assert row["p"].value == pytest.approx(welch.pvalue, rel=1e-6)
    assert (row["low_deg"].value, row["high_deg"].value) == pytest.approx(tuple(_interval(1.8, 1.9)), rel=1e-6)


def _interval(difference: float, sd: float) -> list[float]:
    half = stats.t.ppf(0.975, 8) * (2 * sd**2 / 5) ** 0.5
    return [difference - half, difference + half]


def test_designs_and_pressures_that_are_not_the_papers_have_no_such_section() -> None:
    assert (
        published_section(studies.report(studies.values((studies.design("a", 50, 2), studies.design("b", 60, 2)))))
        is None
    )
    assert published_section(studies.report(replace(studies.paper_study(), pressure_MPa=0.3))) is None
