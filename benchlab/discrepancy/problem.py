"""Residuals in the space where samples are independent and all scatter is one: what every fit and every test looks at."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import cholesky, solve_triangular

from benchlab.discrepancy.effects.effect import Active
from benchlab.discrepancy.features import Features
from benchlab.discrepancy.parts import parts_of
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scatter import Scatter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

PRIOR_FREEDOM = 12.0
"""How many degrees of freedom the fitted scatter counts for, beside the samples' own in one direction (chosen)."""


THINNING = 0.0004
"""Systematic error of each feature, as a share of the largest value: runs are evaluated at a few points in each interval (chosen)."""

FORM = (0.1, 0.2, 0.2)
"""Error of an effect's form in each of PARTS, as a share of the gap in that part and the parts after it (chosen): what a form leaves is no
further effect. Who has loops may be wrong in the course, but a static effect leaves no loops.
"""


class _Alike(NamedTuple):
    """cells: (n, F) of n samples; lower: L (F, F); scatter: L⁻¹ of the root of the scatter between samples; features: (F,)."""

    cells: NDArray[np.int64]
    lower: FloatArray
    scatter: FloatArray
    features: NDArray[np.int64]


@dataclass(frozen=True)
class Problem:
    """Features of samples, the scene that predicts them, and the scatter of samples.

    Whitened vectors are (C,): L⁻¹ of each sample's cells, L Lᵀ = V + n u²: scatter between samples, and n times the systematic error,
    so that the mean over n samples has V/n + u².
    """

    scene: Scene
    features: Features
    scatter: Scatter

    @property
    def samples(self) -> int:
        return len(self.features.sample_design)

    @cached_property
    def systematic(self) -> sparse.csr_array:
        """(F, F): root of the covariance of the model's own error, the same for all samples: of thinning the runs, and of the form of what
        is missing.
        """
        base = self.mean_over_samples(self.base_cells)
        sd = np.zeros((len(FORM), len(base)))
        for name, beyond in zip(self.features.quantities, self._gap_beyond_scatter(base)):
            mine = self.features.of_quantity(name)
            thinning = THINNING * float(np.abs(base[mine]).max())
            for part, share in enumerate(FORM):
                sd[part, mine] = np.hypot(thinning, share * np.sqrt(beyond[part:].sum()))
        return sparse.csr_array(sum(sparse.diags_array(one) @ part for one, part in zip(sd, self._parts)))

    @cached_property
    def _parts(self) -> tuple[sparse.csr_array, ...]:
        return parts_of(self.features)

    def in_parts(self, values: FloatArray) -> FloatArray:
        """(F,) → (quantities, PARTS): RMS over the features that samples have."""
        return np.sqrt(self._means_of([part @ values for part in self._parts], squared=True))

    def _means_of(self, parts: Sequence[FloatArray], squared: bool = False) -> FloatArray:
        """(F,) each → (quantities, PARTS): mean over the features that samples have; 0 where they have none of a quantity."""
        known = np.bincount(self.features.feature, minlength=len(self.features.features)) > 0
        rows = [known & self.features.of_quantity(name) for name in self.features.quantities]
        sums = [[np.sum(part[mine] ** 2 if squared else part[mine]) for part in parts] for mine in rows]
        return np.array(sums) / np.maximum([[mine.sum()] for mine in rows], 1)

    def _gap_beyond_scatter(self, base: FloatArray) -> FloatArray:
        """(quantities, PARTS): mean square of the gap between the means and the base, without what scatter brings."""
        number = np.bincount(self.features.feature, minlength=len(base))
        gap = np.where(number > 0, self.mean_over_samples(self.features.value) - base, 0.0)
        scatter = [np.zeros(len(base)) for _ in self._parts]
        for where, covariance in zip(self.scatter.features_of, self.scatter.covariance):
            n = number[where]
            of_means = np.where(np.outer(n, n) > 0, covariance / np.sqrt(np.maximum(np.outer(n, n), 1)), 0.0)
            for part, brought in zip(self._parts, scatter):
                own = part[where][:, where].toarray()
                brought[where] = np.einsum("ij,jk,ik->i", own, of_means, own)
        squares = self._means_of([part @ gap for part in self._parts], squared=True)
        return np.maximum(squares - self._means_of(scatter), 0.0)

    def mean_over_samples(self, cells: FloatArray) -> FloatArray:
        """(C,) → (F,): 0 for a feature that no sample has."""
        number = np.bincount(self.features.feature, minlength=len(self.features.features))
        return np.asarray(np.bincount(self.features.feature, cells, minlength=len(number)) / np.maximum(number, 1))

    @cached_property
    def variance_of_means(self) -> FloatArray:
        """(F,): by scatter, of each feature's mean over its samples; of one sample where none has it."""
        number = np.bincount(self.features.feature, minlength=len(self.features.features))
        variance = np.empty(len(number))
        for where, covariance in zip(self.scatter.features_of, self.scatter.covariance):
            variance[where] = np.diag(covariance) / np.maximum(number[where], 1)
        return variance

    @property
    def errors_of_means(self) -> FloatArray:
        """(quantities,): RMS standard error of the features' means over samples, each in the unit of its quantity."""
        rows = [self.features.of_quantity(name) for name in self.features.quantities]
        return np.array([np.sqrt(np.mean(self.variance_of_means[mine])) for mine in rows])

    @property
    def error_of_means(self) -> float:
        """RMS standard error of the features' means over samples, in the unit of the quantity."""
        return float(np.sqrt(np.mean(self.variance_of_means)))

    @cached_property
    def _factors(self) -> list[_Alike]:
        """Samples with the same features of one design."""
        groups: dict[tuple[int, bytes], list[NDArray[np.int64]]] = {}
        for sample, design in enumerate(self.features.sample_design):
            mine = np.flatnonzero(self.features.sample == sample)
            groups.setdefault((int(design), self.features.feature[mine].tobytes()), []).append(mine)
        number = np.bincount(self.features.feature, minlength=len(self.features.features))
        out, systematic = [], self.systematic
        for (design, _), cells in groups.items():
            own = self.features.feature[cells[0]]
            place = np.searchsorted(self.scatter.features_of[design], own)
            between = self.scatter.covariance[design][np.ix_(place, place)]
            error = systematic[own]
            counts = np.sqrt(np.outer(number[own], number[own]))
            lower = cholesky(between + counts * (error @ error.T).toarray(), lower=True)
            scatter = solve_triangular(lower, cholesky(between, lower=True), lower=True)
            out.append(_Alike(np.array(cells), lower, scatter, own))
        return out

    def whiten(self, cells: FloatArray) -> FloatArray:
        """(C,) or (C, K) → the same, whitened."""
        return self._mapped(
            cells, lambda alike, flat: solve_triangular(alike.lower, flat, lower=True, check_finite=False)
        )

    def _mapped(self, cells: FloatArray, change: Callable[[_Alike, FloatArray], FloatArray]) -> FloatArray:
        """(C, …) → the same, each sample's part (F, …) changed."""
        out = np.empty_like(cells)
        for alike in self._factors:
            flat = np.moveaxis(cells[alike.cells], 0, 1)  # (F, n, …)
            changed = change(alike, flat.reshape(len(flat), -1)).reshape(flat.shape)
            out[alike.cells] = np.moveaxis(changed, 1, 0)
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
    def base_cells(self) -> FloatArray:
        """(C,): what the base alone gives."""
        return self.cells(())

    @cached_property
    def base(self) -> FloatArray:
        """(C,): the same, whitened."""
        return self.whiten(self.base_cells)

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
    def within_design(self) -> FloatArray:
        """(S, S): takes values of samples to their deviations from the mean of their design."""
        design = self.features.sample_design
        same = design[:, None] == design[None, :]
        return np.eye(self.samples) - same / same.sum(axis=1)

    def t_values(self, directions: FloatArray, residual: FloatArray) -> FloatArray:
        """(K,): along each of the whitened directions (C, K), how many standard errors the residual (C,) is from none.

        Samples are the independent units: the error is that of the scores' own scatter between samples of a design, moderated by the
        fitted one (Smyth 2004): robust where the fitted scatter is wrong in this direction. The systematic error is added.
        """
        return self._t(self.per_sample(directions * residual[:, None]), self._errors(directions))

    def largest_t_of_noise(self, directions: FloatArray, noise: FloatArray) -> FloatArray:
        """(draws,): largest t over the directions (C, K) in each draw of `noise` (draws, C), with the error that is fitted."""
        between, common = self._errors(directions)
        variance = between.sum(axis=0) + common
        used = variance > 1e-12
        return np.asarray((noise @ directions[:, used] / np.sqrt(variance[used])).max(axis=-1))

    def noise(self, generator: np.random.Generator, draws: int) -> FloatArray:
        """(draws, C): whitened draws of scatter between samples and of the systematic error, where nothing else is there.

        The scatter is itself only known from Σ(n − 1) deviations, which its fit follows: each draw's is larger or smaller by √(f/χ²_f).
        """
        unknown = np.sqrt(self.freedom / generator.chisquare(self.freedom, draws))[:, None]
        out = np.empty((draws, len(self.features.value)))
        common = generator.standard_normal((draws, len(self.features.features))) @ self.systematic.T
        for alike in self._factors:
            for cells in alike.cells:
                own = unknown * (generator.standard_normal((draws, len(cells))) @ alike.scatter.T)
                out[:, cells] = own + solve_triangular(alike.lower, common[:, alike.features].T, lower=True).T
        return out

    def _errors(self, directions: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(S, K) variance of the scores by scatter between samples, (K,) by the systematic error."""
        between = self.per_sample(self._scattered(directions) ** 2)
        return between, np.asarray((self._common(directions) ** 2).sum(axis=0))

    def scatter_meat(self, directions: FloatArray) -> FloatArray:
        """(K, K): covariance of the scores along whitened directions (C, K) by scatter between samples."""
        scattered = self._scattered(directions)
        return np.asarray(scattered.T @ scattered)

    def systematic_meat(self, directions: FloatArray) -> FloatArray:
        """(K, K): the same by the systematic error."""
        common = self._common(directions)
        return np.asarray(common.T @ common)

    def _scattered(self, directions: FloatArray) -> FloatArray:
        return self._mapped(directions, lambda alike, flat: alike.scatter.T @ flat)

    def _common(self, directions: FloatArray) -> FloatArray:
        """(F, K): what a systematic error of one sd in each feature does to the scores."""
        weights = self._mapped(
            directions,
            lambda alike, flat: solve_triangular(alike.lower, flat, lower=True, trans="T", check_finite=False),
        )
        together = np.zeros((len(self.features.features), directions.shape[1]))
        np.add.at(together, self.features.feature, weights)
        return np.asarray(self.systematic.T @ together)

    def _t(self, scores: FloatArray, errors: tuple[FloatArray, FloatArray]) -> FloatArray:
        """t of the scores (S, K) → (K,): their sum over its standard error, 0 where that is none. errors: of _errors."""
        information, common = errors
        design = self.features.sample_design
        n = np.bincount(design)[design]
        deviation = self.within_design @ scores
        expected = (information * ((n - 1) / n)[:, None]).sum(axis=0)
        freedom = self.scatter.freedom
        ratio = np.divide((deviation**2).sum(axis=0), expected, out=np.ones(expected.shape), where=expected > 0)
        inflation = (PRIOR_FREEDOM + freedom * ratio) / (PRIOR_FREEDOM + freedom)
        variance = inflation * information.sum(axis=0) + common
        return np.asarray(
            np.divide(scores.sum(axis=0), np.sqrt(variance), out=np.zeros_like(variance), where=variance > 1e-12)
        )

    @property
    def freedom(self) -> float:
        """Degrees of freedom of the scatter between samples, 1 at least."""
        return max(self.scatter.freedom, 1)


def off(directions: FloatArray, tangent: FloatArray) -> FloatArray:
    """What of the directions (C, K) the tangent (C, q) does not span."""
    if tangent.shape[1] == 0:
        return directions
    basis, sizes, _ = np.linalg.svd(tangent, full_matrices=False)
    basis = basis[:, sizes > 1e-9 * max(float(sizes.max()), 1e-300)]
    return np.asarray(directions - basis @ (basis.T @ directions))
