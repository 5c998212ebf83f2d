"""Where simulation and measurement disagree, in words: regions that say the same are said once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchlab.discrepancy.explanation import Curves, Region
from benchlab.errors import counted
from benchlab.report.document import cut
from benchlab.report.explain.quantity import quantity_of
from benchlab.stats.wording import p_text

P_FLOOR = 1e-4
"""Below it a probability is only said to be below: they come from some thousands of drawn studies."""

NEAR_LIMIT = (0.04, 0.06)
"""Between these a probability is told in three digits, so that it is seen on which side of 5 % it lies."""

ALIKE = 0.5
"""Share of two intervals' union that their overlap must have for them to be told as one."""

DIRECTIONS = {"loading": "loading", "unloading": "unloading", "hold": "in holds", "rest": "at rest", "all": ""}


@dataclass(frozen=True)
class Stretch:
    """Regions told as one. directions, rates_MPa_s, cycles: None where it is all that were measured.

    pressure_MPa: what all its regions have in common. gap: the smallest and the largest of them; p: the largest. loose: not every
    combination has a region, and pressures are what all of them span.
    """

    designs: tuple[str, ...]
    quantity: str
    directions: tuple[str, ...] | None
    rates_MPa_s: tuple[float, ...] | None
    cycles: tuple[int, ...] | None
    pressure_MPa: tuple[float, float]
    gap: tuple[float, float]
    p: float
    loose: bool = False

    @property
    def size(self) -> float:
        return max(map(abs, self.gap))


def merged(regions: Iterable[Region], curves: Curves) -> list[Stretch]:
    """Regions that differ in one thing alone and the same way put together, as often as that goes.

    In the order of the quantities, of each the largest gap first.

    Only whole combinations are merged: what is said of designs, directions, rates and cycles holds for each combination of them.
    """
    found, before = [_single(region) for region in regions], -1
    while len(found) != before:
        before = len(found)
        for axis in ("cycles", "rates_MPa_s", "directions", "designs"):
            found = [_collapsed(stretch, curves) for stretch in _joined(found, axis)]
    order = list(dict.fromkeys(curves.quantity.tolist()))
    return sorted(found, key=lambda one: (order.index(one.quantity), -one.size, one.designs, one.pressure_MPa))


def told_regions(regions: Sequence[Region], curves: Curves, most: int = 6) -> list[str]:
    """Sentences, the largest gap first; where they are more than `most`, one for each quantity, direction and sign.

    Told in the unit of the quantity; the number is the gap averaged over the interval, of merged regions from the smallest to the largest.
    A p that is not known is not told.
    """
    regions = list(regions)
    found, more = merged(regions, curves), []
    if len(found) > most:
        found, more = (
            _summed(regions, curves),
            [f"told together: {counted(len(regions), 'region')}, each in the report's table and in --json"],
        )
    return [*(told(one, curves) for one in found), *more]


def told(one: Stretch, curves: Curves) -> str:
    """A stretch as a sentence without its full stop."""
    quantity = quantity_of(curves, one.quantity)
    low, high = sorted(map(abs, one.gap))
    subject = subject_words(one.designs, sorted(set(curves.design[curves.quantity == one.quantity].tolist())))
    head = quantity.differs(subject, quantity.span(low, high), one.gap[1] <= 0, len(one.designs) > 1)
    pressures = pressure_words(one.pressure_MPa)
    place = f"{head} {pressures.replace('from', 'within', 1) if one.loose else pressures}"
    probability = "" if np.isnan(one.p) else f"; p {_p(one.p, one.gap[0] != one.gap[1])}"
    return f"{', '.join(filter(None, (place, *_circumstances(one, curves))))}{probability}"


