"""Effects fitted to the samples: least squares in the whitened space, within bounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.discrepancy.effects.effect import Active, Parameter
from benchlab.discrepancy.problem import Problem
from benchlab.units import FloatArray

STEPS = 12
"""Of Gauss–Newton at most."""


@dataclass(frozen=True)
class Fit:
    """Effects with their fitted numbers. model, residual: (C,), whitened; misfit: |residual|², which is −2 log L but for a constant.

    tangent: (C, q), derivatives of the model by the parameters, each in units of scale_of.
    """

    actives: tuple[Active, ...]
    model: FloatArray
    residual: FloatArray
    tangent: FloatArray
    misfit: float

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(active.name for active in self.actives)

    @property
    def key(self) -> tuple[str, ...]:
        """The names, in whatever order they were found."""
        return tuple(sorted(self.names))


def nothing(problem: Problem) -> Fit:
    """The base alone."""
    residual = problem.whitened - problem.base
    return Fit((), problem.base, residual, np.zeros((len(residual), 0)), float(residual @ residual))


def fit(problem: Problem, actives: Sequence[Active], steps: int = STEPS) -> Fit:
    """Levenberg–Marquardt from the values of the actives, within their bounds: a step is cut at a bound, and a parameter that would leave
    at one is held there. Ends after `steps`, or where a step gains less than 0.001 of misfit.
    """
    parameters = [parameter for active in actives for parameter in active.effect.parameters]
    low, high = np.array([p.low for p in parameters]), np.array([p.high for p in parameters])
    scale = np.array([scale_of(p) for p in parameters])
    x = np.clip(np.array([active.values[p.name] for active in actives for p in active.effect.parameters]), low, high)

    def at(x: FloatArray) -> FloatArray:
        return problem.model(placed(actives, x))

    model = at(x)
    residual = problem.whitened - model
    misfit, damping = float(residual @ residual), 1e-3
    tangent = np.zeros((len(residual), len(x)))
    fresh = False
    for _ in range(steps):
        tangent = _tangent(at, x, model, scale, high)
        fresh = True
        hessian, gradient = tangent.T @ tangent, tangent.T @ residual
        better = False
        for _ in range(6):
            held = ((x <= low) & (gradient < 0)) | ((x >= high) & (gradient > 0))
            free = ~held
            if not free.any():
                break
            step = np.zeros_like(x)
            part = hessian[np.ix_(free, free)]
            ridge = damping * np.diag(np.maximum(np.diag(part), 1e-12))
            step[free] = np.linalg.solve(part + ridge, gradient[free]) * scale[free]
            tried = np.clip(x + step, low, high)
            other = at(tried)
            rest = problem.whitened - other
            if (value := float(rest @ rest)) < misfit:
                better = misfit - value > 1e-3
                x, model, residual, misfit, fresh = tried, other, rest, value, False
                damping = max(damping / 5, 1e-6)
                break
            damping *= 6
        if not better:
            break
    if not fresh:
        tangent = _tangent(at, x, model, scale, high)
    return Fit(placed(actives, x), model, residual, tangent, misfit)


def placed(actives: Sequence[Active], x: FloatArray) -> tuple[Active, ...]:
    """The actives with the numbers x, in the order of their parameters."""
    out, first = [], 0
    for active in actives:
        names = [p.name for p in active.effect.parameters]
        values = dict(zip(names, map(float, x[first : first + len(names)])))
        out.append(Active(active.effect, values, active.form))
        first += len(names)
    return tuple(out)


def scale_of(parameter: Parameter) -> float:
    """A natural step of a parameter: the smallest distance of its typical and starting values from its neutral one (or 0)."""
    distances = [abs(s - (parameter.neutral or 0.0)) for s in (*parameter.starts, parameter.typical)]
    return max(min((d for d in distances if d > 0), default=1.0), 1e-12)


def _tangent(
    at: Callable[[FloatArray], FloatArray], x: FloatArray, model: FloatArray, scale: FloatArray, high: FloatArray
) -> FloatArray:
    """(C, q): one-sided differences over a fiftieth of the scale, backwards at the upper bound."""
    columns = []
    for i in range(len(x)):
        step = 0.02 * scale[i]
        if x[i] + step > high[i]:
            step = -step
        moved = x.copy()
        moved[i] += step
        columns.append((at(moved) - model) / step * scale[i])
    return np.array(columns).T if columns else np.zeros((len(model), 0))
