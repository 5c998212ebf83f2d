"""The picture of a calibration: every reading twice, the line to the limit, and that a twin's is no measurement."""

import numpy as np
import pytest

from benchlab.bench import Bench, Line
from benchlab.report.bench_figure import draw_bench_figure

BENCH = Bench(
    "left_$1", Line(0.0965, -0.001, 0.0005), gauge="Keller", date="2026-05-31", supply_V=4.93, calibrated=True
)
VOLTS = np.array([0.5, 1.5, 3.0, 1.5])
PRESSURE = BENCH.regulator.gain * VOLTS + BENCH.regulator.offset + np.array([0.0, 0.001, 0.0, -0.001])
RISING = (True, True, True, False)


def test_readings_residuals_and_the_limit_are_drawn() -> None:
    figure = draw_bench_figure(BENCH, VOLTS, PRESSURE, RISING)
    top, below = figure.axes
    lines = {line.get_label(): line for line in top.lines}
    assert list(lines["rising"].get_xdata()) == [0.5, 1.5, 3.0] and list(lines["falling"].get_xdata()) == [1.5]
    assert list(below.lines[0].get_ydata()) == pytest.approx([0, 1, 0], abs=1e-9)
    assert list(below.lines[1].get_ydata()) == pytest.approx([-1], abs=1e-9)
    (dashed,) = [line for line in top.lines if line.get_linestyle() == "--"]
    assert dashed.get_ydata()[-1] == pytest.approx(350)
    assert str(BENCH.ceiling_code) in top.texts[0].get_text()


@pytest.mark.parametrize("simulated", [True, False])
def test_only_a_simulated_one_says_so(simulated: bool) -> None:
    title = draw_bench_figure(BENCH, VOLTS, PRESSURE, RISING, simulated).texts[0].get_text()
    assert ("simulated, not measured" in title) == simulated
