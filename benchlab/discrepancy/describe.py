"""Data in which nothing scatters: one sample of each design, run once or twice. The gap is described, without a p, a name or an interval.

A gap is significant against the scatter between samples, and a name is one that this scatter does not bring about by itself. Where no
design has two samples, and no sample three runs, there is no such scatter to compare with, and none is assumed.
"""

from __future__ import annotations

import numpy as np

from benchlab.discrepancy.features import Features
from benchlab.discrepancy.fit import Fit
from benchlab.discrepancy.identify import Identified
from benchlab.discrepancy.problem import Problem
from benchlab.discrepancy.scatter import NAMES, Scatter

NOT_JUDGED = "how samples scatter is not known, so that no effect can be told from it"

TOLD = (
    "one sample of each design, and fewer than three runs of it: how samples scatter is not known, so that the gap is described, and "
    "neither a name nor a probability can be given. Measure two samples of a design at least, or three runs of one, loading and "
    "unloading at two rates"
)


def scatters(features: Features) -> bool:
    """Whether some design has two samples."""
    return bool((np.bincount(features.sample_design) > 1).any())


def unknown_scatter(features: Features) -> Scatter:
    """Of which nothing is known: covariances of NaN, no degree of freedom."""
    of_design = np.array([feature.design for feature in features.features])
    indices = tuple(np.flatnonzero(of_design == design) for design in range(len(np.unique(features.sample_design))))
    covariance = tuple(np.full((len(where), len(where)), np.nan) for where in indices)
    return Scatter(covariance, indices, {q: dict.fromkeys(NAMES, np.nan) for q in features.quantities}, 0)


def described(problem: Problem) -> Identified:
    """No model but the base, and nothing known of what it leaves."""
    unknown = np.full(len(problem.features.value), np.nan)
    bare = Fit((), unknown, unknown, np.zeros((len(unknown), 0)), np.nan)
    return Identified("unexplained", bare, (), (), (), np.nan, np.nan, 0.0)
