"""Variances of cycles and samples by restricted maximum likelihood, for samples with unlike numbers of cycles."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping

import numpy as np

from benchlab.errors import InputError
from benchlab.stats.groups import mean_of, squares_about
from benchlab.units import FloatArray


def reml_variances(cycles: Mapping[str, Mapping[str, FloatArray]]) -> tuple[float, float]:
    """(within samples, between samples of a design): a linear mixed model, design fixed, sample random. Cycles must scatter.

    statsmodels' MixedLM, by Nelder and Mead: its gradient methods stop at a singular matrix or short of the top. Where the
    likelihood falls from the start as the ratio ρ of the variances grows from 0, samples do not differ beyond their cycles; MixedLM cannot
    reach that end, but there it is known: the variance of all cycles about their design, and 0. The slope at ρ = 0 is from Searle, Casella
    and McCulloch 1992, Variance Components, 6.6. Raises InputError where MixedLM does not end.

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
    return (total / df, 0.0) if falls else _mixed(np.concatenate([row for _, row in rows]), n, design, total / df)


def _mixed(values: FloatArray, n: np.ndarray, design: np.ndarray, variance: float) -> tuple[float, float]:
    """Both variances of values (N,) of samples with n (S,) cycles each, of designs (S,); scaled by a variance of their size."""
    from statsmodels.regression.mixed_linear_model import MixedLM

    exog = (np.repeat(design, n)[:, None] == np.arange(design.max() + 1)).astype(float)
    model = MixedLM(values / math.sqrt(variance), exog, groups=np.repeat(np.arange(len(n)), n))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # told by `converged`
        try:
            found = model.fit(reml=True, method="nm", maxiter=2000, xtol=1e-10, ftol=1e-10)
        except np.linalg.LinAlgError:
            found = None
    if found is None or not found.converged:
        what = "the mixed model of cycles in samples does not converge"
        raise InputError(what, hint="give each sample as many cycles")
    return float(found.scale) * variance, float(found.cov_re.squeeze()) * variance
