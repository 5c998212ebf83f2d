"""The supply of the Nano, which is the reference of its DAC, as the firmware's measurement of its own 1.1 V tells it."""

from __future__ import annotations

import typing

from benchlab.bench import Bench, supply_between_V
from benchlab.devices.messages import Hello

LOW_SHARE = 0.03
"""A supply that is further below the calibrated one is told: each pressure is by so much less than asked for."""


def supply_told(reference_counts: float | None, bench: Bench) -> dict[str, typing.Any]:
    """What is kept with a run. supply_V: by the counts at the calibration, None where one of both was not measured.
    supply_between_V: what it can be on any chip."""
    between = None if reference_counts is None else list(supply_between_V(reference_counts))
    return {
        "reference_counts": reference_counts,
        "supply_V": None if reference_counts is None else bench.supply_now_V(reference_counts),
        "supply_between_V": between,
    }


def supply_notes(hello: Hello, bench: Bench) -> list[str]:
    """What whoever runs on a calibrated bench must be told of its supply. One that is too high is no note: it is refused."""
    if not bench.calibrated:
        return []
    if hello.reference_counts is None:
        why = "does not measure" if hello.reference is None else "could not measure"
        remedy = "flash the one that `benchlab bench firmware` writes, and calibrate again"
        return [f"firmware {hello.version} {why} its supply, and one that has risen gives more pressure; {remedy}"]
    supply_V = bench.supply_now_V(hello.reference_counts)
    if supply_V is None:
        why = "the calibration has no reference_counts, and without a monitor a supply that has risen is not seen"
        return [] if bench.monitor is not None else [f"{why}; calibrate again with `benchlab bench calibrate`"]
    share = 1 - supply_V / bench.supply_V
    if share <= LOW_SHARE:
        return []
    told = f"the supply is {supply_V:.2f} V, calibrated at {bench.supply_V:.2f} V"
    less = f"each pressure is {100 * share:.0f} % below what is asked for"
    return [f"{told}: {less}; use the same USB port and the same Nano, or calibrate again"]
