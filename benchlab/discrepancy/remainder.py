"""What is left beside the model, or what is not explained of the gap, and what it depends on, in words."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchlab.discrepancy.identify import Identified
from benchlab.discrepancy.measured import QUANTITIES
from benchlab.discrepancy.problem import Problem
from benchlab.units import FloatArray

STANDS_OUT = 0.1
"""Share of the remainder's mean square from which a dependence is told."""

AGAINST = "the column "
"""Before the name of a further column."""

LEVELS = ("the lowest", "low", "middle", "high", "the highest")
"""Fifths of the features by a number."""


def remainder_words(problem: Problem, found: Identified, left: FloatArray) -> tuple[str, ...]:
    """What the remainder (F,) depends on, where there is one; empty where nothing but scatter is left.

    Where it is not known how samples scatter (p is NaN), what the whole gap depends on.
    """
    if found.p_left > 0.05 or len(left) < 8:
        return ()
    labels = _labels(problem)
    rms = float(np.sqrt(np.mean(left**2)))
    shares = {name: _between(left, values) for name, values in labels.items()}
    words = [
        f"{100 * share:.0f} % of it goes with {name}: {_extremes(problem, name, labels[name], left)}"
        for name, share in sorted(shares.items(), key=lambda item: -item[1])
        if share > STANDS_OUT
    ]
    everywhere = _everywhere(left, unit_of(problem)) if len(problem.features.quantities) == 1 else []
    known = np.isfinite(found.p_left)
    size = f"{rms:.2g}{unit_of(problem)} RMS"
    more = f"{size} is left, more than scatter (p = {found.p_left:.2g})"
    return (
        more if known else f"{size} is the gap; how much of it is scatter is not known",
        *(everywhere + words or ["it depends on nothing simple"]),
    )


def unit_of(problem: Problem) -> str:
    """Of a number of the remainder; none where several quantities are in it."""
    quantities = problem.features.quantities
    unit = QUANTITIES.get(quantities[0], "") if len(quantities) == 1 else ""
    return unit if unit in ("", "°") else f" {unit}"


def _everywhere(left: FloatArray, unit: str) -> list[str]:
    """What all features have in common."""
    mean = float(np.mean(left))
    share = mean**2 / max(float(np.mean(left**2)), 1e-300)
    return [f"{100 * share:.0f} % of it is the same everywhere: {mean:+.2g}{unit}"] if share > STANDS_OUT else []


def _labels(problem: Problem) -> dict[str, np.ndarray]:
    """Groups of the features (F,) by all that is known of them, also by further columns."""
    features = problem.features.features
    pressure = np.array([feature.pressure_MPa for feature in features])
    own = {
        "the design": np.array([feature.design for feature in features]),
        "the kind of run": np.array([feature.kind for feature in features]),
        "the direction": np.array([feature.direction for feature in features]),
        "the cycle": np.array([feature.cycle for feature in features]),
        "the place of the run on its sample": np.array([feature.occurrence for feature in features]),
        "pressure": _fifths(pressure),
    }
    return own | {f"{AGAINST}{name}": _grouped(values) for name, values in problem.features.against.items()}


def _fifths(values: FloatArray) -> np.ndarray:
    return np.digitize(values, np.quantile(values, [0.2, 0.4, 0.6, 0.8]))


def _grouped(values: np.ndarray) -> np.ndarray:
    """A further column as words: its own, its few numbers, or fifths of its many; empty where it says nothing."""
    if values.dtype.kind == "U":
        return values
    out = np.full(len(values), "", dtype=object)
    known = np.isfinite(values)
    few = len(np.unique(values[known])) <= len(LEVELS)
    out[known] = [f"{v:g}" for v in values[known]] if few else [f"{LEVELS[i]} values" for i in _fifths(values[known])]
    return out.astype(str)


def _between(values: FloatArray, labels: np.ndarray) -> float:
    """Share of the mean square that means of groups take, beyond what chance gives them."""
    total = float(np.sum(values**2))
    groups = np.unique(labels)
    if len(groups) < 2 or total == 0:
        return 0.0
    taken = sum(float(np.sum(labels == g) * np.mean(values[labels == g]) ** 2) for g in groups)
    common = len(values) * float(np.mean(values)) ** 2
    return (taken - common) / total


def _extremes(problem: Problem, name: str, labels: np.ndarray, left: FloatArray) -> str:
    means = {value: float(np.mean(left[labels == value])) for value in np.unique(labels)}
    low, high = min(means, key=lambda v: means[v]), max(means, key=lambda v: means[v])
    first, last = (f"{means[value]:+.2g}{unit_of(problem)}" for value in (low, high))
    return f"{first} on average for {_word(problem, name, low)}, {last} for {_word(problem, name, high)}"


def _word(problem: Problem, name: str, value: Any) -> str:
    if name == "the design":
        return problem.scene.names[value]
    if name == "the kind of run":
        return f"runs {problem.features.kinds[value].words}"
    if name == "pressure":
        return LEVELS[value] + " pressures"
    if name == "the place of the run on its sample":
        return f"run {value + 1}"
    return f"cycle {value}" if name == "the cycle" else str(value) or "features without it"
