"""Every law: derivatives against the complex step, closed forms of the three tests, special cases that are equal."""

import numpy as np
import pytest

from benchlab.errors import UsageError
from benchlab.simulation.laws import LAWS, Law, Ogden, Polynomial, StVenantKirchhoff, describe_law, make_law
from benchlab.simulation.laws.homogeneous import MODES, nominal_stress_MPa
from benchlab.simulation.laws.law import uniaxial_stress_MPa

FILES = {
    "neo-hooke": ({"C10": 0.4}, {}),
    "mooney-rivlin": ({"C10": 0.3, "C01": 0.1}, {}),
    "yeoh": ({"C10": 0.5, "C20": -0.02, "C30": 0.003}, {}),
    "polynomial-2": ({"C10": 0.4, "C01": 0.2, "C20": 0.05, "C11": -0.03, "C02": 0.02}, {}),
    "ogden": ({"mu1": 0.63, "mu2": 0.0012, "mu3": -0.01}, {"alpha1": 1.3, "alpha2": 5.0, "alpha3": -2.0}),
}
INCOMPRESSIBLE = {name: make_law(name, *FILES[name]) for name in FILES}
ALL: dict[str, Law] = {**INCOMPRESSIBLE, "svk": StVenantKirchhoff()}
# Squared principal stretches: apart, close to each other and equal.
X, Y = np.array([[1.7, 0.8], [2.5, 0.3], [9.0, 4.0], [1.3, 1.1], [1.2, 1.2 - 1e-6], [1.5, 1.5], [1.0, 1.0]]).T
LAMBDA = np.concatenate([np.linspace(0.4, 1.0, 7), np.linspace(1.0, 6.0, 11)])


@pytest.mark.parametrize("name", ALL)
def test_derivatives_are_those_of_the_energy(name: str) -> None:
    law, a, b, h = ALL[name], X + Y, X * Y, 1e-30
    at, da, db = law.energy(a, b), law.energy(a + 1j * h, b + 0j), law.energy(a + 0j, b + 1j * h)  # type: ignore[arg-type]
    for value, step in [
        (at.W_a, da.W), (at.W_b, db.W), (at.W_aa, da.W_a), (at.W_ab, db.W_a), (at.W_ab, da.W_b), (at.W_bb, db.W_b),
    ]:  # fmt: skip
        np.testing.assert_allclose(value, np.imag(step) / h, rtol=1e-10, atol=1e-11)


