"""Variances of cycles and samples by restricted maximum likelihood, for samples with unlike numbers of cycles.

statsmodels' MixedLM has the same model; where samples hardly differ it stops at a singular matrix. With one random factor the likelihood
depends on one number, the ratio of the variances, so that its highest point is found on a line.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from scipy import optimize

from benchlab.stats.groups import mean_of, squares_about
from benchlab.units import FloatArray

_RATIOS = np.concatenate([[0.0], np.geomspace(1e-9, 1e15, 481)])
"""Of the variance between samples to that of cycles; the likelihood is first looked at here."""


def reml_variances(cycles: Mapping[str, Mapping[str, FloatArray]]) -> tuple[float, float]:
    """(within samples, between samples of a design): a linear mixed model, design fixed, sample random. Cycles must scatter.

    Profile over the ratio ρ (Searle, Casella and McCulloch 1992, Variance Components, 6.6): with w = n/(1 + ρn) for a sample of n cycles,
    Q = Σ squares within + Σ w·(sample mean − design mean)², design means weighted by w, N cycles and k designs, minimise
    (N − k)·ln Q + Σ ln(1 + ρn) + Σ over designs ln Σw. The variances are Q/(N − k) and ρ times that.

    >>> a, b = reml_variances({"a": {"1": np.array([1.0, 3.0]), "2": np.array([7.0, 9.0]), "3": np.array([4.0, 6.0])}})
    >>> round(a, 6), round(b, 6)
    (2.0, 8.0)
    """
    designs = [
        (
            np.array([len(row) for row in samples.values()]),
            np.array([mean_of(row.tolist()) for row in samples.values()]),
        )
        for samples in cycles.values()
    ]
    within = math.fsum(
        squares_about(row, mean_of(row.tolist())) for samples in cycles.values() for row in samples.values()
    )
    df = sum(int(n.sum()) for n, _ in designs) - len(designs)

    def squares(ratio: float) -> float:
        return within + sum(_about_weighted_mean(mean, n / (1 + ratio * n)) for n, mean in designs)

    def misfit(ratio: float) -> float:
        of_samples = sum(float(np.log1p(ratio * n).sum()) + math.log((n / (1 + ratio * n)).sum()) for n, _ in designs)
        return df * math.log(squares(ratio)) + of_samples

    seen = [misfit(ratio) for ratio in _RATIOS]
    best = int(np.argmin(seen))
    if seen[0] - seen[best] < 1e-9:
        return squares(0.0) / df, 0.0
    low, high = _RATIOS[best - 1], _RATIOS[min(best + 1, len(_RATIOS) - 1)]
    found = optimize.minimize_scalar(misfit, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * high})
    ratio = float(found.x)
    return squares(ratio) / df, ratio * squares(ratio) / df


def _about_weighted_mean(values: FloatArray, weights: FloatArray) -> float:
    centre = float((weights * values).sum() / weights.sum())
    return float((weights * (values - centre) ** 2).sum())
