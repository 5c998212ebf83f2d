"""What is suspicious about measured runs as a whole, and is told, not mended: another unit in some of them, and copies."""

from __future__ import annotations

import hashlib
import itertools
from collections.abc import Iterator, Sequence

import numpy as np

from benchlab.discrepancy.measured import Run
from benchlab.errors import printable

FACTORS = {
    "pressure_MPa": {1000.0: "kPa for MPa", 6.894757: "psi for kPa"},
    "angle_deg": {180 / np.pi: "rad for deg"},
    "force_N": {1000.0: "mN or kN for N"},
    "volume_mL": {1000.0: "µL or L for mL"},
}
"""Ratios between runs that look like another unit, and which."""

EXACT, ALIKE = 0.005, 0.25
"""How near a ratio comes to its factor to be told, relative: of set pressures, and of values, which scatter. Chosen."""


def unit_jumps(runs: Sequence[Run]) -> Iterator[str]:
    """Runs whose largest value is by such a factor larger or smaller than that of most runs.

    The pressure is compared over all runs; other quantities over those of a design that reach about the pressure that most of them reach.
    """
    yield from _odd(runs, "pressure_MPa", [_largest(run, "pressure_MPa") for run in runs], EXACT)
    designs: dict[str, list[Run]] = {}
    for run in runs:
        designs.setdefault(run.design, []).append(run)
    for quantity, design in itertools.product(list(FACTORS)[1:], sorted(designs)):
        measured = [run for run in designs[design] if quantity in run.values]
        top = np.array([_largest(run, "pressure_MPa") for run in measured])
        alike = (
            [run for run, near in zip(measured, np.abs(top - np.median(top)) <= ALIKE * np.median(top)) if near]
            if len(top)
            else []
        )
        yield from _odd(alike, quantity, [_largest(run, quantity) for run in alike], ALIKE)


def _largest(run: Run, quantity: str) -> float:
    values = run.pressure_MPa if quantity == "pressure_MPa" else run.values[quantity]
    return float(np.nanmax(np.abs(values)))


def _odd(runs: Sequence[Run], quantity: str, largest: Sequence[float], near: float) -> Iterator[str]:
    usual = float(np.median(largest)) if runs else 0.0
    for run, value in zip(runs, largest):
        yield from _told(run, quantity, value, usual, near)


def _told(run: Run, quantity: str, value: float, usual: float, near: float) -> Iterator[str]:
    """What is to be said of a largest value, nothing where its ratio to the usual one is none of a unit."""
    if value > 0 and usual > 0:
        ratio = max(value, usual) / min(value, usual)
        for factor, unit in FACTORS[quantity].items():
            if abs(ratio / factor - 1) < near:
                what = (
                    f"run {run.run} of {run.design} {run.sample} reaches {quantity} {value:.4g}, most runs {usual:.4g}"
                )
                yield f"{printable(what)}: {unit}? nothing was converted"


def copies(runs: Sequence[Run]) -> Iterator[str]:
    """Runs that hold the same numbers under two names. A copy is no repetition."""
    first: dict[str, Run] = {}
    for run in sorted(runs, key=lambda run: (run.design, run.sample, run.run)):
        arrays = [run.time_s, run.pressure_MPa, *(run.values[name] for name in sorted(run.values))]
        content = hashlib.sha256(b"".join(np.ascontiguousarray(each).tobytes() for each in arrays)).hexdigest()
        other = first.setdefault(content, run)
        if other is not run and len(run.time_s) > 1:
            of = f"run {run.run} of {run.design} {run.sample} has the numbers of run {other.run} of {other.design} {other.sample}"
            yield f"{printable(of)}: a copy is no repetition"
