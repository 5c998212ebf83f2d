"""What the figures draw, against the closed form of the curves: the cells of the map, the lines, the rows."""

from __future__ import annotations

import warnings
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.figure import Figure

from benchlab.discrepancy.explanation import Curves
from benchlab.report.explain.change_figure import Change, draw_changes
from benchlab.report.explain.curves_figure import (
    EXPLAINED,
    chosen,
    draw_kind,
    draw_points,
    is_point,
    kinds,
    limits_of,
)
from benchlab.report.explain.map_figure import MOST_COLUMNS, MOST_ROWS, colour_limit, draw_gap_map, gap_map
from benchlab.report.explain.overview import draw_overview
from benchlab.report.explain.quantity import Quantity
from benchlab.report.panels import BLUE
from benchlab.report.study.figures import OTHER
from tests.unit.report import explanations

ANGLE = Quantity("angle_deg")
FOUND = explanations.curves({"a": 100.0, "b": 50.0})


def texts(figure: Figure) -> list[str]:
    figure.draw_without_rendering()
    return [text.get_text() for text in figure.findobj(lambda artist: hasattr(artist, "get_text")) if text.get_text()]


def test_cells_are_measured_less_simulated_and_dots_where_it_is_sure() -> None:
    found = gap_map(FOUND, "angle_deg")
    assert found.designs == ("a",) * 5 + ("b",) * 5
    assert found.details[:5] == (
        "loading, 0.01 MPa/s",
        "loading, 0.12 MPa/s",
        "hold",
        "unloading, 0.01 MPa/s",
        "unloading, 0.12 MPa/s",
    )
    shares = np.arange(1, 9) / 8
    up, down, held = (found.rows[place] for place in (0, 8, 2))
    np.testing.assert_allclose(up.gap, -5.0 * shares)
    np.testing.assert_allclose(down.gap, 2.0 * shares)
    assert up.sure.tolist() == (shares > 0.5).tolist()
    np.testing.assert_allclose(up.middle_MPa, 0.35 * shares)
    np.testing.assert_allclose(up.edges_MPa, 0.35 * (np.arange(9) + 0.5) / 8)
    np.testing.assert_allclose(held.gap, [-5 * np.mean(1 - shares / 2)])
    np.testing.assert_allclose(held.edges_MPa, [0.35 * (1 - 1 / 16), 0.35 * (1 + 1 / 16)])


def shifted(by_MPa: float) -> Curves:
    """The slow runs' bins lie a little lower than those of the fast ones."""
    slow = np.where(FOUND.rate_MPa_s == 0.01, by_MPa, 0.0)
    return replace(FOUND, pressure_MPa=FOUND.pressure_MPa - slow)


def test_each_kind_of_run_has_its_own_cells_without_holes() -> None:
    found = gap_map(shifted(0.011), "angle_deg")
    slow, fast = found.rows[:2]
    assert len(slow.gap) == len(fast.gap) == 8
    np.testing.assert_allclose(slow.edges_MPa[1:], fast.edges_MPa[1:] - 0.011)
    figure = draw_gap_map(found, ANGLE, "a title", 5.0)
    drawn = figure.axes[0].collections[0]
    boxes = [path.get_extents() for path in drawn.get_paths()[:16]]
    for row in (boxes[:8], boxes[8:]):
        assert all(one.x1 == pytest.approx(other.x0) for one, other in pairwise(row))
    np.testing.assert_allclose(drawn.get_array()[:8], slow.gap)
    dots = figure.axes[0].lines[0]
    inside = [(y == 0 and boxes[4].x0 < x < boxes[4].x1) for x, y in zip(dots.get_xdata(), dots.get_ydata())]
    assert sum(inside) == 1


def test_the_cells_of_holds_end_where_the_data_do() -> None:
    at = np.array([0.1, 0.2, 0.35])
    held = explanations.of_rows([
        ("a", "angle_deg", "held", "hold", cycle, np.nan, pressure, 5.0, 30.0, 1.0, 5.0, 29.0, 29.5, 0.5)
        for cycle in (1, 2) for pressure in (at if cycle == 1 else at[-1:])
    ])  # fmt: skip
    first, last = gap_map(held, "angle_deg").rows
    np.testing.assert_allclose(first.edges_MPa, [0.1, 0.15, 0.275, 0.35])
    assert last.edges_MPa[-1] == 0.35


def test_where_rates_share_a_row_bins_of_the_same_place_are_one() -> None:
    found = gap_map(shifted(0.011), "angle_deg", most=6)
    assert [len(row.gap) for row in found.rows] == [8, 1, 8] * 2
    np.testing.assert_allclose(found.rows[0].gap, -5.0 * np.arange(1, 9) / 8)


def test_what_is_left_is_measured_less_explained() -> None:
    for left, gap in zip(gap_map(FOUND, "angle_deg", "explained").rows, gap_map(FOUND, "angle_deg").rows):
        np.testing.assert_allclose(left.gap, 0.15 * gap.gap)


def test_too_many_rows_lose_cycles_then_rates_never_directions_then_designs() -> None:
    many = explanations.curves({f"d{i}": 10.0 + i for i in range(30)}, rates=(0.01, 0.1), cycles=3)
    found = gap_map(many, "angle_deg")
    assert len(found.designs) <= MOST_ROWS and set(found.details) == {"loading", "hold", "unloading"}
    assert found.hidden == 10 and "d29" in found.designs and "d0" not in found.designs
    assert found.rows[0].gap.max() < 0 < found.rows[2].gap.min()
    fewer = gap_map(many, "angle_deg", most=15 * 30)
    assert len(fewer.designs) == 15 * 30 and fewer.hidden == 0 and "loading, 0.01 MPa/s, cycle 2" in fewer.details


