"""How far a law leaves, in biaxial tension, what I1 alone would say."""

import numpy as np
import pytest

from benchlab.simulation.laws import Ogden, Polynomial
from benchlab.simulation.laws.biaxial import PLAUSIBLE, biaxial_factor


def test_laws_of_the_first_invariant_alone_have_factor_one() -> None:
    for law in (Polynomial(0.4), Polynomial(0.5, C20=-0.01, C30=0.002), Ogden((0.5,), (2.0,))):
        assert biaxial_factor(law, 5.0) == pytest.approx(1.0, abs=1e-9)


def test_mooneys_law_has_the_closed_form() -> None:
    """P_b/P_u over the yardstick: (C10 + C01·λ_b²)/(C10 + C01/λ_u), largest at the largest stretch."""
    stretch = 3.0
    I1 = stretch**2 + 2 / stretch
    roots = np.roots([2, -I1, 0, 1])  # 2x³ − I1·x² + 1 = 0 in x = λ_b²
    x = max(roots[np.isreal(roots)].real)
    assert biaxial_factor(Polynomial(0.3, 0.1), stretch) == pytest.approx(
        (0.3 + 0.1 * x) / (0.3 + 0.1 / stretch), rel=1e-9
    )


def test_treloars_rubber_is_plausible_and_a_large_negative_exponent_is_not() -> None:
    """Ogden's (1972) coefficients hold in all three tests; of the second law's only the uniaxial stress is right."""
    published = biaxial_factor(Ogden((0.63, 0.0012, -0.01), (1.3, 5.0, -2.0)), 6.0)
    assert 1 / PLAUSIBLE < published < PLAUSIBLE
    assert biaxial_factor(Ogden((5.9e-8, -0.2027), (9.766, -4.568)), 6.0) > 100


def test_a_law_that_pushes_has_no_factor() -> None:
    assert np.isnan(biaxial_factor(Polynomial(0.5, -0.2), 4.0))
