"""The laws that a uniaxial test can be fitted with: their stress, its derivatives in the coefficients, and the least-squares solution."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, nnls

from benchlab.simulation.laws import POLYNOMIAL_TERMS, Law, Ogden, Polynomial
from benchlab.simulation.laws.homogeneous import nominal_stress_MPa
from benchlab.simulation.laws.law import FloatArray

LEAST_MODULUS = 1e-3
"""Initial modulus that a fit may not go below, as a share of the modulus that the largest stress would mean by Neo-Hooke's law."""

_GRID = (-8.0, -5.0, -3.0, -2.0, -1.0, 0.5, 1.3, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0)
_LIMIT = 25.0
_STARTS = 6
_ZERO = 0.01
_SAME = 0.01


@dataclass(frozen=True)
class Solution:
    """A fitted law: coefficient names and values, derivatives J (n, p) of the stress in them, and what to say about it."""

    law: Law
    names: tuple[str, ...]
    values: FloatArray
    J: FloatArray
    notes: tuple[str, ...] = ()


Solver = Callable[[FloatArray, FloatArray, FloatArray], Solution]
"""(stretch, nominal stress in MPa, weights), each (n,), to the weighted least-squares solution."""


def _solve_polynomial(name: str) -> Solver:
    terms = POLYNOMIAL_TERMS[name]

    def solve(stretch: FloatArray, stress: FloatArray, weights: FloatArray) -> Solution:
        X = np.stack([nominal_stress_MPa(Polynomial(**{"C10": 0.0, term: 1.0}), stretch) for term in terms], axis=1)
        values = _least_squares(X, stress, weights)
        at_rest = np.array([term in ("C10", "C01") for term in terms], dtype=float)
        least = LEAST_MODULUS * _typical_modulus_MPa(stretch, stress)
        if 2 * at_rest @ values >= least:
            return Solution(_polynomial(terms, values), terms, values, X)
        # Held at the bound: C10 = least/2 − C01, so that the others are free and C10 follows.
        free = np.eye(len(terms))[:, 1:]
        free[0] = -at_rest[1:]
        start = np.zeros(len(terms))
        start[0] = least / 2
        values = start + free @ _least_squares(X @ free, stress - X @ start, weights)
        note = f"the best {name} law has no positive initial modulus: it is held at {3 * least:.2g} MPa and does not suit the data"
        return Solution(_polynomial(terms, values), terms, values, X, (note,))

    return solve


def _polynomial(terms: tuple[str, ...], values: FloatArray) -> Polynomial:
    return Polynomial(**{"C10": 0.0, **{term: float(value) for term, value in zip(terms, values)}})


def _least_squares(X: FloatArray, y: FloatArray, weights: FloatArray) -> FloatArray:
    if not X.shape[1]:
        return np.zeros(0)
    root = np.sqrt(weights)
    columns = root[:, None] * X
    scale = np.linalg.norm(columns, axis=0)
    return np.linalg.lstsq(columns / scale, root * y, rcond=None)[0] / scale


def _typical_modulus_MPa(stretch: FloatArray, stress: FloatArray) -> float:
    at = int(np.argmax(np.abs(stress)))
    return float(abs(stress[at]) / max(abs(stretch[at] - stretch[at] ** -2), 1e-12))


