"""Drucker stability: the tangent against differences of stress, limits against closed forms and published ones."""

import numpy as np
import pytest
from scipy.optimize import brentq

from benchlab.simulation.laws import Law, Ogden, Polynomial
from benchlab.simulation.laws.homogeneous import MODES
from benchlab.simulation.laws.stability import is_stable, stable_ranges, tangent_MPa

LAWS = [Polynomial(0.4), Polynomial(0.3, 0.1, 0.02, -0.01, 0.01), Ogden((0.63, 0.0012, -0.01), (1.3, 5.0, -2.0))]


@pytest.mark.parametrize("law", LAWS)
def test_tangent_is_the_second_derivative_in_log_strain(law: Law) -> None:
    def energy(e1: float, e2: float) -> float:
        x, y = np.exp(2 * e1), np.exp(2 * e2)
        return float(law.energy(np.array(x + y), np.array(x * y)).W)

    e1, e2, h = 0.4, -0.15, 1e-4
    D = tangent_MPa(law, np.exp(np.array(e1)), np.exp(np.array(e2)))
    d11 = (energy(e1 + h, e2) - 2 * energy(e1, e2) + energy(e1 - h, e2)) / h**2
    d22 = (energy(e1, e2 + h) - 2 * energy(e1, e2) + energy(e1, e2 - h)) / h**2
    d12 = (energy(e1 + h, e2 + h) - energy(e1 + h, e2 - h) - energy(e1 - h, e2 + h) + energy(e1 - h, e2 - h)) / (
        4 * h**2
    )
    np.testing.assert_allclose(D, [[d11, d12], [d12, d22]], rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("law", [LAWS[2], Ogden((-0.02,), (-7.4,)), Ogden((1e-8, -0.2), (9.8, -4.6))])
def test_ogden_with_positive_products_is_always_stable(law: Ogden) -> None:
    """D = diag(A1, A2) + A3 with A_i = μ·α·λ_i^α > 0, even where A3 is larger by 15 orders."""
    for ranges in stable_ranges(law):
        assert (ranges.low, ranges.high) == (0.1, 10.0) and not ranges.low_found and not ranges.high_found


def test_mooney_with_negative_c01_loses_stability_where_the_closed_form_says() -> None:
    """Equibiaxial, x = λ²: d²W/dt² is 8(C10·x + C01/x) along (1, −1) and 8(C10(x + 2/x²) + C01(1/x + 2x²)) along (1, 1)."""
    C10, C01 = 0.5, -0.05
    found = {r.mode: r for r in stable_ranges(Polynomial(C10, C01))}["equibiaxial"]
    x = brentq(lambda x: C10 * (x + 2 / x**2) + C01 * (1 / x + 2 * x**2), 1.5, 20)
    assert (found.low, found.high) == pytest.approx(((-C01 / C10) ** 0.25, x**0.5), rel=1e-9)
    assert found.low_found and found.high_found
    assert found.covers(0.6, found.high) and not found.covers(0.6, found.high + 0.01) and not found.covers(0.5, 1.1)


@pytest.mark.parametrize("mode", MODES)
def test_stable_is_what_the_eigenvalues_of_the_tangent_say(mode: str) -> None:
    rng, stretch = np.random.default_rng(3), np.geomspace(0.4, 3.0, 41)
    seen = set()
    for _ in range(60):
        law = Polynomial(*(rng.normal(0, 1, 6) * (1, 1, 0.2, 0.2, 0.2, 0.02)))
        least = np.linalg.eigvalsh(tangent_MPa(law, *MODES[mode](stretch)))[:, 0]
        np.testing.assert_array_equal(is_stable(law, stretch, mode), least > 0)
        seen |= set((least > 0).tolist())
    assert seen == {True, False}


@pytest.mark.parametrize("mode", MODES)
def test_yeoh_that_softens_is_caught_at_its_limit(mode: str) -> None:
    law = Polynomial(C10=0.5, C20=-0.05)
    found = {r.mode: r for r in stable_ranges(law)}[mode]
    assert found.high_found and 1 < found.high < 5
    assert is_stable(law, np.array(found.high * (1 - 1e-9)), mode) and not is_stable(
        law, np.array(found.high * (1 + 1e-9)), mode
    )


def test_an_unstable_start_is_said() -> None:
    for found in stable_ranges(Polynomial(C10=-0.1)):
        assert (found.low, found.high) == (1.0, 1.0) and found.low_found and found.high_found
