"""Where simulation and measurement disagree: features whose gap is more than the scatter of samples allows, all considered together."""

from __future__ import annotations

from itertools import groupby

import numpy as np

from benchlab.discrepancy.explanation import Region
from benchlab.discrepancy.features import Feature
from benchlab.discrepancy.problem import PRIOR_FREEDOM, Problem
from benchlab.units import FloatArray

SIGNIFICANT = 0.05
DRAWS = 2000


def gaps(problem: Problem, cells: FloatArray) -> FloatArray:
    """(F,): measured − model, mean over samples. cells: (C,) of the model."""
    return problem.mean_over_samples(problem.features.value - cells)


def gap_p(problem: Problem, cells: FloatArray, generator: np.random.Generator) -> FloatArray:
    """(F,): p of each feature's gap, simultaneous over all features: share of draws of scatter in which the largest |t| is larger."""
    features, scatter = problem.features, problem.scatter
    t = np.zeros(len(features.features))
    largest = np.zeros(DRAWS)
    unknown = np.sqrt(problem.freedom / generator.chisquare(problem.freedom, DRAWS))[:, None]
    for design, where in enumerate(scatter.features_of):
        samples = np.flatnonzero(features.sample_design == design)
        table = np.full((len(samples), len(where)), np.nan)
        for row, sample in enumerate(samples):
            mine = features.sample == sample
            table[row, np.searchsorted(where, features.feature[mine])] = features.value[mine] - cells[mine]
        known = np.isfinite(table)
        n = known.sum(axis=0)
        used = n > 0
        sd = np.sqrt(np.diag(scatter.covariance[design])[used])
        lower = np.linalg.cholesky(scatter.covariance[design][np.ix_(used, used)])
        t[where[used]] = _t(table[:, used], sd, known[:, used])
        draws = generator.standard_normal((DRAWS, int(used.sum()))) @ lower.T / np.sqrt(n[used]) * unknown
        largest = np.maximum(largest, np.abs(draws / (sd / np.sqrt(n[used]))).max(axis=-1))
    return np.asarray((1 + (largest[:, None] >= np.abs(t)[None, :]).sum(axis=0)) / (DRAWS + 1))


def _t(table: FloatArray, sd: FloatArray, known: np.ndarray) -> FloatArray:
    """(…, n, F) → (…, F): mean over its standard error, the variance moderated by the fitted one."""
    n = known.sum(axis=0)
    filled = np.where(known, table, 0.0)
    mean = filled.sum(axis=-2) / n
    squares = (np.where(known, table - mean[..., None, :], 0.0) ** 2).sum(axis=-2)
    variance = (PRIOR_FREEDOM * sd**2 + squares) / (PRIOR_FREEDOM + n - 1)
    return np.asarray(mean / np.sqrt(variance / n))


def regions(problem: Problem, gap: FloatArray, p: FloatArray) -> tuple[Region, ...]:
    """Neighbouring intervals of significant gaps of one sign, of each design, kind of run, cycle and direction; of any gap without a p."""
    told = ~(p >= SIGNIFICANT)
    features = problem.features.features
    found = []
    order = sorted(range(len(features)), key=lambda i: (_curve(features[i]), features[i].bin))
    for _, group in groupby(order, key=lambda i: _curve(features[i])):
        stretch: list[int] = []
        for i in [*group, -1]:
            last = stretch[-1] if stretch else i
            apart = i < 0 or features[i].bin > features[last].bin + 1 or np.sign(gap[i]) != np.sign(gap[last])
            if stretch and (apart or not told[i]):
                found.append(_region(problem, stretch, gap, p))
                stretch = []
            if i >= 0 and told[i]:
                stretch.append(i)
    return tuple(found)


def _curve(feature: Feature) -> tuple[int, str, int, int, int, str]:
    return (feature.design, feature.quantity, feature.kind, feature.occurrence, feature.cycle, feature.direction)


def _region(problem: Problem, stretch: list[int], gap: FloatArray, p: FloatArray) -> Region:
    features = [problem.features.features[i] for i in stretch]
    first = features[0]
    rate = problem.features.kinds[first.kind].told_rate(first.rate_MPa_s)
    pressures = [feature.pressure_MPa for feature in features]
    return Region(
        design=problem.scene.names[first.design],
        quantity=first.quantity,
        direction=first.direction,
        rate_MPa_s=rate if np.isfinite(rate) else None,
        cycle=first.cycle,
        pressure_MPa=(float(min(pressures)), float(max(pressures))),
        gap=float(np.mean(gap[stretch])),
        p=float(np.min(p[stretch])),
    )
