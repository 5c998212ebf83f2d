"""How samples of one design scatter about their mean: variance components, fitted without the simulation.

    V = gain² g gᵀ + pressure² s sᵀ + shape² S + loop² l lᵀ + (runs: offset², gain²) + drift (two times) + white²/count + local²

g: the design's mean curve; s: its slope; S: a smooth deviation over pressure; l: the loop's width; of each quantity apart. Between the n
samples of a design, Σ(x − x̄)(x − x̄)ᵀ is Wishart with n − 1 degrees of freedom and V, whose likelihood (restricted maximum likelihood;
Searle, Casella and McCulloch, Variance Components, 1992) is maximised. So the simulation has no say in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from benchlab.discrepancy.features import Feature, Features
from benchlab.units import FloatArray

TIMES_S = (0.5, 5.0)
"""Correlation times of drift within a run (chosen)."""

SHAPE_RANGE = 0.3
"""Over which share of the largest pressure a sample's smooth deviation keeps its sign (chosen)."""

NAMES = ("gain", "pressure", "shape", "loop", "run offset", "run gain", "fast drift", "slow drift", "white", "local")


@dataclass(frozen=True)
class Scatter:
    """covariance: of each design (F_d, F_d) over its features. features_of: their indices. components: sd of each, by quantity and name;
    freedom: degrees of freedom between samples, Σ(n − 1)."""

    covariance: tuple[FloatArray, ...]
    features_of: tuple[NDArray[np.int64], ...]
    components: dict[str, dict[str, float]]
    freedom: int


def scatter_of(features: Features) -> Scatter:
    """Fit the variance components. Where no design has two samples, freedom is 0 and the components are those that fits begin with."""
    designs = len(np.unique(features.sample_design))
    of_design = np.array([feature.design for feature in features.features])
    indices = tuple(np.flatnonzero(of_design == d) for d in range(designs))
    mean = feature_means(features)
    quantities = features.quantities
    count = _count(features)
    blocks = [components_of([features.features[i] for i in where], mean[where], count[where]) for where in indices]
    patterns = _patterns(features, indices, mean)
    log_sd, freedom = {}, sum(max(int((features.sample_design == d).sum()) - 1, 0) for d in range(designs))
    for quantity in quantities:
        log_sd[quantity] = _fit(features, indices, blocks, patterns, quantity)
    covariance = []
    for where, parts in zip(indices, blocks):
        total = np.zeros((len(where), len(where)))
        for quantity in quantities:
            total += np.tensordot(np.exp(2 * log_sd[quantity]), parts[quantity], 1)
        covariance.append(total)
    components = {q: {name: float(np.exp(value)) for name, value in zip(NAMES, log_sd[q])} for q in quantities}
    return Scatter(tuple(covariance), indices, components, freedom)


def feature_means(features: Features) -> FloatArray:
    """(F,): mean over the samples that have the feature."""
    total = np.bincount(features.feature, features.value, minlength=len(features.features))
    return np.asarray(total / np.bincount(features.feature, minlength=len(features.features)))


def _count(features: Features) -> FloatArray:
    """(F,): readings per sample, harmonic mean."""
    total = np.bincount(features.feature, 1 / features.count, minlength=len(features.features))
    return np.asarray(np.bincount(features.feature, minlength=len(features.features)) / total)


def components_of(features: list[Feature], mean: FloatArray, count: FloatArray) -> dict[str, FloatArray]:
    """By quantity: (components, F_d, F_d) covariance of each component at unit standard deviation."""
    pressure = np.array([f.pressure_MPa for f in features])
    time = np.array([f.time_s for f in features])
    seconds = np.array([max(f.seconds, 1e-6) for f in features])
    sign = np.array([{"loading": -1.0, "unloading": 1.0}.get(f.direction, 0.0) for f in features])
    run = np.unique([(f.kind, f.occurrence) for f in features], axis=0, return_inverse=True)[1].ravel()
    same_run = run[:, None] == run[None, :]
    kinds_of_quantity = np.array([f.quantity for f in features])
    out = {}
    top = max(float(pressure.max()), 1e-9)
    for quantity in sorted(set(kinds_of_quantity)):
        mine = kinds_of_quantity == quantity
        own = np.outer(mine, mine)
        scale = max(float(np.abs(mean[mine]).max()), 1e-9)
        g = np.where(mine, mean, 0.0)
        slope = np.where(mine, _slope(pressure, mean, mine), 0.0)
        x = pressure / top
        loop = np.where(mine, sign * scale * np.sqrt(np.clip(x * (1.05 - x), 0, None)) * 2, 0.0)
        smooth = np.exp(-0.5 * ((x[:, None] - x[None, :]) / SHAPE_RANGE) ** 2)
        weight = np.where(mine, np.sqrt(np.abs(mean) * scale), 0.0)
        parts = [np.outer(g, g), np.outer(slope, slope), smooth * np.outer(weight, weight), np.outer(loop, loop)]
        parts += [same_run * own * 1.0, same_run * np.outer(g, g)]
        for tau in TIMES_S:
            ratio = seconds / tau
            damped = np.sqrt(2 / ratio * (1 - -np.expm1(-ratio) / ratio))
            parts.append(
                same_run * own * np.exp(-np.abs(time[:, None] - time[None, :]) / tau) * np.outer(damped, damped)
            )
        parts += [np.diag(mine / count), np.diag(mine * 1.0)]
        out[quantity] = np.stack(parts)
    return out


