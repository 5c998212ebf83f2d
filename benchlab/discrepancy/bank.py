"""Directions in which data would move: by every effect of the vocabulary, at several strengths, and by misfits of no name."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.discrepancy.effects.effect import Active, Effect
from benchlab.discrepancy.problem import Problem, off
from benchlab.units import FloatArray

DRAWS = 400
"""Of scatter, for the p of the largest t (chosen)."""

MOST_STARTS = 12
"""Combinations of starting values of one effect."""


@dataclass(frozen=True)
class Bank:
    """actives: K candidates, each one effect at one strength in one form. directions: (C, K), whitened: what each does to the base."""

    actives: tuple[Active, ...]
    directions: FloatArray

    def without(self, names: Sequence[str]) -> Bank:
        """Those of other effects than the ones named."""
        keep = [i for i, active in enumerate(self.actives) if active.name not in names]
        return Bank(tuple(self.actives[i] for i in keep), self.directions[:, keep])


def bank_of(problem: Problem, effects: Sequence[Effect]) -> Bank:
    """Every effect alone, in each of its forms, from each of its starting values."""
    actives: list[Active] = []
    directions: list[FloatArray] = []
    for effect in effects:
        first: dict[tuple[float, ...], FloatArray] = {}
        for form, values in itertools.product(effect.forms, starts_of(effect)):
            active = Active(effect, values, form)
            direction = problem.model((active,)) - problem.base
            plain = first.setdefault(tuple(values.values()), direction)
            same = plain is not direction and np.array_equal(plain, direction)  # a form that these data do not tell
            if not same and np.isfinite(direction).all() and float(direction @ direction) > 1e-8:
                actives.append(active)
                directions.append(direction)
    columns = np.array(directions).T if directions else np.zeros((len(problem.whitened), 0))
    return Bank(tuple(actives), columns)


def starts_of(effect: Effect) -> list[dict[str, float]]:
    """Starting values of all parameters together, of their combinations every so many, MOST_STARTS at most."""
    names = [parameter.name for parameter in effect.parameters]
    grids = [parameter.starts or (parameter.typical,) for parameter in effect.parameters]
    combined = [dict(zip(names, map(float, values))) for values in itertools.product(*grids)]
    step = max(1, -(-len(combined) // MOST_STARTS))
    return combined[::step]


@dataclass(frozen=True)
class Scan:
    """t: (K,) along each direction, 0 for those that the tangent spans; p: of the largest being there by scatter alone, all directions
    considered; best: its index, −1 without any. usual: what the largest t of scatter alone stays below in 95 of 100 draws.
    """

    t: FloatArray
    p: float
    largest: float
    best: int
    usual: float = 0.0


def scan(
    problem: Problem,
    directions: FloatArray,
    residual: FloatArray,
    tangent: FloatArray,
    noise: FloatArray,
    multiplier: float = 1.0,
) -> Scan:
    """Is there more in the residual (C,) than scatter, along the directions (C, K) as far as the tangent (C, q) does not span them?

    noise: (draws, C), of Problem.noise. p = (1 + draws whose largest t, times the multiplier, is not smaller)/(draws + 1): one-sided,
    as effects push one way, and simultaneous over all directions.
    """
    free = off(directions, tangent)
    kept = (free**2).sum(axis=0) > 1e-4 * np.maximum((directions**2).sum(axis=0), 1e-12)
    if not kept.any():
        return Scan(np.zeros(directions.shape[1]), 1.0, 0.0, -1)
    t = np.zeros(directions.shape[1])
    t[kept] = problem.t_values(free[:, kept], residual)
    best = int(np.argmax(t))
    largest = problem.largest_t_of_noise(free[:, kept], noise)
    p = (1 + int((largest >= t[best] / multiplier).sum())) / (len(noise) + 1)
    return Scan(t, p, float(t[best]), best, float(np.quantile(largest, 0.95)))


def flexible(problem: Problem) -> FloatArray:
    """(C, K): misfits of no name, whitened, of length 1, with both signs.

    Over each group of features (all; of a design, kind of run, direction, cycle; of a kind in one direction or cycle) a constant, powers
    to the third and a sine of pressure, as a share of the base's largest value of the design; in holds the logarithm of time; in each
    design and direction a constant, pressure and its square.
    """
    features = problem.features.features
    pressure = np.array([feature.pressure_MPa for feature in features])
    x = pressure / max(float(pressure.max()), 1e-12)
    quantity = np.array([feature.quantity for feature in features])
    design = np.array([feature.design for feature in features])
    kind = np.array([f"{feature.kind} {feature.occurrence}" for feature in features])
    direction = np.array([feature.direction for feature in features])
    cycle = np.array([feature.cycle for feature in features])
    late = np.array([np.log1p(max(feature.time_s, 0.0)) for feature in features])
    base = problem.mean_over_samples(problem.base_cells)
    shapes = [np.ones_like(x), x, x**2, x**3, np.sin(2 * np.pi * x)]
    columns = []
    for name in sorted(set(quantity)):
        mine = quantity == name
        size = max(float(np.abs(base[mine]).max()), 1e-9)
        local = np.array(
            [
                max(float(np.abs(base[mine & (design == d)]).max(initial=0.0)), 1e-3 * size)
                for d in range(design.max() + 1)
            ]
        )
        scale = local[design]
        groups = [mine]
        for labels in (design, kind, direction, cycle):
            values = sorted(set(labels[mine]))
            groups += [mine & (labels == value) for value in values if len(values) > 1]
        groups += [
            mine & (kind == k) & (direction == way)
            for k in sorted(set(kind[mine]))
            for way in sorted(set(direction[mine]))
        ]
        groups += [mine & (kind == k) & (cycle == c) for k in sorted(set(kind[mine])) for c in sorted(set(cycle[mine]))]
        for group in groups:
            if group.any():
                columns += [group * scale * shape for shape in shapes]
        holds = mine & (direction == "hold")
        if holds.any():
            columns += [holds * scale * late]
        columns += [
            mine * (design == d) * (direction == way) * scale * shape
            for d in set(design)
            for way in set(direction)
            for shape in shapes[:3]
        ]
    stacked = np.array([column for column in columns if np.any(column)])[:, problem.features.feature].T
    white = problem.whiten(stacked)
    sizes = np.sqrt((white**2).sum(axis=0))
    white = white[:, sizes > 1e-9] / sizes[sizes > 1e-9]
    return np.concatenate([white, -white], axis=1)


def principal(directions: FloatArray, share: float = 0.05) -> FloatArray:
    """(C, K) → (C, q): orthonormal directions that span them, but for those that are weaker than a share of the strongest."""
    sizes = np.sqrt((directions**2).sum(axis=0))
    kept = directions[:, sizes > 1e-3] / sizes[sizes > 1e-3]
    if kept.shape[1] == 0:
        return kept
    basis, strength, _ = np.linalg.svd(kept, full_matrices=False)
    return np.asarray(basis[:, strength > share * strength[0]])
