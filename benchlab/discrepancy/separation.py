"""How far apart rivals are in an experiment, in standard deviations, after each has been refitted to look like the other."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import solve_triangular
from scipy.optimize import lsq_linear

from benchlab.discrepancy.effects.effect import Active
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

Noise = Callable[[Scene], FloatArray]
"""(N, N) covariance of what would be measured (mean over samples), for the N real points of a scene, run by run: `points`."""

WIDE = 0.5
"""Standard deviation of a parameter about which nothing is known, of the width of its bounds."""

STEP = 1e-4
"""Of finite differences, of the width of a parameter's bounds."""

STEPS = 3
"""Of Gauss and Newton, when a rival is refitted."""


@dataclass(frozen=True)
class Rival:
    """Effects with their fitted values. covariance: (P, P) of their parameters by the data so far; None, or not finite: unknown."""

    actives: tuple[Active, ...]
    covariance: FloatArray | None = None

    @property
    def name(self) -> str:
        return " + ".join(active.name for active in self.actives) or "the base alone"

    @property
    def values(self) -> FloatArray:
        """(P,)"""
        return np.array(
            [active.values[p.name] for active in self.actives for p in active.effect.parameters], dtype=float
        )

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """(P,) each: lowest and highest values."""
        pairs = [(p.low, p.high) for active in self.actives for p in active.effect.parameters]
        low, high = np.array(pairs, dtype=float).reshape(-1, 2).T
        return np.minimum(low, self.values), np.maximum(high, self.values)

    def within(self, other: Rival) -> bool:
        """Whether the other one has all of these effects, and more."""
        return {active.name for active in self.actives} < {active.name for active in other.actives}

    def at(self, values: FloatArray) -> Rival:
        """The same effects with other numbers."""
        left, actives = iter(values.tolist()), []
        for active in self.actives:
            actives.append(replace(active, values={p.name: next(left) for p in active.effect.parameters}))
        return replace(self, actives=tuple(actives))

    @property
    def known(self) -> FloatArray:
        """(P, P) rows whose squares sum to how unlikely a change of the parameters is, by the data so far."""
        low, high = self.bounds
        if self.covariance is None or not np.isfinite(self.covariance).all():
            return np.diag(1 / np.maximum(WIDE * (high - low), 1e-12))
        scale = np.where(high > low, high - low, 1.0)
        size, axes = np.linalg.eigh(self.covariance / np.outer(scale, scale))
        return np.asarray((axes / np.sqrt(np.clip(size, 1e-12, WIDE**2))).T / scale)


def points(scene: Scene, values: FloatArray) -> FloatArray:
    """(N,) of (T, R): the real points, run by run."""
    return values.T[scene.real.T]


class Whitener:
    """Takes (N, …) to independent numbers of unit variance. Points of different designs are independent, so it goes design by design."""

    def __init__(self, scene: Scene, covariance: FloatArray) -> None:
        self.owner = points(scene, np.broadcast_to(scene.design, scene.time_s.shape))
        blocks = [np.flatnonzero(self.owner == design) for design in range(len(scene.names))]
        self.blocks = [(block, np.linalg.cholesky(covariance[np.ix_(block, block)])) for block in blocks]

    def __call__(self, values: FloatArray) -> FloatArray:
        out = np.empty_like(values)
        for block, root in self.blocks:
            out[block] = solve_triangular(root, values[block], lower=True, check_finite=False)
        return out


