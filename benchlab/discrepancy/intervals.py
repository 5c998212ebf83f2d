"""How well the data know the parameters: from the samples' own scatter about the fit."""

from __future__ import annotations

import numpy as np
from scipy import stats

from benchlab.discrepancy.explanation import Estimate
from benchlab.discrepancy.fit import Fit, scale_of
from benchlab.discrepancy.problem import PRIOR_FREEDOM, Problem
from benchlab.units import FloatArray

LEVEL = 0.95


def covariance(problem: Problem, fit: Fit) -> FloatArray:
    """(q, q): of the parameters, in their units: H⁻¹ M H⁻¹, H = JᵀJ of the tangent J (sandwich estimate; White 1982, samples as clusters).

    M: covariance of the scores, mean of that by the fitted scatter, which counts for PRIOR_FREEDOM, and of the scores' own scatter about
    the mean of their design, which counts for its degrees of freedom; and the systematic error's share.
    """
    tangent = fit.tangent
    hessian = tangent.T @ tangent
    scores = problem.per_sample(tangent * fit.residual[:, None])
    design = problem.features.sample_design
    n = np.bincount(design)[design]
    several = n > 1
    deviation = problem.within_design @ scores
    weighted = deviation * np.sqrt(np.where(several, n / np.maximum(n - 1, 1), 0.0))[:, None]
    freedom = problem.scatter.freedom
    own = weighted.T @ weighted * (problem.samples / max(int(several.sum()), 1))
    meat = (PRIOR_FREEDOM * problem.scatter_meat(tangent) + freedom * own) / (PRIOR_FREEDOM + freedom)
    meat = meat + problem.systematic_meat(tangent)
    inverse = np.linalg.pinv(hessian, rcond=1e-10)
    scale = np.array([scale_of(parameter) for active in fit.actives for parameter in active.effect.parameters])
    return np.asarray(inverse @ meat @ inverse * np.outer(scale, scale))


def estimates(problem: Problem, fits: list[Fit]) -> list[dict[str, Estimate]]:
    """For each effect of the first fit, its parameters with intervals at LEVEL (Student's t), cut at the parameters' bounds.

    fits: the same effects, in the same order, in several forms: the intervals cover those of all.
    """
    quantile = float(stats.t.ppf(0.5 + LEVEL / 2, problem.freedom))
    out: list[dict[str, Estimate]] = []
    for number, one in enumerate(fits):
        errors = np.sqrt(np.maximum(np.diag(covariance(problem, one)), 0.0))
        place = 0
        for effect, active in enumerate(one.actives):
            if number == 0:
                out.append({})
            for parameter in active.effect.parameters:
                half = quantile * errors[place]
                value = active.values[parameter.name]
                low, high = max(value - half, parameter.low), min(value + half, parameter.high)
                if number == 0:
                    edge = 1e-6 * (parameter.high - parameter.low)
                    bound = value <= parameter.low + edge or value >= parameter.high - edge
                    out[effect][parameter.name] = Estimate(value, low, high, parameter.unit, parameter.what, bound)
                else:
                    kept = out[effect][parameter.name]
                    out[effect][parameter.name] = Estimate(
                        kept.value, min(kept.low, low), max(kept.high, high), kept.unit, kept.what, kept.at_bound
                    )
                place += 1
    return out
