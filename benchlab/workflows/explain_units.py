"""Whether what was measured is in another unit than its column says: against the simulation, before any effect is looked for."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.measured import Measured, Summary
from benchlab.errors import InputError
from benchlab.io.measured_doubts import ALIKE, FACTORS

LEAST_MPa = 0.001
"""No soft actuator is driven below: a smaller largest pressure is in another unit."""


def check_units(measured: Measured | Summary, base: Base, largest_MPa: float) -> None:
    """Raises InputError where all pressures are next to nothing, or values are by the factor of a unit off what is simulated."""
    if 0 < largest_MPa < LEAST_MPa:
        what = f"the largest pressure is {largest_MPa:.2g} MPa, below {LEAST_MPa:g} MPa"
        raise InputError(what, file=measured.source, hint="is the unit in the name of the column right?")
    for quantity in [name for name in FACTORS if name != "pressure_MPa"]:
        ratios = [value / simulated for value, simulated in _largest(measured, base, quantity) if simulated > 0]
        ratio = float(np.median(ratios)) if ratios else 1.0
        for factor, unit in FACTORS[quantity].items():
            if ratio > 0 and abs(max(ratio, 1 / ratio) / factor - 1) < ALIKE:
                what = f"the largest {quantity} is {ratio:.2g} of the simulated one, as {unit} makes it"
                raise InputError(
                    what, file=measured.source, hint="name the column with its unit, here or in the simulation"
                )


def _largest(measured: Measured | Summary, base: Base, quantity: str) -> Iterator[tuple[float, float]]:
    """Largest size of each run (of a table of means, of each mean), and what is simulated at its largest pressure."""
    if isinstance(measured, Summary):
        kept = measured.quantity == quantity
        rows = [*zip(measured.design, measured.pressure_MPa, np.abs(measured.mean))] if kept else []
    else:
        rows = [
            (run.design, np.nanmax(run.pressure_MPa), np.nanmax(np.abs(run.values[quantity])))
            for run in measured.runs
            if quantity in run.values
        ]
    for design, pressure, value in rows:
        if design in base.designs and quantity in base.designs[design].curves:
            one = base.designs[design]
            yield float(value), float(abs(np.interp(pressure, one.pressure_MPa, one.curves[quantity])))
