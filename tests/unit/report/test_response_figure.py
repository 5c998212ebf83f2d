"""Figures of a simulated actuator: what they say, and that the surface is drawn whole, in its colours, at its length."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.report.response_figure import draw_cell_figure, draw_response_figure
from benchlab.report.response_picture import SIDE, StretchScale, nice_length_mm, paint_surface
from benchlab.simulation.actuator_response import PUBLISHED_LEVER_ARM_MM, ActuatorResponse, actuator_response
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup
from benchlab.simulation.surface import whole_actuator


@pytest.fixture(scope="module")
def response() -> ActuatorResponse:
    layup = Layup("$t$ \x1b", "guessed", film=Polynomial(C10=1.5, C20=3.0))
    return actuator_response(ShellDesign(10, 9), layup, [0.0, 0.1], cap_mm=10)


def words(figure) -> str:
    texts = [text.get_text() for text in figure.texts]
    for ax in figure.axes:
        texts += [ax.get_xlabel(), ax.get_ylabel(), *(text.get_text() for text in ax.texts)]
    for legend in figure.legends:
        texts += [text.get_text() for text in legend.get_texts()]
    return "\n".join(texts)


def test_the_figure_says_what_it_is_of(response) -> None:
    found = words(draw_response_figure(response))
    for part in ("tw9_slw10, simulated", f"{response.angle_deg[-1]:.1f}° at 0.1 MPa", "material $t$", "caps 10 mm",
                 f"lever arm {PUBLISHED_LEVER_ARM_MM:g} mm", "blocked force (N)", "volume (mL)", "cap", "strip", "fabric rib"):  # fmt: skip
        assert part in found
    assert "simulated: one cell at 0.1 MPa" in words(draw_cell_figure(response))


def test_a_limit_and_missing_values_are_shown(response) -> None:
    bare = replace(response, limit_pressure_MPa=0.12, moment_Nmm=np.full(2, np.nan))
    figure = draw_response_figure(bare)
    assert "no stable state beyond" in words(figure) and "no value" in words(figure)
    assert all(ax.get_xlim()[1] > 0.12 for ax in figure.axes if ax.get_ylabel() == "bending angle θ (°)")


def test_the_painted_actuator_is_in_one_piece_and_as_long_as_it_is(response) -> None:
    surface = whole_actuator(response.cell, response.free.points[0].state, response.design, 10)
    painting = paint_surface(surface, StretchScale.of(surface), SIDE, (800, 400), closed=True)
    covered = painting.rgba[..., 3] > 128
    columns = np.flatnonzero(covered.any(axis=0))
    assert columns[-1] - columns[0] + 1 == len(columns)  # no gap
    direction = SIDE.axes @ [0, 0, 1.0]
    length = 180 * abs(direction[0]) + 2 * response.cell.radius_mm * abs(direction[2])
    assert len(columns) / painting.px_per_mm == pytest.approx(length, rel=0.02)
    # no hole in the middle of it
    middle = covered[:, columns[len(columns) // 2]]
    rows = np.flatnonzero(middle)
    assert rows[-1] - rows[0] + 1 == len(rows)


@pytest.mark.parametrize("span", [3.0, 14.0, 150.0, 180.0, 900.0])
def test_scale_bars_are_round_and_neither_short_nor_long(span) -> None:
    length = nice_length_mm(span)
    assert 0.1 * span < length < 0.35 * span
    assert f"{length:.0e}"[0] in "125"
