"""From what was measured and simulated to a problem: what can be compared, and what scatters."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import groupby

import numpy as np

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.describe import TOLD, scatters, unknown_scatter
from benchlab.discrepancy.features import Feature, Features, features_of
from benchlab.discrepancy.kinds import Kind
from benchlab.discrepancy.measured import Measured, Run, Summary
from benchlab.discrepancy.problem import Problem
from benchlab.discrepancy.scatter import NAMES, Scatter, scatter_of
from benchlab.discrepancy.scene import Scene
from benchlab.errors import InputError
from benchlab.units import FloatArray

BEYOND = 1.02
"""Pressures up to this times the simulation's last are compared; its curve goes straight on."""

TOGETHER = 0.9
"""Correlation that is assumed between means of one design at different pressures, where only a table of means is known."""

FEWEST_READINGS = 20


def prepared(measured: Measured | Summary, base: Base) -> tuple[Problem, tuple[str, ...]]:
    """The problem, and what a user must know about it. Where nothing scatters its scatter has no degree of freedom: the gap can only be
    described. Raises InputError where nothing can be compared."""
    return _of_summary(measured, base) if isinstance(measured, Summary) else _of_runs(measured, base)


def _of_runs(measured: Measured, base: Base) -> tuple[Problem, tuple[str, ...]]:
    warnings = list(measured.warnings)
    runs = _comparable(measured, base, warnings)
    runs, units = _units(runs)
    warnings += units
    features, scene = features_of(runs, base)
    if len(features.value) == 0:
        raise InputError("no run has a loading, an unloading or a hold with readings", where=measured.source)
    if "flex_V" in features.quantities:
        warnings.append(
            "flex_V is compared after a straight line through each sample's own readings: its gain and zero are not judged"
        )
    if not scatters(features):
        return Problem(scene, features, unknown_scatter(features)), tuple(warnings)
    scatter = scatter_of(features)
    lone = [scene.names[d] for d, n in Counter(features.sample_design.tolist()).items() if n < 2]
    if lone:
        warnings.append(f"one sample alone of {', '.join(lone)}: its scatter is taken from the other designs")
    return Problem(scene, features, scatter), tuple(warnings)


def _comparable(measured: Measured, base: Base, warnings: list[str]) -> list[Run]:
    """Runs with a simulated design, quantities with a curve, pressures within the curves."""
    absent = [name for name in measured.designs if name not in base.designs]
    if len(absent) == len(measured.designs):
        raise InputError(
            f"none of the measured designs is simulated: measured {_some(measured.designs)}; simulated {_some(tuple(base.designs))}",
            where=measured.source,
            hint="give the designs the same names, or their dimensions with --designs",
        )
    for reason, group in groupby(
        sorted(absent, key=lambda name: _reason(base, name)), lambda name: _reason(base, name)
    ):
        names = tuple(group)
        warnings.append(
            f"{_some(names)} {'is' if len(names) == 1 else 'are'} measured but not simulated{reason}: left out"
        )
    kept, beyond, readings = [], 0, 0
    for run in measured.runs:
        if run.design in absent:
            continue
        curves = base.designs[run.design].curves
        known = {
            q: v
            for q, v in run.values.items()
            if (q if q != "flex_V" else "angle_deg") in curves and np.isfinite(v).any()
        }
        inside = run.pressure_MPa <= BEYOND * base.largest_pressure_MPa(run.design)
        readings, beyond = readings + len(inside), beyond + int((~inside).sum())
        if known and inside.sum() >= 2:
            kept.append(_cut(run, known, inside))
    if not kept:
        what = "no measured value lies where there is a simulated curve"
        raise InputError(
            what,
            where=measured.source,
            hint="simulate up to the pressures that were measured, and the quantity that was",
        )
    if beyond:
        warnings.append(f"{beyond} of {readings} readings lie above the simulated pressures: left out")
    without = sorted(
        {q for run in measured.runs for q, v in run.values.items() if np.isfinite(v).any()}
        - {q for run in kept for q in run.values}
    )
    warnings += [f"{name} is measured but not simulated: not compared" for name in without]
    if sum(len(run.time_s) for run in kept) < FEWEST_READINGS:
        raise InputError(
            f"{sum(len(run.time_s) for run in kept)} readings cannot carry a verdict",
            where=measured.source,
            hint="give the runs themselves",
        )
    return kept


def _cut(run: Run, values: Mapping[str, FloatArray], inside: np.ndarray) -> Run:
    def part(column: FloatArray | None) -> FloatArray | None:
        return None if column is None else column[inside]

    return replace(
        run,
        time_s=np.nan_to_num(run.time_s[inside]),
        pressure_MPa=run.pressure_MPa[inside],
        values={name: column[inside] for name, column in values.items()},
        command_MPa=part(run.command_MPa),
        temperature_C=part(run.temperature_C),
        cycle=part(run.cycle),
        sd={},
        against={n: v if isinstance(v, str) else v[inside] for n, v in run.against.items()},
    )


