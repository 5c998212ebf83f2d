"""Do groups differ? The classical tests, those for unequal variances beside them, and all that tells how far to trust them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from benchlab.errors import UsageError
from benchlab.stats.anova import OneWay, Welch, one_way, welch
from benchlab.stats.assumptions import Assumptions, look_at_assumptions
from benchlab.stats.comparison_json import comparison_document
from benchlab.stats.components import Components, Cycles, find_components
from benchlab.stats.groups import Group, check_comparable, groups_of, groups_of_summaries
from benchlab.stats.measurements import Measurements
from benchlab.stats.names import listed, lookalikes, shown
from benchlab.stats.pairs import MOST_GROUPS, Pair, games_howell, tukey
from benchlab.stats.power import Power, find_power
from benchlab.stats.repeatability import Repeatability, find_repeatability
from benchlab.stats.wording import disagreements


@dataclass(frozen=True)
class Comparison:
    """Everything found of some groups. Pairs stand in the order of the groups; a difference is b − a.

    cycles: rows a group, where samples have several; None otherwise. power is None where nothing scatters.
    """

    confidence: float
    groups: tuple[Group, ...]
    cycles: tuple[int, ...] | None
    anova: OneWay
    welch: Welch
    tukey: tuple[Pair, ...]
    games_howell: tuple[Pair, ...]
    assumptions: Assumptions
    components: Components
    repeatability: Repeatability
    power: Power | None
    warnings: tuple[str, ...]

    @property
    def alpha(self) -> float:
        return round(1 - self.confidence, 12)

    def as_json(self) -> dict[str, Any]:
        """What `benchlab stats --json` prints: plain numbers, None for what is not defined, and then a reason beside it."""
        return comparison_document(self)


def compare(measurements: Measurements, confidence: float = 0.95, difference: float | None = None) -> Comparison:
    """Compare groups of samples. A sample with several rows (cycles) counts once, with their mean.

    difference: the smallest that matters, for power and sample size.
    Raises InputError unless two groups have two samples, UsageError for a confidence or difference out of range.
    """
    groups = groups_of(measurements)
    cycles = measurements.cycles() if measurements.nested else None
    warnings = (*measurements.warnings, *_about_samples(measurements))
    return _compared(groups, cycles, confidence, difference, warnings)


def compare_summaries(
    names: Sequence[str],
    n: Sequence[int],
    mean: Sequence[Decimal | float],
    sd: Sequence[float],
    confidence: float = 0.95,
    difference: float | None = None,
) -> Comparison:
    """Compare groups of which only size, mean and standard deviation (with n − 1) are known: one entry a group.

    Raises InputError for a group twice, n < 1 or a negative SD, and as `compare` does.

    >>> found = compare_summaries(["a", "b"], [5, 5], [1.0, 2.0], [0.5, 0.5])
    >>> round(found.anova.F, 6), found.tukey[0].difference
    (10.0, 1.0)
    """
    exact = [value if isinstance(value, Decimal) else Decimal(repr(float(value))) for value in mean]
    groups = groups_of_summaries(names, n, exact, sd)
    return _compared(groups, None, confidence, difference, ())


def _compared(
    groups: tuple[Group, ...],
    cycles: Cycles | None,
    confidence: float,
    difference: float | None,
    warnings: tuple[str, ...],
) -> Comparison:
    check_options(confidence, difference)
    check_comparable(groups)
    told = [*warnings, *_about_groups(groups)]
    anova, of_welch = one_way(groups, confidence), welch(groups)
    few = len(groups) <= MOST_GROUPS
    if not few:
        pairs = len(groups) * (len(groups) - 1) // 2
        told.append(f"{pairs} pairs of {len(groups)} groups are not compared: choose up to {MOST_GROUPS} groups")
    of_tukey = tukey(groups, confidence) if few else ()
    of_games_howell = games_howell(groups, confidence) if few else ()
    told += [reason for reason in (anova.reason, of_welch.reason and f"Welch's ANOVA is {of_welch.reason}") if reason]
    components = find_components(groups, cycles, confidence)
    told += [
        *components.warnings,
        *_about_cycles(cycles),
        *disagreements(anova, of_welch, of_tukey, of_games_howell, confidence),
    ]
    size = len(groups) / sum(1 / group.n for group in groups)
    sd = anova.ms_within**0.5
    return Comparison(
        confidence=confidence,
        groups=groups,
        cycles=None if cycles is None else tuple(sum(map(len, cycles[group.name].values())) for group in groups),
        anova=anova,
        welch=of_welch,
        tukey=of_tukey,
        games_howell=of_games_howell,
        assumptions=look_at_assumptions(groups),
        components=components,
        repeatability=find_repeatability(groups, cycles, components),
        power=find_power(sd, size, len(groups), round(1 - confidence, 12), difference) if sd > 0 else None,
        warnings=tuple(told),
    )


def check_options(confidence: float, difference: float | None) -> None:
    """Raises UsageError for a confidence or a wanted difference out of range."""
    if not 0.5 <= confidence <= 0.9999:
        raise UsageError(f"confidence {confidence:g} is not between 0.5 and 0.9999", hint="usual is 0.95")
    if difference is not None and not 0 < difference < float("inf"):
        raise UsageError(f"a wanted difference of {difference:g} is not above 0")


def _about_groups(groups: Sequence[Group]) -> list[str]:
    names = [group.name for group in groups]
    told = _lookalikes("groups", names)
    if lone := [group.name for group in groups if group.n == 1]:
        told.append(f"one sample in {listed(lone)}: left out of Welch's ANOVA and Games–Howell, which need two")
    if flat := [group.name for group in groups if group.n > 1 and group.ss == 0]:
        told.append(f"no scatter in {listed(flat)}: are these measured values?")
    sizes = [group.n for group in groups]
    if max(sizes) > 2 * min(sizes):
        told.append(
            f"very unbalanced ({min(sizes)} to {max(sizes)} samples a group): Tukey–Kramer and one-way sums of squares (type II and "
            "III are the same with one factor); trust Welch and Games–Howell where variances differ"
        )
    return told


def _about_samples(measurements: Measurements) -> list[str]:
    of_groups = (_lookalikes(f"samples of {shown(name)}", list(row)) for name, row in measurements.cycles().items())
    return [warning for warnings in of_groups for warning in warnings]


def _lookalikes(what: str, names: Sequence[str]) -> list[str]:
    pairs = lookalikes(names)
    if not pairs:
        return []
    first = "; ".join(f"{shown(a)!r} and {shown(b)!r}" for a, b in pairs[:3])
    return [f"{what} look alike and are taken as two: {first}" + f"; and {len(pairs) - 3} more" * (len(pairs) > 3)]


def _about_cycles(cycles: Cycles | None) -> list[str]:
    if cycles is None:
        return []
    sizes = [len(row) for samples in cycles.values() for row in samples.values()]
    if len(set(sizes)) == 1:
        return []
    return [f"{min(sizes)} to {max(sizes)} cycles a sample: each sample counts once, with the mean of its cycles"]
