"""The picture of a plan: what is drawn is what will be asked for."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from benchlab.io.protocol_file import read_protocol, shipped_protocols
from benchlab.protocol.curvature import AngleHold
from benchlab.protocol.groups import Repeat, Signal
from benchlab.protocol.plan import PlanEvent
from benchlab.protocol.segments import Hold, Ramp, Sine, Vent
from benchlab.protocol.unroll import unroll
from benchlab.report.protocol_figure import draw_protocol_figure, drawn_ticks
from benchlab.report.protocol_strip import event_rows


@pytest.mark.parametrize("name", shipped_protocols())
def test_words_stay_on_the_page_and_apart(name: str) -> None:
    plan = read_protocol(name)
    figure = draw_protocol_figure(plan, "a note", ceiling_MPa=0.336)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    page = figure.bbox
    strip = figure.axes[-1]
    boxes = [text.get_window_extent(renderer) for text in [*strip.texts, *figure.texts]]
    for box in boxes:
        assert box.x0 >= 0 and box.x1 <= page.x1 and box.y0 >= 0 and box.y1 <= page.y1
    for index, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[index + 1 :]), [t.get_text() for t in strip.texts]


def test_line_limit_and_reference_are_the_plans() -> None:
    plan = read_protocol("sine_tracking")
    upper, lower, strip = draw_protocol_figure(plan).axes
    np.testing.assert_array_equal(upper.lines[0].get_ydata(), plan.pressure_MPa)
    np.testing.assert_array_equal(lower.lines[0].get_ydata(), plan.reference_deg)
    assert any(np.allclose(line.get_ydata(), plan.limit_MPa) for line in upper.lines)
    words = [text.get_text() for text in strip.texts]
    assert "sine 60° ± 30°, 0.2 Hz, 8 cycles" in words and "▼ camera" in words and "approach" in words
    assert len(draw_protocol_figure(read_protocol("linear_ramp")).axes) == 2


def test_long_plans_are_thinned_without_losing_a_peak_or_a_jump() -> None:
    plan = unroll((Hold(1.0, 0.2), Sine(0.2, 0.1, 2.0, 8000)), "long", 100.0, 0.35)
    kept = drawn_ticks(plan.pressure_MPa, plan.step)
    assert len(kept) < 0.15 * len(plan.time_s) and kept[-1] == len(plan.time_s) - 1
    assert (plan.pressure_MPa[kept] > 0.2998).sum() > 4000 and (plan.pressure_MPa[kept] < 0.1002).sum() > 4000
    pulses = unroll((Hold(400.0, 0.1), Repeat(50, (Hold(0.02, 0.3), Vent(0.5)))), "pulses", 100.0, 0.35)
    borders = np.flatnonzero(np.diff(pulses.step))
    kept = drawn_ticks(pulses.pressure_MPa, pulses.step)
    assert np.isin([borders, borders + 1], kept).all()  # each jump is as steep as it is


def test_words_of_marks_that_come_again_stand_once() -> None:
    body = (Signal("mark", "begin"), Ramp(0.1, duration_s=1.0), Signal("trigger", "camera"), Vent(1.0))
    strip = draw_protocol_figure(unroll((Repeat(30, body),), "many $x_{$", 100.0, 0.35)).axes[-1]
    assert [text.get_text() for text in strip.texts if text.get_text() in ("begin", "▼ camera")] == [
        "begin",
        "▼ camera",
    ]


def test_marks_beside_each_other_get_rows_of_their_own() -> None:
    events = tuple(PlanEvent(time, "mark", "some words") for time in (0.0, 0.1, 5.0, 9.9, 10.0))
    assert event_rows(events, 10.0, 8.0) == [1, 0, 0, 1, 0]


def test_the_colours_of_blocks_have_a_key() -> None:
    parts = (Ramp(0.1, duration_s=1.0), Hold(1.0), Sine(0.1, 0.05, 1.0, 2), AngleHold(60.0, 5.0), Vent(1.0))
    figure = draw_protocol_figure(unroll(parts, "all", 100.0, 0.35), "a long note " * 40)
    (key,) = figure.legends
    assert [text.get_text() for text in key.get_texts()] == ["ramp, sine", "hold", "vent", "angle controlled"]
    colours = {block.get_facecolor() for block in key.get_patches()}
    blocks = {patch.get_facecolor() for patch in figure.axes[-1].patches}
    assert colours == blocks and len(colours) == 4
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    box = key.get_window_extent(canvas.get_renderer())
    others = [*figure.axes[-1].texts, *figure.texts]
    assert not any(box.overlaps(text.get_window_extent(canvas.get_renderer())) for text in others)
