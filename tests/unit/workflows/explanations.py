"""Explanations for tests of the loop: a verdict, and what is proposed."""

from __future__ import annotations

import math

import numpy as np

from benchlab.discrepancy.experiment import Experiment
from benchlab.discrepancy.explanation import Curves, Explanation, Gap, NextExperiment


def explanation(verdict: str, following: Experiment | None = None, cannot: str = "") -> Explanation:
    nothing, words = np.empty(0), np.empty(0, dtype=str)
    told = None
    if following is not None or cannot:
        told = NextExperiment("", "a from b", 4.0 if following else math.nan, cannot=cannot, experiment=following)
    return Explanation(
        verdict=verdict,
        where=(),
        effects=(),
        rivals=(("friction",), ("viscoelasticity",)) if verdict == "ambiguous" else (),
        gap=Gap(1, 1, 1, 1, 1, 1),
        p_gap=1.0,
        false_naming=0.05,
        tried=(),
        judged_not={},
        remainder=(),
        held_out=(),
        curves=Curves(words, words, words, words, np.empty(0, np.int64), *(nothing,) * 9),
        warnings=(),
        base="cell",
        source="",
        simulated=True,
        samples=0,
        next_experiment=told,
    )
