"""The figures of control: what is drawn is what was found, and whose bench it was is said."""

import numpy as np
import pytest

from benchlab.control.flex import calibrate_flex
from benchlab.control.tracking import track
from benchlab.report.flex_figure import draw_flex_figure
from benchlab.report.tracking_figure import TrackedRun, draw_tracking_figure

T = np.arange(0, 20, 0.01)
REFERENCE = 70 + 60 * np.sin(2 * np.pi * 0.2 * T)
COMMAND = np.clip(0.2 + 0.25 * np.sin(2 * np.pi * 0.2 * T), 0, 0.35)


def test_a_tracked_run_is_drawn_with_error_and_limits() -> None:
    run = TrackedRun(T, REFERENCE, REFERENCE - 2, COMMAND, np.full(len(T), np.nan), 0.35, true_deg=REFERENCE - 1)
    measured, true = (track(T, REFERENCE, angle, COMMAND, 0.35, 5.0) for angle in (REFERENCE - 2, REFERENCE - 1))
    figure = draw_tracking_figure(run, measured, "a <$run_{$", "SIMULATED bench", 180.0, true)
    upper, middle, lower, tip = figure.axes
    lines = {line.get_label(): line.get_ydata() for line in upper.lines}
    assert lines["reference"] == pytest.approx(REFERENCE) and lines["true (simulated bench)"] == pytest.approx(
        REFERENCE - 1
    )
    assert [float(np.mean(line.get_ydata())) for line in middle.lines[1:]] == pytest.approx([2.0, 1.0])
    below = {line.get_label(): line for line in lower.lines}
    assert set(below) == {"ceiling", "commanded", "at a limit"}
    assert set(np.unique(below["at a limit"].get_ydata())) == {0.0, 0.35}
    words = figure.texts[2].get_text()
    assert "RMSE 2.00°" in words and "against the truth" in words and "RMSE 1.00°" in words and "first 5 s" in words
    assert figure.texts[0].get_text() == "a <$run_{$" and not figure.texts[0].get_parse_math()
    assert tip.get_xlabel() == "towards the strip (mm)"
    figure.canvas.draw()


def test_without_truth_none_is_drawn() -> None:
    run = TrackedRun(T, REFERENCE, REFERENCE - 2, COMMAND, COMMAND, 0.35)
    figure = draw_tracking_figure(run, track(T, REFERENCE, REFERENCE - 2, COMMAND, 0.35), "a", "bench b", 180.0)
    assert len(figure.axes[0].lines) == 2 and "truth" not in figure.texts[2].get_text()
    assert "measured at the regulator" in {line.get_label() for line in figure.axes[2].lines}


def test_a_reference_that_stands_still_has_no_r_squared() -> None:
    still = np.full(len(T), 60.0)
    run = TrackedRun(T, still, still - 2, COMMAND, COMMAND, 0.35)
    words = draw_tracking_figure(run, track(T, still, still - 2, COMMAND, 0.35), "a", "b", 180.0).texts[2].get_text()
    assert "no R²" in words and "lag not told" in words and "nan" not in words


def test_a_flex_calibration_is_drawn_hold_by_hold() -> None:
    levels = np.array([0.0, 0.1, 0.2, 0.3, 0.2, 0.1, 0.0])
    command = np.repeat(levels, 200)
    t = np.arange(len(command)) * 0.01
    volts = 3 - 4 * command + np.random.default_rng(0).normal(0, 1e-3, len(t))
    figure = draw_flex_figure(calibrate_flex(t, command, volts, t, 400 * command), "Flex sensor of a", "bench a")
    top, below = figure.axes
    lines = {line.get_label(): line for line in top.lines}
    assert len(lines["pressure rising"].get_xdata()) == 4 and len(lines["pressure falling"].get_xdata()) == 3
    (line,) = [str(label) for label in lines if "°/V" in str(label)]
    assert float(line.split()[0].replace("−", "-")) == pytest.approx(-100, abs=0.2)
    assert np.abs(np.concatenate([line.get_ydata() for line in below.lines[:2]])).max() < 0.1
    (band,) = below.get_legend().get_texts()
    assert band.get_text() == "± 1 SD of a hold"


def test_the_labels_of_small_residuals_stay_within_the_figure() -> None:
    """Five digits left of the axis push no label over the edge."""
    levels = np.repeat(np.array([0.0, 0.1, 0.2, 0.3, 0.2, 0.1, 0.0]), 200)
    t = np.arange(len(levels)) * 0.01
    noise = np.random.default_rng(0).normal(0, 1e-4, len(t))
    found = calibrate_flex(t, levels, 3 - 4 * levels + noise, t, 400 * levels)
    assert 0 < np.abs(found.residual_deg).max() < 0.01
    figure = draw_flex_figure(found, "a", "b")
    figure.canvas.draw()
    for ax in figure.axes:
        edges = ax.yaxis.label.get_window_extent()
        assert edges.x0 > 5
        assert all(edges.x1 < tick.get_window_extent().x0 for tick in ax.get_yticklabels() if tick.get_text())
