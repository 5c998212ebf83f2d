"""Figures of a report: no text lies on another or leaves the figure, whatever the names and however many; what is drawn is true."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from benchlab.report.figures import DPI
from benchlab.report.study.bars_figure import MOST_BRACKETED, Bar, draw_bars, spread
from benchlab.report.study.consistency_figure import draw_consistency
from benchlab.report.study.figures import (
    HALF_IN,
    MOST_ROWS,
    THIRD_IN,
    WIDE_IN,
    AngleBand,
    Interval,
    draw_angle_band,
    draw_intervals,
)
from benchlab.stats.consistency import Cell

NAMES = {
    "short": lambda i: f"d{i}",
    "usual": lambda i: f"tw{3 * i}_slw10",
    "long": lambda i: f"a very long name of a design, number {i}, which goes on and on",
    "one word": lambda i: "W" * 60 + str(i),
    "hostile": lambda i: f"$x_{{{i}$ <b>\x1b[31m \U0001f600",
}


def faults(figure: Any) -> list[str]:
    """Texts that overlap each other, that leave the figure, or that are too small to read."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    figure.draw_without_rendering()  # puts all in place, and paints nothing
    kept = {
        label
        for ax in figure.axes
        for axis in (ax.xaxis, ax.yaxis)
        for tick in axis.majorTicks
        for label in (tick.label1, tick.label2)
    }
    drawn = {tick.label1 for ax in figure.axes for axis in (ax.xaxis, ax.yaxis) for tick in axis._update_ticks()}
    shown = [
        text
        for text in figure.findobj(Text)
        if text.get_visible() and text.get_text().strip() and text not in kept - drawn
    ]
    boxes = [(text.get_text(), text.get_window_extent(renderer)) for text in shown]
    found = [f"{text.get_text()!r} at {text.get_fontsize()} pt" for text in shown if text.get_fontsize() < 7]
    width, height = figure.bbox.width, figure.bbox.height
    for text, box in boxes:
        if box.x0 < -1 or box.y0 < -1 or box.x1 > width + 1 or box.y1 > height + 1:
            found.append(f"{text!r} leaves the figure")
    for (one, a), (other, b) in combinations(boxes, 2):
        if min(a.x1, b.x1) - max(a.x0, b.x0) > 1 and min(a.y1, b.y1) - max(a.y0, b.y0) > 1:
            found.append(f"{one!r} lies on {other!r}")
    return found


def bars(count: int, name: Any) -> list[Bar]:
    rng = np.random.default_rng(count)
    found = []
    for index in range(count):
        values = rng.normal(120 - 13 * (index % 8), 3, 5)
        found.append(
            Bar(name(index), values, float(values.mean()), float(values.std(ddof=1)), float(values.mean()) + 5)
        )
    return found


def every_pair(count: int, label: str = "p = 0.0069") -> list[tuple[int, int, str]]:
    return [(a, b, "****" if (a + b) % 2 else label) for a, b in combinations(range(count), 2)]


@pytest.mark.parametrize("kind", NAMES)
@pytest.mark.parametrize("count", [1, 2, 5, 6, 7, 40])
def test_bars_are_legible(kind: str, count: int) -> None:
    for bar_in in (0.64, 1.0) if count <= MOST_BRACKETED else (0.64,):
        figure = draw_bars(
            bars(count, NAMES[kind]),
            every_pair(min(count, MOST_BRACKETED)),
            "bending angle θ at 0.35 MPa (°)",
            "A title",
            bar_in,
        )
        assert not faults(figure)


def test_bars_without_scatter_samples_or_height() -> None:
    level = [Bar(f"d{i}", np.zeros(1), 0.0, None) for i in range(3)]
    down = [Bar(f"d{i}", np.array([-5.0, -7.0]), -6.0, 1.4) for i in range(3)]
    for some in (level, down):
        assert not faults(draw_bars(some, every_pair(3), "angle (°)", ""))


def test_the_bars_are_where_the_numbers_say() -> None:
    some = bars(3, NAMES["usual"])
    figure = draw_bars(some, [(0, 2, "***")], "angle (°)", "t")
    (ax,) = figure.axes
    assert [patch.get_height() for patch in ax.patches] == [bar.mean for bar in some]
    points = [line for line in ax.lines if line.get_marker() == "o"]
    for bar, line in zip(some, points):
        np.testing.assert_array_equal(line.get_ydata(), bar.values)
    whiskers = ax.containers[1].lines[2][0].get_segments()
    for bar, ends in zip(some, whiskers):
        assert bar.sd is not None
        np.testing.assert_allclose(ends[:, 1], [bar.mean - bar.sd, bar.mean + bar.sd])
    assert ax.get_ylim()[0] <= 0
    assert [text.get_text() for text in ax.texts] == ["***"]
    brackets = [line.get_ydata() for line in ax.lines if len(line.get_xdata()) == 4]
    assert len(brackets) == 1 and min(brackets[0]) > max(bar.values.max() for bar in some)


@pytest.mark.parametrize("kind", NAMES)
@pytest.mark.parametrize("count", [1, 10, 66])
def test_intervals_are_legible(kind: str, count: int) -> None:
    rows = [Interval(f"{NAMES[kind](i)[:20]} − {NAMES[kind](i + 1)[:20]}", (i - 3.0, i - 5.0, i + 1.0), None if i % 2 else (i, i - 6.0, i))
            for i in range(count)]  # fmt: skip
    for width in (HALF_IN, WIDE_IN) if count == 10 else (HALF_IN,):
        figure = draw_intervals(rows, "difference of mean θ (°)", 0.95, "A title", width)
        assert not faults(figure)
        assert len(figure.axes[0].get_yticks()) == min(count, MOST_ROWS)


@pytest.mark.parametrize("kind", NAMES)
@pytest.mark.parametrize("top", [0.0, 0.4, 1234.0])
def test_bands_are_legible(kind: str, top: float) -> None:
    pressure = np.linspace(0, 0.35, 36)
    band = AngleBand(
        NAMES[kind](1), pressure, top * pressure, np.full(36, 2.0), ((pressure, top * pressure),), (pressure, pressure)
    )
    for width in (THIRD_IN, HALF_IN):
        assert not faults(draw_angle_band(band, (-0.05 * top, 1.05 * top + 1), width))


@pytest.mark.parametrize("kind", NAMES)
@pytest.mark.parametrize("designs", [1, 5, 12])
def test_consistency_is_legible(kind: str, designs: int) -> None:
    cells = [
        Cell(NAMES[kind](d), f"s{s}", 3, 100.0, 0.3, 1.8 if s == 3 else -0.5, 1.74, 1.0, 1.9)
        for d in range(designs)
        for s in range(5)
    ]
    for statistic in ("h", "k"):
        assert not faults(draw_consistency(cells, statistic))
    alone = [Cell("", NAMES[kind](d), 5, 100.0, 0.3, None, None, 2.0 if d == 1 else 0.9, 1.9) for d in range(designs)]
    assert not faults(draw_consistency(alone, "k"))


def test_points_of_a_group_stand_apart() -> None:
    assert len(set(spread(100).tolist())) == 100 and np.abs(spread(100)).max() <= 1


def test_panels_have_the_width_they_are_asked_for() -> None:
    figure = draw_bars(bars(3, NAMES["usual"]), [], "angle (°)", "t")
    assert figure.get_size_inches()[0] == pytest.approx(0.72 + 3 * 0.64) and figure.dpi == DPI