class Trial:
    """Rivals in one scene: what each predicts there, and how it changes with its parameters, whitened by the noise."""

    def __init__(self, scene: Scene, rivals: Sequence[Rival], noise: Noise, quantity: str = "angle_deg") -> None:
        self.scene, self.quantity = scene, quantity
        self.whiten = Whitener(scene, noise(scene))
        self.rivals = list(rivals)
        self.predicted = [self.predict(rival) for rival in rivals]
        self.tangents = [self.tangent(rival, there) for rival, there in zip(rivals, self.predicted)]

    @property
    def told(self) -> bool:
        """Whether every rival says what it expects there."""
        return all(bool(np.isfinite(there).all()) for there in (*self.predicted, *self.tangents))

    def predict(self, rival: Rival) -> FloatArray:
        """(N,), whitened."""
        found = predict(self.scene, rival.actives, (self.quantity,))[self.quantity]
        return self.whiten(points(self.scene, found))

    def tangent(self, rival: Rival, there: FloatArray) -> FloatArray:
        """(N, P) change of the prediction with each parameter, by differences that stay within the bounds."""
        values, (low, high) = rival.values, rival.bounds
        columns = []
        for i, width in enumerate(high - low):
            moved = values.copy()
            moved[i] += STEP * width if values[i] + STEP * width <= high[i] else -STEP * width
            change = moved[i] - values[i]
            columns.append((self.predict(rival.at(moved)) - there) / change if change else np.zeros_like(there))
        return np.array(columns).T.reshape(len(there), len(columns))

    def linear(self) -> FloatArray:
        """(K, K): distance of rival i from what rival j can be made to look like, along its tangent."""
        return self._pairs(self._linear)

    def refitted(self, within: float = np.inf) -> FloatArray:
        """(K, K): the same with j refitted by a few steps of Gauss and Newton: never larger than without refitting.

        Pairs that are farther apart than `within` along the tangent keep that distance.
        """

        def distance(i: int, j: int) -> float:
            along = self._linear(i, j)
            return along if along > within else self._refitted(i, j)

        return self._pairs(distance)

    def _pairs(self, distance: Callable[[int, int], float]) -> FloatArray:
        """The smaller of both ways round; where one has all effects of the other, and more, how the other one looks like it."""
        count = len(self.rivals)
        found = np.zeros((count, count))
        for i in range(count):
            for j in range(i):
                ways = [(a, b) for a, b in ((i, j), (j, i)) if not self.rivals[a].within(self.rivals[b])]
                found[i, j] = found[j, i] = min(distance(a, b) for a, b in ways)
        return found

    def _linear(self, i: int, j: int) -> float:
        target, rival = self.predicted[i] - self.predicted[j], self.rivals[j]
        moved = _step(rival, rival.values, target, self.tangents[j])
        away = np.concatenate(
            [target - self.tangents[j] @ (moved - rival.values), rival.known @ (moved - rival.values)]
        )
        return float(np.linalg.norm(away))

    def _refitted(self, i: int, j: int) -> float:
        truth, rival = self.predicted[i], self.rivals[j]
        values, there, tangent = rival.values, self.predicted[j], self.tangents[j]
        best = float(np.linalg.norm(truth - there))
        for _ in range(STEPS):
            moved = _step(rival, values, truth - there, tangent)
            reached = self._cost(truth, rival, moved)
            if reached > best:  # a whole step went too far
                moved = (values + moved) / 2
                reached = self._cost(truth, rival, moved)
            if reached > best * 0.99:
                return min(best, reached)
            values, best = moved, reached
            there = self.predict(rival.at(values))
            tangent = self.tangent(rival.at(values), there)
        return best

    def _cost(self, truth: FloatArray, rival: Rival, values: FloatArray) -> float:
        away = truth - self.predict(rival.at(values))
        return float(np.hypot(np.linalg.norm(away), np.linalg.norm(rival.known @ (values - rival.values))))


def _step(rival: Rival, values: FloatArray, target: FloatArray, tangent: FloatArray) -> FloatArray:
    """(P,) values that minimise |target − J·(v − values)|² + |K·(v − fitted)|² within the bounds."""
    if not len(values):
        return values
    known = rival.known
    q, r = np.linalg.qr(tangent)
    rows = np.concatenate([r, known])
    sides = np.concatenate([q.T @ target + r @ values, known @ rival.values])
    low, high = rival.bounds
    wide = high > low
    scale = np.where(wide, high - low, 1.0)
    found = lsq_linear(rows * scale, sides, (low / scale, np.where(wide, high, low + 1e-12) / scale), method="bvls")
    return np.clip(found.x * scale, low, high)
