"""One design for `benchlab explain`: its simulated curves, and how they change with each structural knob."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import KNOBS, DesignBase, Knob
from benchlab.errors import InputError
from benchlab.simulation.actuator_response import ActuatorResponse, Curves, Fixture, actuator_response
from benchlab.simulation.beam import beam_response
from benchlab.simulation.layup import Layup
from benchlab.simulation.neighbour import Neighbour, neighbour_at
from benchlab.units import FloatArray
from benchlab.workflows.explain_structure import design_with, knob_values

FINER = 3
"""Pressures given for each simulated one; between them a curve is the cubic spline through those that were simulated."""
LEAST_PRESSURES = 5
"""Simulated pressures below which a curve that ends early (the actuator bursts) is none."""
SMALLEST_FACTOR, LARGEST_FACTOR = 0.01, 100.0
"""Factors stay between these. Beyond them an angle is near 0 or turns its sign, at a pressure at which hardly anything bends."""


@dataclass(frozen=True)
class Wanted:
    """What is the same for all designs. kind: cell or beam. forces: also held straight. knobs: names of KNOBS."""

    kind: str
    layup: Layup
    pressures_MPa: tuple[float, ...]
    fixture: Fixture
    forces: bool
    knobs: tuple[str, ...]


@dataclass(frozen=True)
class Solved:
    """A design's curves with what is to be said of them."""

    design: DesignBase
    notes: tuple[str, ...] = ()

    def called(self, name: str, shape: ShellDesign) -> Solved:
        """The same under another name and in another length: the cell is the same, so angle and volume go with the length, and
        blocked force and stiffness do not depend on it."""
        assert self.design.shape is not None
        ratio = shape.length_mm / self.design.shape.length_mm
        curves = {
            q: ratio * curve if q in ("angle_deg", "volume_mL") else curve for q, curve in self.design.curves.items()
        }
        notes = tuple(f"{name}: {note.removeprefix(f'{self.design.name}: ')}" for note in self.notes)
        return Solved(replace(self.design, name=name, shape=shape, curves=curves), notes)


def solve_design(named: tuple[str, ShellDesign], wanted: Wanted) -> dict[str, Any]:
    """`solved`: the curves of a design, in this process or in a worker, on one thread. Raises InputError where it has none."""
    with threadpool_limits(1):
        return {"solved": curves_with_knobs(*named, wanted)}


def curves_with_knobs(name: str, design: ShellDesign, wanted: Wanted) -> Solved:
    """Curves at all pressures; with knobs at every second one, which is enough for what changes (checked in the tests).

    A curve ends at the last pressure with a stable state. A knob's value with which the actuator does not reach that pressure is
    left out. Both are noted. Raises InputError where fewer than LEAST_PRESSURES are reached.
    """
    neutral = respond(design, wanted, {}, wanted.pressures_MPa)
    pressures = neutral.pressure_MPa
    if len(pressures) < LEAST_PRESSURES:
        raise InputError(
            f"{name} with material {wanted.layup.name} has no stable state from {wanted.pressures_MPa[len(pressures)]:g} MPa on",
            hint="take a stiffer material, or check the design's dimensions",
        )
    notes = []
    if neutral.limit_pressure_MPa is not None:
        notes.append(
            f"{name}: simulated up to {pressures[-1]:.4g} MPa, beyond which it has no stable state (it bursts)"
        )
    quantities = ["angle_deg", "volume_mL"]
    if wanted.forces and np.isfinite(neutral.moment_Nmm).all():
        quantities.append("force_N")
    elif wanted.forces:
        notes.append(f"{name}: no blocked force, because no stable state was found when held straight at all pressures")
    dense = np.interp(np.arange((len(pressures) - 1) * FINER + 1) / FINER, np.arange(len(pressures)), pressures)
    curves = _dense(neutral, [*quantities, "stiffness_Nmm2"], dense)
    few = pressures[np.arange(len(pressures) - 1, 0, -2)[::-1]]
    knobs = {}
    for knob in wanted.knobs:
        values, rows = _varied(knob, design, wanted, neutral, few, quantities, dense)
        if len(values) > 1:
            factor = {q: np.stack([_factor(row[q], curves[q]) for row in rows]) for q in quantities}
            knobs[knob] = Knob(values, factor)
        if len(values) < len(set(knob_values(knob, design, wanted.layup))):
            notes.append(
                f"{name}: {knob} is known from {values[0]:g} to {values[-1]:g} only; beyond, it does not reach {pressures[-1]:.4g} MPa"
            )
    return Solved(DesignBase(name, dense, curves, design, knobs), tuple(notes))