def subject_words(designs: Sequence[str], all_designs: Sequence[str]) -> str:
    """Designs by name, or all of them.

    >>> subject_words(["a", "b"], ["a", "b", "c"]), subject_words(["a", "b", "c"], ["a", "b", "c"])
    ('a and b', 'all 3 designs')
    """
    if len(designs) > 2 and set(designs) == set(all_designs):
        return f"all {len(designs)} designs"
    names = [cut(name, 40) for name in designs]
    return and_words(names if len(names) <= 5 else [*names[:4], f"{len(names) - 4} more designs"])


def and_words(parts: Sequence[str]) -> str:
    """
    >>> and_words(["a"]), and_words(["a", "b", "c"])
    ('a', 'a, b and c')
    """
    return " and ".join(filter(None, (", ".join(parts[:-1]), *parts[-1:])))


def pressure_words(span_MPa: tuple[float, float]) -> str:
    """
    >>> pressure_words((0.2, 0.35)), pressure_words((0.35, 0.35))
    ('from 0.20 to 0.35 MPa', 'at 0.35 MPa')
    """
    low, high = (f"{end:.2f}" if abs(end) >= 0.1 or end == 0 else f"{end:.2g}" for end in span_MPa)
    return f"at {low} MPa" if low == high else f"from {low} to {high} MPa"


def rate_key(rate_MPa_s: float | None) -> float | None:
    """A rate as it is told, in two digits; None for none."""
    return None if rate_MPa_s is None or not np.isfinite(rate_MPa_s) else float(f"{rate_MPa_s:.2g}")


def p_told(p: float) -> str:
    """
    >>> p_told(0.0231), p_told(0.04975), p_told(0.0)
    ('0.023', '0.050', '< 0.0001')
    """
    return f"{p:.3f}" if NEAR_LIMIT[0] <= p < NEAR_LIMIT[1] else p_text(p, P_FLOOR)


def _p(p: float, several: bool) -> str:
    text = p_told(p)
    return text if text.startswith("<") else f"{'≤' if several else '='} {text}"


def _circumstances(one: Stretch, curves: Curves) -> Iterable[str]:
    """Directions, rates and cycles; nothing where only one was measured."""
    directions = one.directions or _measured(one, curves, "directions")
    yield and_words([word for name in directions if (word := DIRECTIONS.get(name, cut(name, 20)))])
    rates = _measured(one, curves, "rates_MPa_s")
    if one.rates_MPa_s is not None:
        yield f"at {and_words([f'{rate:g}' for rate in one.rates_MPa_s])} MPa/s"
    elif len(rates) > 1:
        yield "at every rate"
    cycles = one.cycles or _measured(one, curves, "cycles")
    if one.cycles is not None or len(cycles) > 1:
        first, last = min(cycles), max(cycles)
        whole = last - first + 1 == len(cycles) and len(cycles) > 2
        yield f"cycle{'s' * (len(cycles) > 1)} " + (f"{first} to {last}" if whole else and_words([*map(str, cycles)]))


def _summed(regions: Sequence[Region], curves: Curves) -> list[Stretch]:
    """A stretch for each quantity, direction and sign: all designs, rates and cycles that have a region, and all pressures."""
    groups: dict[Any, list[Region]] = {}
    for region in regions:
        groups.setdefault((region.quantity, region.direction, region.gap > 0), []).append(region)
    order = list(dict.fromkeys(curves.quantity.tolist()))
    found = [_collapsed(_around(group), curves) for group in groups.values()]
    return sorted(found, key=lambda one: (order.index(one.quantity), -one.size, one.designs))


def _around(group: Sequence[Region]) -> Stretch:
    """All regions of a quantity, a direction and a sign as one."""
    first = group[0]
    rates = {rate for region in group if (rate := rate_key(region.rate_MPa_s)) is not None}
    cycles = {region.cycle for region in group if region.cycle is not None}
    lows, highs = zip(*(region.pressure_MPa for region in group))
    gaps = [region.gap for region in group]
    return Stretch(
        tuple(sorted({region.design for region in group})),
        first.quantity,
        None if first.direction == "all" else (first.direction,),
        tuple(sorted(rates)) or None,
        tuple(sorted(cycles)) or None,
        (min(lows), max(highs)),
        (min(gaps), max(gaps)),
        max(region.p for region in group),
        loose=len(group) > 1,
    )


