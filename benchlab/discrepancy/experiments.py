"""The family of experiments among which the next one is chosen."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from benchlab.discrepancy.experiment import BenchLimits, Experiment, Hold, Leg, Ramp, Triangle

SLOW_S, MIDDLE_S, FAST_S = 50.0, 5.0, 0.5
"""From 0 to the largest pressure: two decades of rate."""

DEFAULT_SLOW_S = 20.0
"""The same of the slow cycle with which an investigation begins, on every sample."""

SHORT, LONG = 0.5, 2.0
"""Lengths of new samples, of those measured."""


def family(limits: BenchLimits) -> tuple[Experiment, ...]:
    """All that the bench can do, the plain ones first; those that take a sample longer than limits.sample_s are left out."""
    plain = tuple(_plain(limits))
    found = [*plain, *(_again(plain) if limits.remembers else ())]
    if limits.can_turn:
        found += _turned(plain, limits.mounting_deg)
    if limits.other_length:
        found += [
            replace(each, name=f"{each.name}_{word}", what=f"{each.what}, on {word}er samples", length_ratio=ratio)
            for each in plain
            if each.name in ("cycle", "rates")
            for word, ratio in (("short", SHORT), ("long", LONG))
        ]
    return tuple(each for each in found if each.sample_s <= limits.sample_s)


def default_experiment(limits: BenchLimits) -> Experiment:
    """Loading and unloading at two rates, a hold and three cycles: what makes most of the vocabulary judgeable.

    >>> default_experiment(BenchLimits()).what
    'loading and unloading at two rates, a hold, three cycles'
    """
    top, _, middle, fast = _rates(limits)
    slow = round(top / DEFAULT_SLOW_S, 4)
    legs = (
        *(Triangle(0, top, slow), Hold(10), Triangle(0, top, fast), Hold(10)),
        *(Ramp(top, fast), Hold(30), Ramp(0, fast), Hold(10), Triangle(0, top, middle, 3)),
    )
    return Experiment("two_rates_hold_cycles", "loading and unloading at two rates, a hold, three cycles", legs)


def _rates(limits: BenchLimits) -> tuple[float, float, float, float]:
    """The largest pressure, and the slow, middle and fast rate, of which the bench may cut the last."""
    top = limits.pressure_MPa
    slow, middle, fast = (min(round(top / time_s, 4), limits.rate_MPa_s) for time_s in (SLOW_S, MIDDLE_S, FAST_S))
    return top, slow, middle, fast


def _plain(limits: BenchLimits) -> Iterator[Experiment]:
    """One run on each sample, as it is mounted."""
    top, slow, middle, fast = _rates(limits)
    levels = [round(top * share, 4) for share in (0.25, 0.5, 0.75, 1.0)]
    yield Experiment("cycle", "one cycle of loading and unloading", (Triangle(0, top, middle),))
    yield Experiment("fast_cycle", "a fast cycle", (Triangle(0, top, fast), Hold(2)))
    yield Experiment("step", "a step up, a hold, a step down", (Ramp(top, fast), Hold(20), Ramp(0, fast), Hold(20)))
    yield Experiment("cycles", "five cycles", (Triangle(0, top, middle, 5),))
    rates: tuple[Leg, ...] = (
        Triangle(0, top, slow),
        Hold(10),
        Triangle(0, top, middle),
        Hold(10),
        Triangle(0, top, fast),
    )
    yield Experiment("rates", "loading and unloading at three rates", (*rates, Hold(10)))
    yield Experiment(
        "creep", "a hold of three minutes and the recovery", (Ramp(top, fast), Hold(180), Ramp(0, fast), Hold(60))
    )
    stairs = [leg for level in (*levels, *levels[-2::-1], 0.0) for leg in (Ramp(level, fast), Hold(8))]
    yield Experiment("stairs", "holds at four pressures, up and down", tuple(stairs))
    growing = [Triangle(0, level, middle, 2) for level in levels]
    yield Experiment("growing", "cycles with growing peaks, two of each", (*growing, Triangle(0, levels[1], middle)))
    yield Experiment(
        "minor_loops", "small loops at three pressures, slow and fast", tuple(_minor_loops(top, slow, middle, fast))
    )


def _minor_loops(top: float, slow: float, middle: float, fast: float) -> Iterator[Leg]:
    """Small loops of ± a tenth of the largest pressure: their width at two rates tells friction from lag."""
    for centre in (0.3, 0.6, 0.9):
        low, high = (round(top * (centre + side), 4) for side in (-0.1, 0.1))
        yield Ramp(low, middle)
        yield Triangle(low, high, slow)
        yield Triangle(low, high, fast, 2)
    yield Ramp(0, middle)


def _again(plain: Sequence[Experiment]) -> Iterator[Experiment]:
    """Several runs on each sample, with rests."""
    (cycle,) = (each for each in plain if each.name == "cycle")
    for runs, rest_s in ((3, 30.0), (4, 240.0)):
        what = f"{runs} runs of one cycle on each sample, {rest_s:g} s vented between them"
        yield replace(cycle, name=f"again_{rest_s:g}s", what=what, mountings_deg=(math.nan,) * runs, rest_s=rest_s)


def _turned(plain: Sequence[Experiment], now_deg: float) -> Iterator[Experiment]:
    """Each sample as it is mounted now, and turned."""
    for each in plain:
        if each.name in ("cycle", "rates"):
            for by_deg in (90.0, 180.0):
                then_deg = (now_deg + by_deg + 180) % 360 - 180 or 0.0
                then_deg = 180.0 if then_deg == -180 else then_deg
                what = f"{each.what}, then again mounted at {then_deg:g}°"
                yield replace(
                    each,
                    name=f"{each.name}_turned{by_deg:g}",
                    what=what,
                    mountings_deg=(now_deg, then_deg),
                    rest_s=30.0,
                )
