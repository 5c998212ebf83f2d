"""Variances of cycles and samples by restricted maximum likelihood, for samples with unlike numbers of cycles."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from benchlab.stats.groups import mean_of, squares_about
from benchlab.units import FloatArray

LOG_RATIOS = np.linspace(-40.0, 70.0, 441)
"""Logarithms of the ratio of the variances among which the likelihood's top is first looked for."""


def reml_variances(cycles: Mapping[str, Mapping[str, FloatArray]]) -> tuple[float, float]:
    """(within samples, between samples of a design): a linear mixed model, design fixed, sample random. Cycles must scatter.

    The restricted likelihood of both variances is one of their ratio ρ alone (Searle, Casella and McCulloch 1992, Variance
    Components, 6.6): with w = n/(1 + n·ρ) of each sample and Q(ρ) the squares within samples and Σ w·(mean − that of the design)²,
    the variance within is Q/(N − designs), and −2·log L is (N − designs)·log Q + Σ log(1 + n·ρ) + Σ log(Σ w of a design). Where that
    rises from ρ = 0 samples do not differ beyond their cycles, and the variance is that of all cycles about their design.

    >>> a, b = reml_variances({"a": {"1": np.array([1.0, 3.0]), "2": np.array([7.0, 9.0]), "3": np.array([4.0, 6.0])}})
    >>> round(a, 3), round(b, 3)
    (2.0, 8.0)
    """
    rows = [(index, row) for index, samples in enumerate(cycles.values()) for row in samples.values()]
    design = np.array([index for index, _ in rows])
    n = np.array([len(row) for _, row in rows])
    mean = np.array([mean_of(row.tolist()) for _, row in rows])
    size = np.bincount(design, n)
    about = mean - (np.bincount(design, n * mean) / size)[design]
    within = math.fsum(squares_about(row, middle) for (_, row), middle in zip(rows, mean.tolist()))
    total = within + math.fsum((n * about**2).tolist())
    df = int(n.sum()) - len(size)
    falls = df * float(((n * about) ** 2).sum()) <= total * (n.sum() - float((np.bincount(design, n**2) / size).sum()))
    return (total / df, 0.0) if falls else _top(n, mean, design, within, df)


def _top(n: np.ndarray, mean: FloatArray, design: np.ndarray, within: float, df: int) -> tuple[float, float]:
    """Both variances where the likelihood is highest. n, mean, design: (S,) of samples; within: squares within them."""
    from scipy.optimize import minimize_scalar

    def squares(log_ratio: float) -> tuple[FloatArray, float]:
        w = n / (1 + n * math.exp(log_ratio))
        about = mean - (np.bincount(design, w * mean) / np.bincount(design, w))[design]
        return w, within + float((w * about**2).sum())

    def misfit(log_ratio: float) -> float:
        w, q = squares(log_ratio)
        return df * math.log(q) + float(np.log(n / w).sum() + np.log(np.bincount(design, w)).sum())

    near = min(LOG_RATIOS, key=misfit)
    step = LOG_RATIOS[1] - LOG_RATIOS[0]
    found = minimize_scalar(misfit, bounds=(near - step, near + step), method="bounded", options={"xatol": 1e-12})
    variance = squares(found.x)[1] / df
    return variance, math.exp(found.x) * variance