def _slope(pressure: FloatArray, mean: FloatArray, mine: NDArray[np.bool_]) -> FloatArray:
    """(F,): slope over pressure of a cubic through the means."""
    if len(np.unique(pressure[mine].round(6))) < 5:
        return np.zeros_like(mean)
    top = float(pressure.max())
    fit = np.polynomial.Polynomial.fit(pressure[mine], mean[mine], 3, domain=[0, top])
    return np.asarray(fit.deriv()(pressure))


Pattern = tuple[int, NDArray[np.int64], FloatArray, float]
"""Design, places of the features within it, sum of outer products of deviations, number of samples (reduced by the mean)."""


def _patterns(features: Features, indices: tuple[NDArray[np.int64], ...], mean: FloatArray) -> list[Pattern]:
    """Samples that have the same features of the same design, together."""
    groups: dict[tuple[int, bytes], list[FloatArray]] = {}
    places: dict[tuple[int, bytes], NDArray[np.int64]] = {}
    number = np.bincount(features.feature, minlength=len(mean))
    for sample, design in enumerate(features.sample_design):
        cells = np.flatnonzero(features.sample == sample)
        shared = cells[number[features.feature[cells]] > 1]
        if len(shared) == 0:
            continue
        n = number[features.feature[shared]]
        deviation = (features.value[shared] - mean[features.feature[shared]]) * np.sqrt(n / (n - 1))
        place = np.searchsorted(indices[design], features.feature[shared])
        key = (int(design), place.tobytes())
        groups.setdefault(key, []).append(deviation)
        places[key] = place
    out = []
    for (design, code), deviations in groups.items():
        samples = float((features.sample_design == design).sum())
        stacked, share = np.array(deviations), (samples - 1) / samples
        out.append((design, places[design, code], stacked.T @ stacked * (samples - 1) / samples, len(stacked) * share))
    return out


def _fit(
    features: Features,
    indices: tuple[NDArray[np.int64], ...],
    blocks: list[dict[str, FloatArray]],
    patterns: list[Pattern],
    quantity: str,
) -> FloatArray:
    """Logarithms of the components' standard deviations, between bounds (chosen)."""
    names = [np.array([features.features[i].quantity for i in where]) for where in indices]
    pieces = []
    for design, place, products, number in patterns:
        mine = names[design][place] == quantity
        if quantity in blocks[design] and mine.any():
            where = place[mine]
            pieces.append(
                (blocks[design][quantity][:, where[:, None], where[None, :]], products[np.ix_(mine, mine)], number)
            )
    values = np.array([features.features[i].quantity == quantity for i in features.feature])
    scale = max(float(np.abs(features.value[values]).max()), 1e-6)
    start = np.array(
        [0.02, 0.003, 0.01, 0.003, 0.002 * scale, 0.003, 0.001 * scale, 0.001 * scale, 0.003 * scale, 0.001 * scale]
    )
    low = np.array([1e-4, 1e-5, 1e-4, 1e-5, 1e-5 * scale, 1e-5, 1e-5 * scale, 1e-5 * scale, 1e-5 * scale, 1e-4 * scale])
    if not pieces:
        return np.log(start)

    def misfit(log_sd: FloatArray) -> tuple[float, FloatArray]:
        variance = np.exp(2 * log_sd)
        value, gradient = 0.0, np.zeros_like(log_sd)
        for parts, products, number in pieces:
            total = np.tensordot(variance, parts, 1)
            inverse = np.linalg.inv(total)
            value += number * np.linalg.slogdet(total)[1] + float(np.sum(inverse * products))
            middle = number * inverse - inverse @ products @ inverse
            gradient += 2 * variance * np.tensordot(parts, middle, ([1, 2], [0, 1]))
        return value, gradient

    high = np.log(np.array([0.5, 0.1, 0.5, 0.3, *[scale] * 6]))
    high[5] = np.log(0.5)
    bounds = list(zip(np.log(low), high))
    found = minimize(
        misfit, np.log(start), jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": 80, "ftol": 1e-7}
    )
    return np.asarray(found.x)
