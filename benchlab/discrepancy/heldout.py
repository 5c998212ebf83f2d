"""Before and after on what the fit has not seen: samples, designs and kinds of runs left out in turn."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.explanation import HeldOut
from benchlab.discrepancy.fit import Fit, fit
from benchlab.discrepancy.problem import Problem
from benchlab.units import FloatArray

FOLDS = 5
STEPS = 4
"""Of a refit, which begins at the fit to all."""


def held_out(problem: Problem, best: Fit) -> tuple[HeldOut, ...]:
    """Samples (in FOLDS folds, a part of each design's at a time), designs and kinds of runs: each left out, refitted without, predicted.

    after is NaN where a part cannot be left out, as nothing else is there.
    """
    return tuple(_one(problem, best, *fold) for fold in _folds(problem))


def _folds(problem: Problem) -> Iterator[tuple[str, str, NDArray[np.bool_]]]:
    features = problem.features
    rank = np.zeros(problem.samples, dtype=int)
    for design in np.unique(features.sample_design):
        mine = np.flatnonzero(features.sample_design == design)
        rank[mine] = np.arange(len(mine)) % FOLDS
    for fold in np.unique(rank):
        held = [features.sample_names[i].rsplit(" ", 1) for i in np.flatnonzero(rank == fold)]
        yield "sample", _several(sorted({name for *_, name in held})), rank[features.sample] == fold
    design_of = np.array([feature.design for feature in features.features])[features.feature]
    kind_of = np.array([feature.kind for feature in features.features])[features.feature]
    for number, name in enumerate(problem.scene.names):
        yield "design", name, design_of == number
    for number, kind in enumerate(features.kinds):
        yield "rate", kind.words, kind_of == number


def _several(names: list[str]) -> str:
    """
    >>> _several(["s1"]), _several(["a", "b", "c", "d", "e"])
    ('s1', 'a, b, c and 2 more')
    """
    return ", ".join(names[:3]) + f" and {len(names) - 3} more" * (len(names) > 3)


def _one(problem: Problem, best: Fit, kind: str, what: str, left: NDArray[np.bool_]) -> HeldOut:
    before = _rmse(problem, problem.base_cells, left)
    floor = noise_floor(problem, left)
    if not best.actives or left.all() or not left.any():
        return HeldOut(kind, what, before, before if not best.actives else np.nan, floor)
    rest = replace(problem, features=problem.features.only(~left))
    refitted = fit(rest, best.actives, steps=STEPS)
    return HeldOut(kind, what, before, _rmse(problem, problem.cells(refitted.actives), left), floor)


def _rmse(problem: Problem, cells: FloatArray, where: NDArray[np.bool_]) -> float:
    if not where.any():
        return np.nan
    return float(np.sqrt(np.mean((problem.features.value[where] - cells[where]) ** 2)))


def noise_floor(problem: Problem, where: NDArray[np.bool_] | None = None) -> float:
    """RMS of samples about the mean of their design, each feature's variance with n − 1: what a faultless model reaches on a new sample.

    where: (C,), cells that count; NaN where no feature has two samples.
    """
    features = problem.features
    n = np.bincount(features.feature)[features.feature]
    usable = (n > 1) if where is None else (n > 1) & where
    if not usable.any():
        return np.nan
    off = (features.value - problem.mean_over_samples(features.value)[features.feature])[usable]
    return float(np.sqrt(np.mean(off**2 * n[usable] / (n[usable] - 1))))


def together(parts: Sequence[HeldOut], kind: str, value: Callable[[HeldOut], float]) -> float:
    """RMS over the parts of one kind."""
    found = np.array([value(part) for part in parts if part.kind == kind])
    found = found[np.isfinite(found)]
    return float(np.sqrt(np.mean(found**2))) if len(found) else np.nan
