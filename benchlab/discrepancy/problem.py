"""Residuals in the space where samples are independent and all scatter is one: what every fit and every test looks at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular

from benchlab.discrepancy.effects.effect import Active
from benchlab.discrepancy.features import Features
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scatter import Scatter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

PRIOR_FREEDOM = 12.0
"""How many degrees of freedom the fitted scatter counts for, beside the samples' own in one direction."""


@dataclass(frozen=True)
class Problem:
    """Features of samples, the scene that predicts them, and the scatter of samples.

    Whitened vectors are (C,): L⁻¹ of each sample's cells, V = L Lᵀ.
    """

    scene: Scene
    features: Features
    scatter: Scatter
    simulation_error: float = 0.0

    @property
    def samples(self) -> int:
        return len(self.features.sample_design)

    @cached_property
    def _factors(self) -> list[tuple[NDArray[np.int64], FloatArray]]:
        """For samples with the same features of one design: their cells (n, F) and L."""
        groups: dict[tuple[int, bytes], list[NDArray[np.int64]]] = {}
        for sample, design in enumerate(self.features.sample_design):
            cells = np.flatnonzero(self.features.sample == sample)
            key = (int(design), self.features.feature[cells].tobytes())
            groups.setdefault(key, []).append(cells)
        out = []
        for (design, _), cells in groups.items():
            own = self.scatter.features_of[design]
            place = np.searchsorted(own, self.features.feature[cells[0]])
            covariance = self.scatter.covariance[design][np.ix_(place, place)]
            out.append((np.array(cells), cholesky(covariance, lower=True)))
        return out

    def whiten(self, cells: FloatArray) -> FloatArray:
        """(C,) or (C, K) → the same, whitened."""
        out = np.empty_like(cells)
        for where, lower in self._factors:
            flat = cells[where]  # (n, F) or (n, F, K)
            columns = np.moveaxis(flat, 0, 1).reshape(flat.shape[1], -1)
            solved = solve_triangular(lower, columns, lower=True, check_finite=False)
            out[where] = np.moveaxis(solved.reshape(flat.shape[1], flat.shape[0], *flat.shape[2:]), 1, 0)
        return out

    @cached_property
    def whitened(self) -> FloatArray:
        """(C,): what was measured, whitened."""
        return self.whiten(self.features.value)

    def cells(self, actives: Sequence[Active]) -> FloatArray:
        """(C,): what the model gives, in the quantities' units. A flex sensor's volts are a straight line of the angle it feels, fitted."""
        values = predict(self.scene, actives, self.features.quantities)
        found = self.features.collect(values)
        return self._in_volts(found) if "flex_V" in self.features.quantities else found

    def model(self, actives: Sequence[Active]) -> FloatArray:
        """(C,): what the model gives, whitened."""
        return self.whiten(self.cells(actives))

    @cached_property
    def base(self) -> FloatArray:
        return self.model(())

    @cached_property
    def quantity(self) -> NDArray[np.str_]:
        """(C,): quantity of each cell."""
        return np.array([feature.quantity for feature in self.features.features])[self.features.feature]

    def _in_volts(self, cells: FloatArray) -> FloatArray:
        out = cells.copy()
        flex = self.quantity == "flex_V"
        for sample in np.unique(self.features.sample[flex]):
            mine = flex & (self.features.sample == sample)
            if np.ptp(cells[mine]) > 0:
                out[mine] = np.polynomial.Polynomial.fit(cells[mine], self.features.value[mine], 1)(cells[mine])
        return out

    def per_sample(self, products: FloatArray) -> FloatArray:
        """(C, …) → (S, …): sums over the cells of each sample."""
        return np.asarray(np.add.reduceat(products, self._starts, axis=0))

    @cached_property
    def _starts(self) -> NDArray[np.int64]:
        return np.searchsorted(self.features.sample, np.arange(self.samples))

    @cached_property
    def _within(self) -> FloatArray:
        """(S, S): takes values of samples to their deviations from the mean of their design."""
        design = self.features.sample_design
        same = design[:, None] == design[None, :]
        return np.eye(self.samples) - same / same.sum(axis=1)

    def t_values(self, directions: FloatArray, residual: FloatArray) -> FloatArray:
        """(K,): along each of the whitened directions (C, K), how many standard errors the residual (C,) is from none.

        Samples are the independent units: the error is that of the scores' own scatter between samples of a design, moderated by the
        fitted one (Smyth 2004): robust where the fitted scatter is wrong in this direction.
        """
        scores = self.per_sample(directions * residual[:, None])
        information = self.per_sample(directions**2)
        return self._t(scores, information)

    def _t(self, scores: FloatArray, information: FloatArray) -> FloatArray:
        """scores: (…, S, K), information: (S, K) → (…, K)."""
        design = self.features.sample_design
        n = np.bincount(design)[design]
        deviation = self._within @ scores
        expected = (information * ((n - 1) / n)[:, None]).sum(axis=0)
        freedom = self.scatter.freedom
        total = information.sum(axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = (deviation**2).sum(axis=-2) / expected if freedom else 1.0
            inflation = (PRIOR_FREEDOM + freedom * np.where(expected > 0, ratio, 1.0)) / (PRIOR_FREEDOM + freedom)
            return np.asarray(np.where(total > 1e-12, scores.sum(axis=-2) / np.sqrt(inflation * total), 0.0))

    @property
    def freedom(self) -> float:
        return PRIOR_FREEDOM + self.scatter.freedom

    def largest_t_of_noise(
        self, directions: FloatArray, generator: np.random.Generator, draws: int = 400
    ) -> FloatArray:
        """(draws,): largest |t| over the directions where nothing but the scatter is there (parametric bootstrap)."""
        information = self.per_sample(directions**2)
        scores = np.empty((draws, self.samples, directions.shape[1]))
        ends = [*self._starts[1:], len(directions)]
        for sample, (first, last) in enumerate(zip(self._starts, ends)):
            scores[:, sample] = generator.standard_normal((draws, last - first)) @ directions[first:last]
        return np.asarray(self._t(scores, information).max(axis=-1))


def off(directions: FloatArray, tangent: FloatArray) -> FloatArray:
    """What of the directions (C, K) the tangent (C, q) does not span."""
    if tangent.shape[1] == 0:
        return directions
    basis, sizes, _ = np.linalg.svd(tangent, full_matrices=False)
    basis = basis[:, sizes > 1e-9 * max(float(sizes.max()), 1e-300)]
    return np.asarray(directions - basis @ (basis.T @ directions))
