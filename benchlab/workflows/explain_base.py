"""The simulation that `benchlab explain` compares with: the shell cell, the beam, or curves of another engine, with structural knobs."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import KNOBS, Base, DesignBase, Knob, between
from benchlab.errors import BatchError, InputError, UsageError
from benchlab.simulation.actuator_response import Fixture
from benchlab.simulation.layup import Layup
from benchlab.simulation.response import check_pressures
from benchlab.units import FloatArray
from benchlab.workflows.batch import run_batch
from benchlab.workflows.explain_cache import key_of, read_cached, write_cached
from benchlab.workflows.explain_curves import QUANTITY, Solved, Wanted, respond, solve_design
from benchlab.workflows.explain_structure import BEAM_KNOBS, CELL_KNOBS, design_with

__all__ = ["base_pressures", "beam_base", "cell_base", "check_surrogate", "design_with", "foreign_base"]

PRESSURES = 17
"""Simulated pressures of a design, 0 among them."""
ROUND_MPa = 0.05
"""Step of the largest one."""

Progress = Callable[[int, int], None]


def base_pressures(largest_MPa: float) -> FloatArray:
    """(PRESSURES,) from 0 to the largest pressure, rounded up to ROUND_MPa so that like studies share their cache; denser near 0.

    >>> base_pressures(0.3297)[[0, 1, -1]].round(4)
    array([0.    , 0.0055, 0.35  ])
    """
    last = round(ROUND_MPa * np.ceil(round(largest_MPa / ROUND_MPa, 6)), 6)
    return np.asarray(last * np.linspace(0, 1, PRESSURES) ** 1.5)


def cell_base(
    designs: Mapping[str, ShellDesign],
    layup: Layup,
    pressures_MPa: Sequence[float] | FloatArray,
    *,
    forces: bool,
    knobs: Sequence[str] = CELL_KNOBS,
    fixture: Fixture | None = None,
    jobs: int = 1,
    progress: Progress | None = None,
    cache: Path | None = None,
) -> Base:
    """The shell cell of each design (by name) at `pressures_MPa`, growing from 0 (see base_pressures).

    forces: also the blocked force, with `fixture`. progress: called with designs done and wanted. cache: folder of earlier curves.
    A design that cannot be simulated is in `missing`; what ends early is in `warnings`.
    Raises UsageError for impossible pressures, InputError where no design can be simulated.
    """
    wanted = Wanted("cell", layup, _checked(pressures_MPa), fixture or Fixture(), forces, tuple(knobs))
    source = f"shell cell with material {layup.name} ({layup.origin}); simulated, not measured"
    return _base(designs, wanted, source, jobs, progress, cache)


def beam_base(
    designs: Mapping[str, ShellDesign],
    layup: Layup,
    pressures_MPa: Sequence[float] | FloatArray,
    *,
    forces: bool,
    knobs: Sequence[str] = BEAM_KNOBS,
    fixture: Fixture | None = None,
    jobs: int = 1,
    progress: Progress | None = None,
    cache: Path | None = None,
) -> Base:
    """The one-dimensional beam of each design, whose windows do not balloon; otherwise as `cell_base`."""
    wanted = Wanted("beam", layup, _checked(pressures_MPa), fixture or Fixture(), forces, tuple(knobs))
    source = (
        f"beam model with material {layup.name} ({layup.origin}), windows without ballooning; simulated, not measured"
    )
    return _base(designs, wanted, source, jobs, progress, cache)


def foreign_base(
    curves: Mapping[str, DesignBase],
    designs: Mapping[str, ShellDesign],
    cell: Base | None,
    source: str = "another engine",
) -> Base:
    """Simulated curves of another engine, with the volume they lack and the knobs of the shell cell's own designs of the same name.

    A design that is not in `designs`, or not in the cell, keeps its curves alone: no knob, no length. A table of one pressure is drawn out
    to a curve of the cell's course through its value, so that what a change of pressure does is known as well as
    the cell knows it; without a cell to a straight line from 0.
    """
    found = {name: _with_cell(table, designs.get(name), _cell_of(name, cell)) for name, table in curves.items()}
    lent = [name for name in found if found[name].knobs]
    words = f"{source}; structural effects act through the sensitivities of the shell cell" if lent else source
    missing = {name: "no simulated curve" for name in designs if name not in curves}
    notes = cell.warnings if cell else ()
    notes += tuple(
        f"{name}: no shell cell, so no structural effect ({why})"
        for name, why in (cell.missing.items() if cell else ())
        if name in found
    )
    return Base(found, "foreign", words, missing=missing, warnings=notes)


def check_surrogate(
    base: Base,
    designs: Mapping[str, ShellDesign],
    layup: Layup,
    knobs: Mapping[str, float],
    pressures_MPa: Sequence[float] | FloatArray,
) -> tuple[float, float]:
    """Largest and RMS error, in degrees, of curves times the factors of all knobs together, against designs simulated anew with them.

    pressures_MPa: grow from 0; those beyond a design's curve are left out. Raises UsageError where there is nothing to compare.
    """
    wanted = Wanted(base.kind, layup, _checked(pressures_MPa), Fixture(), False, ())
    off = []
    for name in sorted(set(designs) & set(base.designs)):
        table = base.designs[name]
        inside = [p for p in wanted.pressures_MPa if p <= table.pressure_MPa[-1]]
        anew = respond(designs[name], wanted, knobs, tuple(inside))
        off.append(surrogate(table, "angle_deg", anew.pressure_MPa, knobs) - QUANTITY["angle_deg"](anew))
    if not sum(map(len, off)):
        raise UsageError("no design is simulated that the surrogate could be checked with", hint="give --designs")
    error = np.concatenate(off)
    return float(np.abs(error).max()), float(np.sqrt(np.mean(error**2)))


def surrogate(table: DesignBase, quantity: str, pressures_MPa: FloatArray, knobs: Mapping[str, float]) -> FloatArray:
    """(P,): the curve of a quantity at pressures, times the factor of each knob at its value, as `discrepancy.scene` looks them up."""
    from scipy.interpolate import PchipInterpolator

    value = PchipInterpolator(table.pressure_MPa, table.curves[quantity])(pressures_MPa)
    for name, setting in knobs.items():
        if setting != KNOBS[name][0]:
            knob = table.knobs[name]
            over_p = PchipInterpolator(table.pressure_MPa, np.log(knob.factor[quantity]), axis=1)(pressures_MPa)
            value = value * np.exp(between(name, knob.values, over_p, setting))
    return np.asarray(value)


def _checked(pressures_MPa: Sequence[float] | FloatArray) -> tuple[float, ...]:
    pressures = tuple(float(p) for p in pressures_MPa)
    check_pressures(pressures)
    if pressures[0] != 0:
        raise UsageError(f"simulated curves begin at {pressures[0]:g} MPa", hint="begin at 0 MPa")
    return pressures


def _base(
    designs: Mapping[str, ShellDesign],
    wanted: Wanted,
    source: str,
    jobs: int,
    progress: Progress | None,
    cache: Path | None,
) -> Base:
    found: dict[str, Solved] = {}
    notes: list[str] = []
    for name, design in designs.items():
        kept, note = read_cached(cache, name, design, wanted) if cache else (None, "")
        notes += [note] if note else []
        if kept is not None:
            found[name] = kept
    missing = _simulate(designs, wanted, found, notes, jobs, progress, cache)
    if not found:
        raise InputError(
            next(iter(missing.values()), "there is no design to simulate"), hint="check designs and material"
        )
    notes += [note for name in designs if name in found for note in found[name].notes]
    ordered = {name: found[name].design for name in designs if name in found}
    return Base(ordered, wanted.kind, source, missing=missing, warnings=tuple(notes))


def _simulate(
    designs: Mapping[str, ShellDesign],
    wanted: Wanted,
    found: dict[str, Solved],
    notes: list[str],
    jobs: int,
    progress: Progress | None,
    cache: Path | None,
) -> dict[str, str]:
    """Simulate those not yet `found`, wide windows first, which take longest; returns those that cannot be, with the reason.

    Raises BatchError where workers died.
    """
    left = sorted(((n, d) for n, d in designs.items() if n not in found), key=lambda each: -each[1].window_width_mm)
    alike: dict[str, list[tuple[str, ShellDesign]]] = {}
    for each in left:
        alike.setdefault(key_of(each[1], wanted), []).append(each)
    missing: dict[str, str] = {}
    work = functools.partial(solve_design, wanted=wanted)
    dead: list[str] = []
    outcomes = run_batch([same[0] for same in alike.values()], work, min(jobs, max(len(alike), 1)), disposable=True)
    if progress and left:
        progress(len(found), len(designs))
    with contextlib.closing(outcomes):
        for outcome in outcomes:
            first, design = outcome.item
            same = alike[key_of(design, wanted)]
            if outcome.result is not None:
                solved = outcome.result["solved"]
                found.update((name, solved.called(name, shape)) for name, shape in same)
                if cache and (note := write_cached(cache, design, wanted, solved)):
                    notes.append(note)
            elif isinstance(outcome.error, BatchError):
                dead += [name for name, _ in same]
            elif outcome.error is not None:
                missing.update((name, str(outcome.error).replace(first, name)) for name, _ in same)
            if progress:
                progress(len(found) + len(missing), len(designs))
    if dead:
        what = f"{', '.join(dead)} not simulated: the worker process died, and again when tried alone"
        raise BatchError(what, hint="is there enough memory? give fewer --jobs; what is done is kept")
    return missing


def _cell_of(name: str, cell: Base | None) -> DesignBase | None:
    return None if cell is None else cell.designs.get(name)


def _straight(table: DesignBase) -> DesignBase:
    """A table of one pressure as a straight line from nothing at 0 MPa: the least that lets a wrong pressure be a rival."""
    if table.pressure_MPa[0] <= 0 or "volume_mL" in table.curves:
        return table
    curves = {name: np.array([0.0, value[0]]) for name, value in table.curves.items()}
    return replace(table, pressure_MPa=np.array([0.0, table.pressure_MPa[0]]), curves=curves)


def _along_cell(table: DesignBase, cell: DesignBase) -> DesignBase:
    """A table of one pressure, drawn out to a curve of the cell's course through its value."""
    grid = cell.pressure_MPa
    known = {name: value for name, value in table.curves.items() if name in cell.curves}
    there = {name: float(np.interp(table.pressure_MPa[0], grid, cell.curves[name])) for name in known}
    drawn = {name: cell.curves[name] * (value[0] / there[name]) for name, value in known.items() if there[name] != 0}
    return replace(table, pressure_MPa=grid, curves=drawn) if len(drawn) == len(table.curves) else table


def _with_cell(table: DesignBase, shape: ShellDesign | None, cell: DesignBase | None) -> DesignBase:
    if shape is None or cell is None:
        return replace(_straight(table) if len(table.pressure_MPa) == 1 else table, shape=shape)
    if len(table.pressure_MPa) == 1:
        table = _along_cell(table, cell)

    def at(row: FloatArray) -> FloatArray:
        return np.interp(table.pressure_MPa, cell.pressure_MPa, row)

    lent = {name: at(cell.curves[name]) for name in ("volume_mL", "stiffness_Nmm2") if name in cell.curves}
    curves = {**lent, **table.curves}
    knobs = {
        name: Knob(knob.values, {q: np.stack([at(row) for row in knob.factor[q]]) for q in curves if q in knob.factor})
        for name, knob in cell.knobs.items()
    }
    return replace(table, shape=shape, curves=curves, knobs=knobs)