def _units(runs: list[Run]) -> tuple[list[Run], list[str]]:
    """What scatters independently: samples; or, where each design has one, its runs; or nothing, which is told."""
    samples = {(run.design, run.sample) for run in runs}
    if any(n > 1 for n in Counter(design for design, _ in samples).values()):
        return runs, []
    per_design = Counter(run.design for run in runs)
    if max(per_design.values()) < 3:
        return runs, [TOLD]
    told = (
        "one sample of each design: its runs are taken for samples, so that the verdict is about these actuators, not about "
        "their designs"
    )
    return [replace(run, sample=f"{run.sample} {run.run}", run_index=None) for run in runs], [told]


def _of_summary(table: Summary, base: Base) -> tuple[Problem, tuple[str, ...]]:
    known = np.array([name in base.designs and table.quantity in base.designs[name].curves for name in table.design])
    if not known.any():
        raise InputError(
            f"none of the designs is simulated: {_some(tuple(dict.fromkeys(table.design)))}",
            where=table.source,
            hint="give the designs the same names, or their dimensions with --designs",
        )
    warnings = list(table.warnings)
    warnings += [
        f"{name} is not simulated: left out" for name in dict.fromkeys(n for n, k in zip(table.design, known) if not k)
    ]
    inside = known & np.array(
        [k and p <= BEYOND * base.largest_pressure_MPa(d) for k, d, p in zip(known, table.design, table.pressure_MPa)]
    )
    if not inside.any():
        raise InputError("no measured pressure lies where there is a simulated curve", where=table.source)
    if not (table.n[inside] > 1).any():
        raise InputError(
            "means of one sample each: what scatters is not known",
            where=table.source,
            hint="give n and sd of each mean",
        )
    rows = np.array(sorted(np.flatnonzero(inside), key=lambda i: (table.design[i], table.pressure_MPa[i])))
    names = tuple(sorted({table.design[i] for i in rows}))
    warnings.append("a table of means: no direction, rate or cycle, so that effects in time cannot be judged")
    if len(rows) > len(names):
        warnings.append(f"means of one design are taken to scatter together (correlation {TOGETHER:g})")
    design = np.array([names.index(table.design[i]) for i in rows])
    return _summary_problem(table, base, rows, names, design), tuple(warnings)


def _summary_problem(
    table: Summary, base: Base, rows: np.ndarray, names: tuple[str, ...], design: np.ndarray
) -> Problem:
    pressure, n = table.pressure_MPa[rows], table.n[rows]
    level = np.unique(pressure.round(6), return_inverse=True)[1]
    freedom = np.maximum(n - 1, 0)
    pooled = np.bincount(level, freedom * np.nan_to_num(table.sd[rows]) ** 2) / np.maximum(
        np.bincount(level, freedom), 1e-9
    )
    error = np.sqrt(pooled[level] / n)
    covariance, own = [], []
    for d in range(len(names)):
        mine = np.flatnonzero(design == d)
        correlation = np.full((len(mine), len(mine)), TOGETHER) + (1 - TOGETHER) * np.eye(len(mine))
        covariance.append(np.outer(error[mine], error[mine]) * correlation)
        own.append(mine)
    features = Features(
        features=tuple(
            Feature(int(d), 0, 0, table.quantity, 1, "all", i, np.nan, float(p), 0.0, 0.0)
            for i, (d, p) in enumerate(zip(design, pressure))
        ),
        kinds=(Kind("means"),),
        sample_names=names,
        sample_design=np.arange(len(names)),
        sample=design,
        feature=np.arange(len(rows)),
        value=table.mean[rows],
        count=n,
        of_point={table.quantity: np.arange(len(rows))[None, :]},
    )
    one = np.zeros((1, len(rows)))
    scene = Scene(
        base=base,
        names=names,
        design=design,
        sample=design,
        order=np.full(len(rows), np.nan),
        time_s=one,
        pressure_MPa=pressure[None, :],
        command_MPa=one + np.nan,
        temperature_C=one + np.nan,
        real=one == 0,
        start_s=np.full(len(rows), np.nan),
        orientation_deg=np.full(len(rows), np.nan),
    )
    between = int(np.bincount(level, freedom).max())
    return Problem(
        scene,
        features,
        Scatter(tuple(covariance), tuple(own), {table.quantity: dict.fromkeys(NAMES, np.nan)}, between),
    )


def _reason(base: Base, name: str) -> str:
    return f" ({base.missing[name]})" if name in base.missing else ""


def _some(names: Sequence[str]) -> str:
    return ", ".join(names[:5]) + (f" and {len(names) - 5} more" if len(names) > 5 else "")
