"""The picture of a fit: what is drawn where, with names that want to be markup."""

import numpy as np

from benchlab.report.material_figure import draw_material_figure
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.laws.homogeneous import nominal_stress_MPa
from benchlab.simulation.tensile.fit_law import Specimen, fit_laws

STRETCH = np.linspace(1.0, 2.0, 30)
TEST = Specimen(STRETCH, nominal_stress_MPa(Polynomial(0.4), STRETCH))


def test_laws_are_solid_over_the_tests_and_dashed_beyond() -> None:
    fits = fit_laws([TEST], ["neo-hooke", "yeoh"])
    figure = draw_material_figure([("$x_{$.csv", TEST), ("b" * 500, TEST)], fits, "yeoh", "<b>$a_{$\n</b>")
    figure.canvas.draw()  # mathtext would fail here
    upper, lower, bars = figure.axes
    solid = [line for line in upper.lines if line.get_linestyle() == "-" and len(line.get_xdata()) == 300]
    dashed = [line for line in upper.lines if len(line.get_xdata()) == 60]
    assert len(solid) == len(dashed) == 2
    assert all(max(line.get_xdata()) <= 2.0 for line in solid) and all(min(line.get_xdata()) >= 2.0 for line in dashed)
    assert solid[1].get_linewidth() > solid[0].get_linewidth()
    np.testing.assert_allclose(
        solid[0].get_ydata(), 0.8 * (solid[0].get_xdata() - solid[0].get_xdata() ** -2.0), atol=1e-9
    )
    residuals = [line for line in lower.lines if len(line.get_xdata()) == 30]
    assert len(residuals) == 4 and all(np.abs(line.get_ydata()).max() < 1e-6 for line in residuals)
    assert len([line for line in bars.lines if len(line.get_xdata()) == 2]) == 6
    assert any("dashed beyond the tests" in text.get_text() for text in figure.texts)


def test_many_specimens_keep_the_legend_short() -> None:
    fits = fit_laws([TEST], ["neo-hooke"])
    figure = draw_material_figure([(f"{i}.csv", TEST) for i in range(20)], fits, "neo-hooke", "many")
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels[-1] == "and 14 more" and len(labels) == 7
