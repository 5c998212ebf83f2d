"""What stands in the figure of blocked force."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.force.curve import ActuatorCycles, BlockedForce, blocked_force
from benchlab.report.force_figure import draw_force_figure, line_words

LEVELS = np.repeat([0.1, 0.2, 0.3, 0.4], 3)


def found(names: tuple[str, ...] = ("a", "b", "c"), **changes) -> BlockedForce:
    rng = np.random.default_rng(3)
    lower = changes.get("lower_bound", np.zeros(12, bool))
    return blocked_force(
        [ActuatorCycles(n, (100 + 4 * i) * LEVELS + rng.normal(0, 0.1, 12), LEVELS, lower) for i, n in enumerate(names)]
    )


def texts(figure) -> list[str]:
    (ax,) = figure.axes
    return [t.get_text() for t in (*figure.texts, *ax.get_legend().get_texts())]


def test_title_legend_and_words() -> None:
    one = found()
    told = texts(draw_force_figure(one))
    assert told[0] == "Blocked force of 3 actuators"
    assert told[1:7] == line_words(one)
    assert set(told[7:]) == {"a", "b", "c", "mean ± 1 SD of actuators", "line", "95 % band"}
    assert texts(draw_force_figure(one, drawn=True))[0].endswith(": drawn, not measured")


def test_points_whiskers_and_line_are_where_the_numbers_are() -> None:
    one = found()
    (ax,) = draw_force_figure(one).axes
    lines = {line.get_label(): line for line in ax.get_lines()}
    assert lines["b"].get_ydata() == pytest.approx(one.mean_N[1])
    assert lines["b"].get_xdata() == pytest.approx(one.pressure_MPa)
    assert one.line is not None
    at = lines["line"].get_xdata()
    assert lines["line"].get_ydata() == pytest.approx(one.line.at(np.asarray(at))[0])
    assert min(at) >= 0.1
    (bars,) = ax.containers
    ends = np.array([segment[:, 1] for segment in bars[2][0].get_segments()])
    assert np.diff(ends, axis=1).ravel() == pytest.approx(2 * one.sd_N)


def test_odd_names_many_actuators_lower_bounds_and_one_pressure_are_drawn() -> None:
    assert "$x_{$" in texts(draw_force_figure(found(("$x_{$", "b\x1b", "=1+1"))))
    many = texts(draw_force_figure(found(tuple(f"n{i}" for i in range(30)))))
    assert "actuators" in many and "n3" not in many
    assert "≥: lower bound" in texts(draw_force_figure(found(lower_bound=np.arange(12) > 8)))
    single = blocked_force([ActuatorCycles("a", np.array([3.0]), np.array([0.2]), np.zeros(1, bool))])
    assert any(text.startswith("No line") for text in texts(draw_force_figure(single)))


def test_no_words_run_out_of_the_figure() -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    stiff = blocked_force(
        [ActuatorCycles(n, s * LEVELS, LEVELS, np.zeros(12, bool)) for n, s in (("a", 1.1e5), ("b", 0.9e5))]
    )
    for one in (found(), stiff):
        figure = draw_force_figure(one)
        renderer = FigureCanvasAgg(figure).get_renderer()
        for text in figure.texts:
            assert text.get_window_extent(renderer).x1 < figure.bbox.width
