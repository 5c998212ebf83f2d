"""How well a fit knows its coefficients when the points of a curve are not independent.

One curve: variance inflated by the correlation of neighbouring residuals (effective number of points n·(1−ρ)/(1+ρ); Bayley and
Hammersley 1946). Several specimens: sandwich of the specimens' scores (Liang and Zeger 1986), t with specimens − 1 degrees of freedom.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

from benchlab.simulation.laws.law import FloatArray

CONFIDENCE = 0.95
SEPARABLE = 30.0
"""Condition number of the scaled columns above which coefficients are said not to be separable (Belsley, Kuh and Welsch 1980)."""

LEAST_DEGREES = 2.0
"""Degrees of freedom that a single curve is always granted; where a law misses the curve by a smooth wave there are no more."""


@dataclass(frozen=True)
class Precision:
    """half_width: of the 95 % interval of each coefficient. residual_correlation: of neighbouring residuals, ρ >= 0.
    effective_points: independent points that the curves are worth. degrees: degrees of freedom of the intervals."""

    half_width: FloatArray
    residual_correlation: float
    effective_points: float
    degrees: float


def equal_weights(sizes: Sequence[int]) -> FloatArray:
    """Weights of the points of specimens of these sizes: each specimen counts alike, the mean is 1."""
    total = sum(sizes)
    return np.concatenate([np.full(n, total / (len(sizes) * n)) for n in sizes])


def precision(J: FloatArray, residual: FloatArray, sizes: Sequence[int]) -> Precision:
    """Precision of a least-squares fit: J (n, p) its derivatives, residual (n,), points specimen after specimen."""
    weights = equal_weights(sizes)
    n, p = J.shape
    rho = _neighbour_correlation(residual, sizes, p)
    effective = max(1.0, n * (1 - rho) / (1 + rho))
    scale = np.linalg.norm(np.sqrt(weights)[:, None] * J, axis=0)
    scale = np.where(scale > 0, scale, 1.0)
    J = J / scale
    bread = _inverse_square(np.sqrt(weights)[:, None] * J)
    if len(sizes) > 1:
        ends = np.cumsum(sizes)[:-1]
        scores = [part.sum(0) for part in np.split(weights[:, None] * residual[:, None] * J, ends)]
        covariance = bread @ sum(np.outer(s, s) for s in scores) @ bread * len(sizes) / (len(sizes) - 1)
        degrees = float(len(sizes) - 1)
    else:
        worth = max(effective, p + LEAST_DEGREES)
        degrees = worth - p
        variance = float(residual @ residual) / n * worth / degrees
        covariance = variance * n / worth * bread
    half = student.ppf((1 + CONFIDENCE) / 2, degrees) * np.sqrt(np.clip(np.diag(covariance), 0, None)) / scale
    return Precision(half, rho, effective, degrees)


def inseparable(J: FloatArray, sizes: Sequence[int]) -> tuple[float, NDArray[np.intp]]:
    """Condition number of the scaled columns of J, and the columns that take part in the worst combination.

    They are those with more than half of their variance in it (variance-decomposition proportions).
    """
    columns = np.sqrt(equal_weights(sizes))[:, None] * J
    norms = np.linalg.norm(columns, axis=0)
    if not norms.size or not (norms > 0).all():
        return float("inf"), np.flatnonzero(norms == 0)
    _, s, Vt = np.linalg.svd(columns / norms, full_matrices=False)
    if s[-1] <= 0:
        return float("inf"), np.flatnonzero(np.abs(Vt[-1]) > 0.1)
    condition = float(s[0] / s[-1])
    shares = (Vt / s[:, None]) ** 2
    worst = shares[-1] / shares.sum(0)
    return condition, np.flatnonzero(worst > 0.5) if condition > SEPARABLE else np.array([], dtype=np.intp)


def _inverse_square(columns: FloatArray) -> FloatArray:
    """(XᵀX)⁻¹ by singular values, of which none is left out: what cannot be told apart gets a large variance."""
    _, s, Vt = np.linalg.svd(columns, full_matrices=False)
    scaled = Vt / np.maximum(s, np.finfo(float).tiny ** 0.25)[:, None]
    return scaled.T @ scaled


def _neighbour_correlation(residual: FloatArray, sizes: Sequence[int], p: int) -> float:
    """ρ of neighbours within specimens, not below 0; a fit with p coefficients lowers it by about (1+ρ)·p/n, which is given back."""
    parts = np.split(residual, np.cumsum(sizes)[:-1])
    power = sum(float(part @ part) for part in parts)
    if power == 0:
        return 0.0
    rho = sum(float(part[1:] @ part[:-1]) for part in parts) / power
    rho += (1 + rho) * (p + 1) / len(residual)
    return min(max(rho, 0.0), 0.999)