def test_many_pressures_share_columns() -> None:
    row = gap_map(explanations.curves(bins=200), "angle_deg").rows[0]
    assert MOST_COLUMNS / 2 < len(row.gap) <= MOST_COLUMNS and len(row.edges_MPa) == len(row.gap) + 1


def test_colours_end_at_the_largest_gap_but_scatter_looks_pale() -> None:
    assert colour_limit(FOUND, "angle_deg") == pytest.approx(5.0)
    assert colour_limit(explanations.agreeing().curves, "angle_deg") == pytest.approx(2 * 0.02 * 84.6)
    figure = draw_gap_map(gap_map(FOUND, "angle_deg"), ANGLE, "a title", 5.0)
    assert figure.axes[0].collections[0].get_clim() == (-5.0, 5.0)
    assert "a, loading, 0.01 MPa/s" in texts(figure) and "measured − model (°)" in texts(figure)


def test_a_panel_has_the_lines_of_its_design_and_kind() -> None:
    one = kinds(FOUND, "angle_deg")[1]
    assert one.title == "a, 0.35 MPa at 0.12 MPa/s" and not one.held
    upper, lower = draw_kind(FOUND, one, ("measured", "with friction"), limits_of(FOUND, "angle_deg"), legend=True).axes
    shares = np.arange(1, 9) / 8
    drawn = {
        colour: [line.get_ydata() for line in upper.lines if line.get_color() == colour]
        for colour in (BLUE, OTHER, EXPLAINED)
    }
    np.testing.assert_allclose(drawn[BLUE], [95 * shares, 104 * shares])
    np.testing.assert_allclose(drawn[OTHER], [100 * shares] * 2)
    np.testing.assert_allclose(drawn[EXPLAINED], [(100 - 5 * 0.85) * shares, (100 + 4 * 0.85) * shares])
    gaps = {
        colour: [line.get_ydata() for line in lower.lines if line.get_color() == colour]
        for colour in (OTHER, EXPLAINED)
    }
    np.testing.assert_allclose(gaps[OTHER], [-5 * shares, 4 * shares])
    np.testing.assert_allclose(gaps[EXPLAINED], [-0.75 * shares, 0.6 * shares])
    assert [text.get_text() for text in upper.get_legend().get_texts()] == ["measured", "simulated", "with friction"]


def test_holds_are_drawn_against_time_each_pressure_by_itself() -> None:
    held = [one for one in kinds(FOUND, "angle_deg") if one.held]
    assert [one.design for one in held] == ["a", "b"]
    upper, lower = draw_kind(FOUND, held[0], ("measured", "x"), limits_of(FOUND, "angle_deg"), legend=False).axes
    np.testing.assert_allclose(upper.lines[0].get_xdata(), 30 * np.arange(1, 9) / 8)
    assert lower.get_xlabel() == "time held (s)"
    low = replace(
        FOUND, pressure_MPa=np.where(FOUND.design == "b", 0.2, FOUND.pressure_MPa), design=np.full(len(FOUND.p), "a")
    )
    assert len([one for one in kinds(low, "angle_deg") if one.held]) == 2


def test_of_many_cycles_the_first_and_the_last_are_drawn() -> None:
    many = explanations.curves({"a": 100.0}, rates=(0.1,), cycles=5, hold=False)
    upper, _ = draw_kind(many, kinds(many, "angle_deg")[0], ("m", "x"), limits_of(many, "angle_deg"), legend=False).axes
    assert len([line for line in upper.lines if line.get_color() == BLUE]) == 4  # two directions, two cycles


def test_chosen_panels_have_each_design_and_then_the_largest_gaps() -> None:
    found = kinds(FOUND, "angle_deg")
    kept = chosen(found, 4)
    assert len(kept) == 4 and {one.design for one in kept} == {"a", "b"}
    assert sum(one.design == "a" for one in kept) == 3 and [id(one) for one in kept] == [
        id(one) for one in found if one in kept
    ]


def test_a_table_of_means_is_rows() -> None:
    found = explanations.published().curves
    rows = kinds(found, "angle_deg")
    assert all(is_point(found, one) for one in rows)
    figure = draw_points(found, rows, ("measured", "with gain"), ANGLE)
    simulated = next(line for line in figure.axes[0].lines if line.get_label() == "simulated")
    assert simulated.get_xdata().tolist() == [119.5, 130.2, 62.4, 84.6, 55.7]
    assert "Means of designs at 0.35 MPa" in texts(figure)


def test_changes_are_rows_from_before_to_after() -> None:
    figure = draw_changes([Change("s1", 4.9, 1.3, 1.2), Change("s2", 5.0, 1.4)], ANGLE, "with friction", "t")
    drawn = {line.get_label(): line.get_xdata().tolist() for line in figure.axes[0].lines}
    assert drawn["before: simulated"] == [4.9, 5.0] and drawn["after: with friction"] == [1.3, 1.4]
    assert drawn["noise floor"][0] == 1.2 and np.isnan(drawn["noise floor"][1])


@pytest.mark.parametrize("kind", explanations.ALL)
def test_the_overview_of_each_verdict(kind: str) -> None:
    found = explanations.ALL[kind]()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = draw_overview(found)
        said = texts(figure)
    title = {"agree": "Simulation and measurement agree", "named": "Friction is missing", "ambiguous": "3 explanations are left",
             "unexplained": "A gap that no known effect explains"}[found.verdict]  # fmt: skip
    title = "A gap, described only" if kind == "one sample" else title
    assert title in said and ("simulated data" in said) == found.simulated
    box, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
    assert box.x0 > -0.02 and box.y0 > -0.02 and box.x1 < width + 0.02 and box.y1 < height + 0.02
