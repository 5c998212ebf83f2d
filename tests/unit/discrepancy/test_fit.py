from dataclasses import replace

import numpy as np
import pytest

from benchlab.discrepancy.fit import fit, nothing, placed, scale_of
from benchlab.discrepancy.problem import Problem
from tests.unit.discrepancy.drawn import active, problem


def without_noise(*actives) -> Problem:  # type: ignore[no-untyped-def]
    """Measured is exactly what the model gives."""
    made = problem(1, designs=2, protocol=("slow", "fast"))
    return replace(made, features=replace(made.features, value=made.cells(actives)))


def test_two_effects_come_back_exactly_where_there_is_no_noise() -> None:
    made = without_noise(active("end_caps", cap_mm=6.5), active("pressure_offset", offset_MPa=0.011))
    found = fit(made, [active("end_caps"), active("pressure_offset")], steps=30)
    assert found.actives[0].values["cap_mm"] == pytest.approx(6.5, rel=1e-3)
    assert found.actives[1].values["offset_MPa"] == pytest.approx(0.011, rel=1e-3)
    assert found.misfit == pytest.approx(0, abs=1e-2) and nothing(made).misfit > 100


def test_a_value_beyond_its_bound_is_fitted_at_the_bound() -> None:
    made = without_noise(active("camera_scale", factor=0.9))
    found = fit(made, [active("end_caps")])
    assert found.actives[0].values["cap_mm"] == 0.0  # a longer angle would need a cap below none


def test_the_tangent_is_the_derivative_of_the_model() -> None:
    made = without_noise(active("camera_scale", factor=1.05))
    found = fit(made, [active("camera_scale")])
    (one,) = found.actives
    step = 1e-5
    up, down = (made.model(placed([one], np.array([one.values["factor"] + s]))) for s in (step, -step))
    scale = scale_of(one.effect.parameters[0])
    assert found.tangent[:, 0] == pytest.approx((up - down) / (2 * step) * scale, rel=0.01, abs=1e-6)
