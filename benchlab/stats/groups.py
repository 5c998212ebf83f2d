"""A group as the tests see it: how many samples, their mean, and the squares about it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from functools import cached_property

import numpy as np

from benchlab.errors import InputError
from benchlab.stats.measurements import Measurements
from benchlab.stats.names import shown
from benchlab.units import FloatArray

_NOISE = 8 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class Group:
    """n samples with mean `origin + deviation` and sum of squares `ss` about it.

    deviations: (n,) of the samples from the origin; empty where only mean, SD and n are known.
    """

    name: str
    n: int
    deviation: float
    ss: float
    origin: Decimal = Decimal(0)
    deviations: FloatArray = field(default_factory=lambda: np.empty(0), compare=False)

    @cached_property
    def mean(self) -> float:
        return float(self.origin + Decimal(self.deviation))

    @property
    def variance(self) -> float | None:
        """With n − 1; None for one sample."""
        return self.ss / (self.n - 1) if self.n > 1 else None

    @property
    def sd(self) -> float | None:
        return None if self.variance is None else math.sqrt(self.variance)


def mean_of(values: Iterable[float]) -> float:
    """Mean by a sum that is rounded once."""
    listed = list(values)
    return math.fsum(listed) / len(listed)


def squares_about(values: FloatArray, centre: float) -> float:
    """Sum of (value − centre)²; 0 where only rounding is left of it."""
    about = values - centre
    squares = math.fsum((about * about).tolist())
    noise = _NOISE * float(np.abs(values).max())
    return squares if squares > len(values) * noise * noise else 0.0


def group_of(name: str, deviations: FloatArray, origin: Decimal) -> Group:
    """A group from its samples' deviations, shape (n,)."""
    mean = mean_of(deviations.tolist())
    return Group(name, len(deviations), mean, squares_about(deviations, mean), origin, deviations)


def groups_of(measurements: Measurements) -> tuple[Group, ...]:
    """Groups in order; where samples have cycles, the mean of a sample's cycles is its value."""
    return tuple(
        group_of(name, np.array([mean_of(rows.tolist()) for rows in samples.values()]), measurements.origin)
        for name, samples in measurements.cycles().items()
    )


def groups_of_summaries(
    names: Sequence[str], n: Sequence[int], mean: Sequence[Decimal], sd: Sequence[float]
) -> tuple[Group, ...]:
    """Groups of which only n, mean and SD (with n − 1) are known. Raises InputError for a name twice, n < 1 or a negative SD."""
    origin = sorted(mean)[(len(mean) - 1) // 2] if mean else Decimal(0)
    found: dict[str, Group] = {}
    for name, count, centre, spread in zip(names, n, mean, sd, strict=True):
        if name in found:
            raise InputError(f"group {shown(name)!r} stands twice", hint="give one row a group")
        if count < 1 or not (spread >= 0 and math.isfinite(spread)):
            raise InputError(
                f"group {shown(name)!r} has n {count} and SD {spread:g}", hint="n is at least 1, an SD at least 0"
            )
        found[name] = Group(name, count, float(centre - origin), (count - 1) * spread**2, origin)
    return tuple(found.values())


def check_comparable(groups: Sequence[Group]) -> None:
    """Raises InputError unless two groups have two samples or more."""
    if sum(group.n >= 2 for group in groups) < 2:
        sizes = ", ".join(f"{shown(group.name)} {group.n}" for group in groups[:8])
        what = f"{len(groups)} group{'s' * (len(groups) != 1)} (samples: {sizes}{', …' * (len(groups) > 8)})"
        raise InputError(f"{what}: a comparison needs >= 2 groups with >= 2 samples", hint="measure more samples")
