"""A fit of every effect alone: what rules that choose by a misfit alone are compared with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchlab.discrepancy.bank import bank_of
from benchlab.discrepancy.candidates import fits_with
from benchlab.discrepancy.effects.effect import Effect
from benchlab.discrepancy.fit import Fit, fit, nothing
from benchlab.discrepancy.heldout import FOLDS, STEPS
from benchlab.discrepancy.problem import Problem
from benchlab.units import FloatArray


@dataclass(frozen=True)
class OneFit:
    """effect: "" for the base alone. predicted: (S, F); left_out: (S, F), of each sample by fits to the others, in FOLDS folds."""

    effect: str
    parameters: int
    predicted: FloatArray
    left_out: FloatArray


def every_fit(problem: Problem, effects: Sequence[Effect]) -> list[OneFit]:
    """The base alone, and each effect in its best form."""
    bare = nothing(problem)
    alone = _matrix(problem, problem.base_cells)
    bank = bank_of(problem, effects)
    found = [OneFit("", 0, alone, alone)]
    for name in dict.fromkeys(active.name for active in bank.actives):
        best = fits_with(problem, bare, bank, name)[0]
        predicted, left_out = (_matrix(problem, cells) for cells in (problem.cells(best.actives), _left(problem, best)))
        found.append(OneFit(name, best.tangent.shape[1], predicted, left_out))
    return found


def measured_matrix(problem: Problem) -> FloatArray:
    """(S, F): what was measured, NaN where nothing was."""
    return _matrix(problem, problem.features.value)


def _left(problem: Problem, best: Fit) -> FloatArray:
    """(C,): of each fold of samples, by a fit to the others."""
    design, sample = problem.features.sample_design, problem.features.sample
    rank = np.array([np.sum(design[:s] == design[s]) % FOLDS for s in range(problem.samples)])
    out = np.empty(len(sample))
    for fold in np.unique(rank):
        left = rank[sample] == fold
        if left.all():
            return problem.cells(best.actives)
        rest = replace(problem, features=problem.features.only(~left))
        out[left] = problem.cells(fit(rest, best.actives, steps=STEPS).actives)[left]
    return out


def _matrix(problem: Problem, cells: FloatArray) -> FloatArray:
    out = np.full((problem.samples, len(problem.features.features)), np.nan)
    out[problem.features.sample, problem.features.feature] = cells
    return out