def respond(
    design: ShellDesign,
    wanted: Wanted,
    knobs: Mapping[str, float],
    pressures_MPa: FloatArray | tuple[float, ...],
    beside: Neighbour | None = None,
) -> Curves:
    """The design with knobs at these values, simulated anew. beside: states to begin from, of the cell."""
    changed, layup = design_with(design, wanted.layup, knobs)
    pressures = [float(p) for p in pressures_MPa]
    if wanted.kind == "beam":
        ballooning = knobs.get("ballooning", KNOBS["ballooning"][0])
        return beam_response(changed, layup, pressures, wanted.fixture, blocked=wanted.forces, ballooning=ballooning)
    return actuator_response(changed, layup, pressures, wanted.fixture, blocked=wanted.forces, beside=beside)


QUANTITY: Mapping[str, Callable[[Curves], FloatArray]] = {
    "angle_deg": lambda found: found.angle_deg,
    "volume_mL": lambda found: found.volume_mL,
    "force_N": lambda found: found.blocked_force_N,
    "stiffness_Nmm2": lambda found: found.bending_stiffness_Nmm2(),
}


def _varied(
    knob: str,
    design: ShellDesign,
    wanted: Wanted,
    neutral: Curves,
    pressures: FloatArray,
    quantities: list[str],
    dense: FloatArray,
) -> tuple[FloatArray, list[dict[str, FloatArray]]]:
    """Values of a knob, those around the neutral one with which every pressure is reached, with their curves at `dense`."""
    at_neutral = KNOBS[knob][0]
    rows = {at_neutral: _dense(neutral, quantities, dense)}
    unloaded = {q: QUANTITY[q](neutral)[:1] for q in quantities}
    known = {at_neutral: Neighbour(neutral.free, neutral.held)} if isinstance(neutral, ActuatorResponse) else {}
    wished = sorted(set(knob_values(knob, design, wanted.layup)))
    above = [value for value in wished if value > at_neutral]
    below = [value for value in reversed(wished) if value < at_neutral]
    for side in (above, below):
        for value in side:
            beside = neighbour_at(value, known) if known else None
            found = respond(design, wanted, {knob: value}, pressures, beside)
            whole = all(np.isfinite(QUANTITY[q](found)).all() for q in quantities)
            if len(found.pressure_MPa) < len(pressures) or not whole:
                break
            if isinstance(found, ActuatorResponse):
                known[value] = Neighbour(found.free, found.held)
            rows[value] = _dense(found, quantities, dense, unloaded)
    values = sorted(rows)
    return np.array(values), [rows[value] for value in values]


def _dense(
    found: Curves, quantities: list[str], pressures_MPa: FloatArray, unloaded: Mapping[str, FloatArray] | None = None
) -> dict[str, FloatArray]:
    """Splines. unloaded: (1,) each, at 0 MPa, where no knob changes anything, for curves that begin later."""
    from scipy.interpolate import CubicSpline

    if unloaded is None:
        return {q: CubicSpline(found.pressure_MPa, QUANTITY[q](found))(pressures_MPa) for q in quantities}
    at = np.concatenate([[0.0], found.pressure_MPa])
    return {q: CubicSpline(at, np.concatenate([unloaded[q], QUANTITY[q](found)]))(pressures_MPa) for q in quantities}


def _factor(changed: FloatArray, neutral: FloatArray) -> FloatArray:
    """changed / neutral (P,). At 0 MPa, where both may be 0, it is that of the next pressure."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = changed / neutral
    ratio[0] = ratio[1]
    return np.clip(ratio, SMALLEST_FACTOR, LARGEST_FACTOR)
