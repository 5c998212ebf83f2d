"""Variances of cycles and samples by restricted maximum likelihood, for samples with unlike numbers of cycles."""

from __future__ import annotations

import warnings
from collections.abc import Mapping

import numpy as np

from benchlab.errors import InputError
from benchlab.units import FloatArray


def reml_variances(cycles: Mapping[str, Mapping[str, FloatArray]]) -> tuple[float, float]:
    """(within samples, between samples of a design): a linear mixed model, design fixed, sample random (statsmodels' MixedLM).

    Raises InputError where it does not converge.
    """
    from statsmodels.regression.mixed_linear_model import MixedLM
    from statsmodels.tools.sm_exceptions import ConvergenceWarning

    rows = [(i, row) for i, samples in enumerate(cycles.values()) for row in samples.values()]
    values = np.concatenate([row for _, row in rows])
    sample = np.concatenate([np.full(len(row), index) for index, (_, row) in enumerate(rows)])
    design = np.concatenate([np.full(len(row), group) for group, row in rows])
    scale = float(values.std())
    exog = (design[:, None] == np.arange(len(cycles))).astype(float)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)
        warnings.simplefilter("ignore", RuntimeWarning)
        found = MixedLM((values - values.mean()) / scale, exog, groups=sample).fit(
            reml=True, method=["lbfgs", "powell"]
        )
    within, between = float(found.scale), float(np.asarray(found.cov_re).squeeze())
    if not (found.converged and np.isfinite(within) and np.isfinite(between)):
        raise InputError(
            "the mixed model of cycles in samples does not converge", hint="give each sample as many cycles"
        )
    return within * scale**2, max(0.0, between) * scale**2
