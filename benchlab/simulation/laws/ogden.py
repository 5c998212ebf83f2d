"""Ogden's strain energy W = Σ μ_i/α_i·(λ1^α_i + λ2^α_i + λ3^α_i − 3), smooth where principal stretches are equal.

Convention of Ogden (1972), Proc. R. Soc. A 326, 565-584: the initial shear modulus is ½ Σ μ_i α_i. (Abaqus writes 2 μ_i/α_i²
in front instead: its μ_i is ours times α_i/2.)
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from benchlab.errors import UsageError
from benchlab.simulation.laws.law import Energy, FloatArray

_NEAR = 0.1
_TERMS = 24


@dataclass(frozen=True)
class Ogden:
    """Coefficients μ_i in MPa and exponents α_i, as many of the one as of the other.

    >>> treloar = Ogden(mu_MPa=(0.63, 0.0012, -0.01), alpha=(1.3, 5.0, -2.0))  # Ogden (1972)
    >>> round(treloar.shear_modulus_MPa, 4)
    0.4225
    """

    mu_MPa: tuple[float, ...]
    alpha: tuple[float, ...]

    def __post_init__(self) -> None:
        if not self.mu_MPa or len(self.mu_MPa) != len(self.alpha):
            raise UsageError(
                f"Ogden's law with {len(self.mu_MPa)} mu and {len(self.alpha)} alpha", hint="give a pair for each term"
            )
        for mu, alpha in zip(self.mu_MPa, self.alpha):
            if not (math.isfinite(mu) and math.isfinite(alpha) and alpha != 0):
                raise UsageError(f"Ogden's law with mu {mu} MPa, alpha {alpha}", hint="give finite values, alpha not 0")

    @property
    def incompressible(self) -> bool:
        return True

    @property
    def shear_modulus_MPa(self) -> float:
        return sum(mu * alpha for mu, alpha in zip(self.mu_MPa, self.alpha)) / 2

    def energy(self, a: FloatArray, b: FloatArray) -> Energy:
        terms = [_term(mu / alpha, alpha / 2, a, b) for mu, alpha in zip(self.mu_MPa, self.alpha)]
        return Energy(*(sum(parts) for parts in zip(*terms)))


def _term(factor: float, m: float, a: FloatArray, b: FloatArray) -> tuple[FloatArray, ...]:
    """W, W_a, W_b, W_aa, W_ab, W_bb of factor·(x^m + y^m + b^(−m) − 3), x and y the eigenvalues of C.

    With x, y = √b·exp(±t) and c = cosh t = a/(2√b) the sum x^m + y^m is 2·b^(m/2)·T_m(c).
    """
    r = 1 / b
    c = a * np.sqrt(r) / 2
    c_a, c_b = np.sqrt(r) / 2, -c * r / 2
    c_ab, c_bb = -c_a * r / 2, 3 * c * r**2 / 4
    T, T1, T2 = _chebyshev(m, c)
    g, z = 2 * b ** (m / 2), b**-m
    g_b, g_bb = g * r * m / 2, g * r**2 * m * (m - 2) / 4
    return (
        factor * (g * T + z - 3),
        factor * g * T1 * c_a,
        factor * (g_b * T + g * T1 * c_b - m * z * r),
        factor * g * T2 * c_a**2,
        factor * (g_b * T1 * c_a + g * T2 * c_a * c_b + g * T1 * c_ab),
        factor * (g_bb * T + 2 * g_b * T1 * c_b + g * (T2 * c_b**2 + T1 * c_bb) + m * (m + 1) * z * r**2),
    )


def _chebyshev(m: float, c: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """T_m(c) = cosh(m·arcosh c), the Chebyshev function of real order, and two derivatives, for c >= 1.

    It is analytic at c = 1 (Abramowitz and Stegun 15.4.1: 2F1(−m, m; ½; (1−c)/2)); near there the power series is summed.
    """
    d = np.asarray(c - 1)
    near = np.real(d) < _NEAR
    t = np.arccosh(np.where(near, 2.0, c))
    sinh = np.sinh(t)
    T, T1 = np.cosh(m * t), m * np.sinh(m * t) / sinh
    T2 = (m * m * T - c * T1) / sinh**2  # (1 − c²)·T'' − c·T' + m²·T = 0
    if not near.any():
        return T, T1, T2
    s, s1, s2 = _series(m, np.where(near, d, 0.0))
    return np.where(near, s, T), np.where(near, s1, T1), np.where(near, s2, T2)


def _series(m: float, d: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    coefficients = [1.0]
    for k in range(_TERMS):
        coefficients.append(coefficients[-1] * (m * m - k * k) / ((2 * k + 1) * (k + 1)))
    value, first, second = (np.zeros_like(d) for _ in range(3))
    for coefficient in reversed(coefficients):  # Horner, with the derivatives carried along
        second = second * d + 2 * first
        first = first * d + value
        value = value * d + coefficient
    return value, first, second