def _solve_ogden(terms: int) -> Solver:
    """Ogden's law with positive products μ·α, which makes it stable everywhere (Ogden 1972).

    For given exponents the best products are found by non-negative least squares; the best combinations of a grid of exponents
    are the starts from which all are refined together. The unknowns are exponents and shares of the largest stress.
    """

    def solve(stretch: FloatArray, stress: FloatArray, weights: FloatArray) -> Solution:
        far = stretch[np.argmax(np.abs(np.log(stretch)))]
        root, top = np.sqrt(weights), float(np.abs(stress).max())

        def columns(alpha: FloatArray) -> FloatArray:
            with np.errstate(over="ignore"):
                return _shape(alpha, stretch[:, None]) / abs(_shape(alpha, far))

        def misfit(unknowns: FloatArray) -> FloatArray:
            share, alpha = np.split(unknowns, 2)
            return root * (columns(alpha) @ share - stress / top)

        best = None
        for share, alpha in _starts(terms, lambda alpha: root[:, None] * columns(alpha), root * stress / top):
            found = least_squares(
                misfit,
                np.concatenate([np.clip(share, 1e-9, 1e3), alpha]),
                bounds=([0.0] * terms + [-_LIMIT] * terms, [np.inf] * terms + [_LIMIT] * terms),
                x_scale=np.concatenate([np.full(terms, 0.3), np.full(terms, 2.0)]),
                max_nfev=400,
            )
            if best is None or found.cost < best.cost:
                best = found
        assert best is not None
        share, alpha = np.split(best.x, 2)
        alpha = np.where(np.abs(alpha) < _ZERO, np.copysign(_ZERO, alpha), alpha)  # μ itself has no value at α = 0
        mu = top * share / abs(_shape(alpha, far)) / alpha
        return _ogden(stretch, mu, alpha, share)

    return solve


def _starts(
    terms: int, columns: Callable[[FloatArray], FloatArray], target: FloatArray
) -> list[tuple[FloatArray, FloatArray]]:
    tried = []
    for combination in itertools.combinations(_GRID, terms):
        alpha = np.array(combination)
        share, misfit = nnls(columns(alpha), target)
        tried.append((misfit, share, alpha))
    tried.sort(key=lambda one: one[0])
    return [(share, alpha) for _, share, alpha in tried[:_STARTS]]


def _shape(alpha: FloatArray, stretch: FloatArray) -> FloatArray:
    """(λ^(α−1) − λ^(−α/2−1))/α, uniaxial stress for μ·α = 1; its limit 3·ln λ/(2λ) at α = 0."""
    alpha = np.where(np.abs(alpha) < 1e-9, 1e-9, alpha)
    return stretch ** (-alpha / 2 - 1) * np.expm1(1.5 * alpha * np.log(stretch)) / alpha


def _ogden(stretch: FloatArray, mu: FloatArray, alpha: FloatArray, share: FloatArray) -> Solution:
    share, mu = share.copy(), mu.copy()
    for i, j in itertools.combinations(range(len(alpha)), 2):
        if abs(alpha[i] - alpha[j]) < _SAME and mu[j]:  # one term, found twice
            share[i], mu[i], share[j], mu[j] = share[i] + share[j], mu[i] + mu[j], 0.0, 0.0
    kept = share > 1e-6 * share.max()
    order = np.argsort(-share[kept])
    mu, alpha = mu[kept][order], alpha[kept][order]
    column = stretch[:, None]
    up, down = column ** (alpha - 1), column ** (-alpha / 2 - 1)
    J = np.concatenate([up - down, mu * np.log(column) * (up + down / 2)], axis=1)
    count = len(mu)
    names = tuple(f"{stem}{i}" for stem in ("mu", "alpha") for i in range(1, count + 1))
    notes = [] if kept.all() else [f"{count} of {len(kept)} terms are enough: the others vanish or are the same"]
    if np.any(np.abs(alpha) > 0.99 * _LIMIT):
        notes.append(f"an exponent ran to the limit of {_LIMIT:g}")
    law = Ogden(tuple(map(float, mu)), tuple(map(float, alpha)))
    return Solution(law, names, np.concatenate([mu, alpha]), J, tuple(notes))


SOLVERS: dict[str, Solver] = {
    **{name: _solve_polynomial(name) for name in POLYNOMIAL_TERMS},
    **{f"ogden-{terms}": _solve_ogden(terms) for terms in (1, 2, 3)},
}
"""What can be fitted: the polynomial laws by name, Ogden's with one, two and three terms."""