def closed_form(name: str, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Nominal stress along `first` by the principal stretches: (λ1·∂W/∂λ1 − λ3·∂W/∂λ3)/λ1 with W(λ1, λ2, λ3) as in textbooks."""
    law, third = INCOMPRESSIBLE[name], 1 / (first * second)
    if isinstance(law, Ogden):
        return sum(mu * (first**al - third**al) for mu, al in zip(law.mu_MPa, law.alpha)) / first
    assert isinstance(law, Polynomial)
    i = first**2 + second**2 + third**2 - 3
    j = first**-2 + second**-2 + third**-2 - 3
    W1 = law.C10 + 2 * law.C20 * i + 3 * law.C30 * i**2 + law.C11 * j
    W2 = law.C01 + law.C11 * i + 2 * law.C02 * j
    return 2 * (first**2 - third**2) * (W1 + W2 * second**2) / first


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("name", INCOMPRESSIBLE)
def test_stress_in_the_three_tests_is_the_closed_form(name: str, mode: str) -> None:
    expected = closed_form(name, *MODES[mode](LAMBDA))
    np.testing.assert_allclose(nominal_stress_MPa(INCOMPRESSIBLE[name], LAMBDA, mode), expected, rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("name", INCOMPRESSIBLE)
def test_uniaxial_stress_of_a_strip(name: str) -> None:
    law = INCOMPRESSIBLE[name]
    expected = closed_form(name, LAMBDA, LAMBDA**-0.5)
    np.testing.assert_allclose(uniaxial_stress_MPa(law, LAMBDA), expected, rtol=1e-10, atol=1e-10)
    slope = uniaxial_stress_MPa(law, np.array(1 + 1e-6)) / 1e-6
    assert slope == pytest.approx(3 * law.shear_modulus_MPa, rel=1e-5)  # E = 3 μ


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (Ogden((0.8,), (2.0,)), Polynomial(C10=0.4)),
        (Ogden((0.6, -0.2), (2.0, -2.0)), Polynomial(C10=0.3, C01=0.1)),
        # α = 4: Σλ⁴ − 3 = (I1−3)² + 6(I1−3) − 2(I2−3).
        (Ogden((0.4,), (4.0,)), Polynomial(C10=0.6, C01=-0.2, C20=0.1)),
        (Ogden((0.3, 0.3), (1.7, 1.7)), Ogden((0.6,), (1.7,))),
        (make_law("yeoh", {"C10": 0.4}), make_law("neo-hooke", {"C10": 0.4})),
        (make_law("polynomial-2", {"C10": 0.4, "C01": 0.1}), make_law("mooney-rivlin", {"C10": 0.4, "C01": 0.1})),
    ],
)
def test_special_cases_are_equal(one: Law, other: Law) -> None:
    x, y = np.meshgrid(np.linspace(0.3, 6, 40), np.linspace(0.3, 6, 40))
    left, right = one.energy(x + y, x * y), other.energy(x + y, x * y)
    for name in vars(left):
        np.testing.assert_allclose(getattr(left, name), getattr(right, name), rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize("alpha", [-11.0, -3.3, 0.2, 1.3, 7.7, 18.0])
def test_ogden_is_smooth_across_its_series(alpha: float) -> None:
    """The series and the closed form meet: no step in the second derivatives where one hands over to the other."""
    law, b = Ogden((1 / alpha,), (alpha,)), np.array(1.3)
    for name in vars(law.energy(b, b)):
        below, above = (float(getattr(law.energy(2 * np.sqrt(b) * (1.1 + e), b), name)) for e in (-1e-12, 1e-12))
        assert below == pytest.approx(above, rel=1e-9)
    round_off = law.energy(2 * np.sqrt(b) * (1 - 1e-16), b)  # a rounding below the least possible a
    assert all(np.isfinite(value) for value in vars(round_off).values())


@pytest.mark.parametrize("name", LAWS)
def test_a_law_is_made_again_from_its_description(name: str) -> None:
    described = describe_law(INCOMPRESSIBLE[name])
    assert described["law"] == name
    assert make_law(described["law"], described["coefficients_MPa"], described.get("exponents")) == INCOMPRESSIBLE[name]


@pytest.mark.parametrize(
    ("name", "coefficients", "exponents", "words"),
    [
        ("hooke", {"C10": 1.0}, {}, "use one of neo-hooke"),
        ("yeoh", {"C10": 1.0, "C11": 1.0}, {}, "no coefficient C11; it has C10, C20, C30"),
        ("yeoh", {"C10": -1.0}, {}, "initial shear modulus of -2 MPa"),
        ("neo-hooke", {}, {}, "initial shear modulus of 0 MPa"),
        ("neo-hooke", {"C10": 1.0}, {"alpha1": 2.0}, "no exponents"),
        ("neo-hooke", {"C10": float("nan")}, {}, "C10 of neo-hooke is nan"),
        ("ogden", {"mu1": 1.0}, {}, "as many exponents"),
        ("ogden", {"mu1": 1.0}, {"alpha1": 0.0}, "alpha not 0"),
        ("ogden", {"mu2": 1.0}, {"alpha2": 1.0}, "mu1, mu2"),
    ],
)
def test_impossible_laws_are_refused(name: str, coefficients: dict, exponents: dict, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        make_law(name, coefficients, exponents)
