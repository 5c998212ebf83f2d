"""Tables of the explanation: their numbers against the closed form from which the curves were drawn."""

from __future__ import annotations

import csv
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from benchlab.discrepancy.explanation import Curves, HeldOut
from benchlab.report.document import Table, write_table
from benchlab.report.explain.tables import (
    curves_table,
    designs_table,
    held_out_table,
    parameters_table,
    regions_table,
    rivals_table,
)
from tests.unit.report import explanations


def read(path: Path, table: Table) -> list[dict[str, str]]:
    write_table(path, table)
    with path.open(encoding="utf-8") as file:
        return [*csv.DictReader(file)]


def test_gaps_of_designs_are_those_of_the_drawing(tmp_path: Path) -> None:
    """Gaps −0.05·a·s in loading, 0.04·a·s in unloading, −0.05·a·(1 − s/2) in holds at s = 1/8 … 1, at two rates; 15 % is left."""
    shares = np.arange(1, 9) / 8
    gaps = np.concatenate([np.tile(np.concatenate([-0.05 * shares, 0.04 * shares]), 2), -0.05 * (1 - shares / 2)])
    rows = read(tmp_path / "t.csv", designs_table(explanations.explanation()))
    assert [row["design"] for row in rows] == list(explanations.PAPER)
    for row, a in zip(rows, explanations.PAPER.values()):
        assert float(row["rmse_before"]) == pytest.approx(a * np.sqrt(np.mean(gaps**2)))
        assert float(row["rmse_after"]) == pytest.approx(0.15 * a * np.sqrt(np.mean(gaps**2)))
        assert float(row["gap_mean"]) == pytest.approx(a * gaps.mean())
        assert float(row["largest_left"]) == pytest.approx(0.15 * a * -0.05)
        assert row["features"] == "40"


def test_the_published_gaps() -> None:
    table = designs_table(explanations.published())
    gaps = {row[1].text: row[3].text for row in table.rows}
    assert gaps == {
        "tw3_slw5": "−9.3°",
        "tw3_slw10": "−4.5°",
        "tw3_slw20": "−2.1°",
        "tw9_slw10": "−4.7°",
        "tw15_slw10": "+1.0°",
    }


def test_curves_are_written_whole(tmp_path: Path) -> None:
    found = explanations.explanation()
    rows = read(tmp_path / "curves.csv", curves_table(found))
    assert len(rows) == len(found.curves.design) and list(rows[0]) == [field.name for field in fields(Curves)]
    assert [float(row["measured"]) for row in rows] == found.curves.measured.tolist()
    assert {row["rate_MPa_s"] for row in rows if row["direction"] == "hold"} == {""}


def test_regions_have_a_line_each_with_the_sign_of_measured_less_simulated(tmp_path: Path) -> None:
    found = explanations.explanation()
    table = regions_table(found)
    rows = read(tmp_path / "regions.csv", table)
    assert [float(row["gap"]) for row in rows] == [one.gap for one in found.where]
    loading = [row[8].text for row in table.rows if row[2].value == "loading"]
    assert loading and all(text.startswith("−") for text in loading)
    assert "quantity" not in [column.head for column in table.heads]
    assert "quantity" in [column.head for column in regions_table(explanations.crowded()).heads]


def test_rivals_that_are_left_stand_first_then_the_best_fit() -> None:
    found = explanations.explanation(tried=explanations.TRIED[::-1])
    rows = rivals_table(found).rows
    assert [row[0].value for row in rows] == ["friction", "viscoelasticity", "seam_margin"]
    assert [row[5].value for row in rows] == ["yes", "no", "no"] and rows[1][6].text.startswith(
        "the loop does not widen"
    )


def test_those_that_were_not_fitted_are_named_but_not_those_that_cannot_be_judged() -> None:
    found = explanations.explanation()
    words = ["friction", "temperature", "gravity", "dead_pressure"]
    assert rivals_table(found, words).note.endswith("the means show: gravity and dead pressure.")
    assert "Screened out" not in rivals_table(found, words[:2]).note


def test_only_cells_that_are_empty_are_explained() -> None:
    region = explanations.explanation().where[0]
    full = replace(region, rate_MPa_s=0.1, cycle=1, p=0.04975)
    table = regions_table(explanations.explanation(where=(full,)))
    assert "Without" not in table.note and table.rows[0][-1].text == "0.050"
    bare = regions_table(explanations.explanation(where=(replace(full, rate_MPa_s=None, cycle=None),)))
    assert "Without a cycle" in bare.note and "Without a rate" in bare.note


def test_held_out_over_its_floor() -> None:
    rows = held_out_table(explanations.explanation()).rows
    assert len(rows) == 12 and rows[0][1].text == "s1" and rows[0][5].text == f"{1.35 / 1.21:.2f}"
    assert rows[0][3].value == 1.35 and rows[-1][0].text == "rate"


def test_what_could_not_be_refitted_has_no_number() -> None:
    found = explanations.explanation(held_out=(HeldOut("sample", "fold 1", 5.2, float("nan"), float("nan")),))
    assert [cell.text for cell in held_out_table(found).rows[0]] == ["sample", "fold 1", "5.2°", "–", "–", "–"]


def test_what_is_not_known_is_empty(tmp_path: Path) -> None:
    (width, growth) = read(tmp_path / "p.csv", parameters_table(explanations.explanation()))
    assert (width["value"], width["low"], width["high"], width["unit"]) == ("5.21", "4.4", "6.1", "deg")
    assert (growth["low"], growth["high"]) == ("", "")
    assert {row["sd"] for row in read(tmp_path / "c.csv", curves_table(explanations.alone()))} == {""}