def _single(region: Region) -> Stretch:
    rate = rate_key(region.rate_MPa_s)
    return Stretch(
        (region.design,),
        region.quantity,
        None if region.direction == "all" else (region.direction,),
        None if rate is None else (rate,),
        None if region.cycle is None else (region.cycle,),
        region.pressure_MPa,
        (region.gap, region.gap),
        region.p,
    )


def _joined(stretches: Sequence[Stretch], axis: str) -> list[Stretch]:
    """Those that are alike in all but `axis`, in about the same pressures, put together."""
    found: list[Stretch] = []
    for one in sorted(stretches, key=lambda each: (each.pressure_MPa, each.designs)):
        if getattr(one, axis) is None:
            found.append(one)
            continue
        for index, other in enumerate(found):
            values = getattr(other, axis)
            if (
                values is not None
                and not set(values) & set(getattr(one, axis))
                and _kin(one, axis) == _kin(other, axis)
                and _overlap(one.pressure_MPa, other.pressure_MPa) >= ALIKE
            ):
                found[index] = _together(other, one, axis)
                break
        else:
            found.append(one)
    return found


def _kin(one: Stretch, axis: str) -> tuple[object, ...]:
    """What must be the same in stretches that are put together along `axis`."""
    names = ("designs", "quantity", "directions", "rates_MPa_s", "cycles")
    return (one.gap[0] < 0, *(getattr(one, name) for name in names if name != axis))


def _together(one: Stretch, other: Stretch, axis: str) -> Stretch:
    (a, b), (c, d) = one.pressure_MPa, other.pressure_MPa
    both: dict[str, Any] = {axis: tuple(sorted({*getattr(one, axis), *getattr(other, axis)}, key=_order(axis)))}
    gap = (min(one.gap[0], other.gap[0]), max(one.gap[1], other.gap[1]))
    return replace(one, pressure_MPa=(max(a, c), min(b, d)), gap=gap, p=max(one.p, other.p), **both)


def _order(axis: str) -> Callable[[Any], Any]:
    """Directions stand in their own order, all else in that of its values."""
    known = list(DIRECTIONS)
    if axis == "directions":
        return lambda name: (known.index(name) if name in known else len(known), name)
    return lambda value: value


def _overlap(one: tuple[float, float], other: tuple[float, float]) -> float:
    """Common part of two intervals as a share of both together; 1 for the same point."""
    if one == other:
        return 1.0
    union = max(one[1], other[1]) - min(one[0], other[0])
    return max(0.0, min(one[1], other[1]) - max(one[0], other[0])) / union


def _collapsed(one: Stretch, curves: Curves) -> Stretch:
    """With None where it has all that was measured of cycles, rates or directions."""
    changes: dict[str, Any] = {}
    for axis in ("cycles", "rates_MPa_s", "directions"):
        values = getattr(one, axis)
        if values is not None and set(values) >= set(_measured(one, curves, axis)):
            changes[axis] = None
    return replace(one, **changes)


def _measured(one: Stretch, curves: Curves, axis: str) -> tuple[Any, ...]:
    """What was measured of its designs and directions along an axis."""
    kept = np.isin(curves.design, one.designs) & (curves.quantity == one.quantity)
    if axis == "directions":
        return tuple(sorted(set(curves.direction[kept].tolist()), key=_order(axis)))
    if one.directions is not None:
        kept &= np.isin(curves.direction, one.directions)
    if axis == "cycles":
        return tuple(sorted(set(curves.cycle[kept].tolist())))
    rates = {rate_key(rate) for rate in curves.rate_MPa_s[kept].tolist()}
    return tuple(sorted(rate for rate in rates if rate is not None))
