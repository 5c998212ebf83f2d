"""What the present scatter lets one see: power for a wanted difference, samples it takes, smallest difference seen.

No power "at the observed effect": that is the p-value in other words.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import optimize, special

from benchlab.stats.studentized_range import StudentizedRange

WANTED = (0.8, 0.9)
MOST_SAMPLES = 1_000_000


@dataclass(frozen=True)
class PowerOfTest:
    """Of one test: `power` to see the wanted difference with n samples a group; samples a group that see it with power 0.8 and 0.9
    (None beyond a million); smallest differences seen with those powers at n. power and samples are None without a wanted difference."""

    power: float | None
    samples: tuple[int | None, ...] | None
    smallest: tuple[float, ...]


@dataclass(frozen=True)
class Power:
    """sd: pooled within groups. n: samples a group, the harmonic mean where they differ. anova: two groups differ by the wanted
    difference, all others lie midway (the least that an F test can see). pair: this one pair in Tukey's test of all pairs."""

    sd: float
    n: float
    groups: int
    alpha: float
    difference: float | None
    anova: PowerOfTest
    pair: PowerOfTest


def find_power(sd: float, n: float, groups: int, alpha: float, difference: float | None = None) -> Power:
    """Power of the F test and of one pair of Tukey's test, for `groups` groups of n samples that scatter with sd > 0."""
    distribution = StudentizedRange(groups)

    def of_pair(delta: float, size: float) -> float:
        return pair_power(delta / sd, size, groups, alpha, distribution)

    def of_anova(delta: float, size: float) -> float:
        return anova_power(delta / sd, size, groups, alpha)

    return Power(sd, n, groups, alpha, difference, _of(of_anova, sd, n, difference), _of(of_pair, sd, n, difference))


def anova_power(difference: float, n: float, groups: int, alpha: float) -> float:
    """Power of the F test where two means differ by `difference` standard deviations and the others lie midway: λ = n·difference²/2.

    >>> round(anova_power(1.5, 5, 3, 0.05), 4)
    0.449
    """
    a, b = groups - 1, groups * (n - 1)
    critical = special.fdtri(a, b, 1 - alpha)
    return float(1 - special.ncfdtr(a, b, min(n * difference**2 / 2, 1e6), critical))


def pair_power(
    difference: float, n: float, groups: int, alpha: float, distribution: StudentizedRange | None = None
) -> float:
    """Power to see one pair, `difference` standard deviations apart, in Tukey's test and with its sign: t, noncentral, beyond q/√2.

    >>> round(pair_power(1.5, 8, 2, 0.05), 4)
    0.7965
    """
    b = groups * (n - 1)
    critical = (distribution or StudentizedRange(groups)).critical(alpha, np.array([float(b)])).item() / math.sqrt(2)
    delta = abs(difference) * math.sqrt(n / 2)
    if delta > critical + 10 * math.sqrt(1 + critical**2 / (2 * b)):
        return 1.0  # scipy's noncentral t gives NaN out there
    return float(1 - special.nctdtr(b, delta, critical))


def _of(power: Callable[[float, float], float], sd: float, n: float, difference: float | None) -> PowerOfTest:
    smallest = tuple(_smallest(power, sd, n, wanted) for wanted in WANTED)
    if difference is None:
        return PowerOfTest(None, None, smallest)
    return PowerOfTest(power(difference, n), tuple(_samples(power, difference, wanted) for wanted in WANTED), smallest)


def _smallest(power: Callable[[float, float], float], sd: float, n: float, wanted: float) -> float:
    top = sd
    while power(top, n) < wanted:
        top *= 2
    return float(optimize.brentq(lambda delta: power(delta, n) - wanted, 0.0, top, xtol=1e-9 * sd))


def _samples(power: Callable[[float, float], float], difference: float, wanted: float) -> int | None:
    top = 2
    while power(difference, top) < wanted:
        if top >= MOST_SAMPLES:
            return None
        top *= 2
    low = top // 2
    while top - low > 1:  # power(low) < wanted <= power(top), but for the smallest size of all
        middle = (low + top) // 2
        low, top = (low, middle) if power(difference, middle) >= wanted else (middle, top)
    return max(top, 2)
