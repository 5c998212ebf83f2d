"""What a bench must not be asked for, found before its port is opened."""

from __future__ import annotations

import os

import numpy as np

from benchlab.bench import Bench
from benchlab.errors import InputError, counted
from benchlab.protocol.plan import Plan

_TOLERANCE_MPA = 1e-9


def check_limits(plan: Plan, bench: Bench, file: str | os.PathLike[str] | None = None) -> None:
    """InputError where the plan asks for more than the bench may give, or not for a pressure at all; names the worst step.

    file: the protocol's, which the error names. Both what steps reach exactly and what the ticks ask for are looked at.

    >>> from benchlab.protocol.segments import Hold
    >>> from benchlab.protocol.unroll import unroll
    >>> check_limits(unroll([Hold(1.0, 0.34)], "a", 100.0, 0.35), Bench("nominal", calibrated=True))
    >>> check_limits(unroll([Hold(1.0, 0.34)], "a", 100.0, 0.35), Bench("nominal"))  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    benchlab.errors.InputError: step 1 (hold 0.34 MPa for 1 s): asks for 0.34 MPa, above ... the ceiling of the bench; ask for less, or ...
    """
    _check_numbers(plan, file)
    ceiling_MPa = bench.ceiling_MPa
    highest = _highest(plan)
    over = np.flatnonzero(highest > ceiling_MPa + _TOLERANCE_MPA)
    if not len(over):
        return
    worst = int(np.argmax(highest))
    more = f"; in all, {counted(len(over), 'step')} of {len(highest)} ask for too much" if len(over) > 1 else ""
    named = "" if bench.name == "bench" or not bench.calibrated else f" {bench.name}"
    raise InputError(
        f"asks for {highest[worst]:.4g} MPa, above {ceiling_MPa:.4g} MPa, the ceiling of the bench{named}{more}",
        file=file,
        where=_place(plan, worst),
        hint="ask for less"
        if bench.calibrated
        else "ask for less, or calibrate the bench with `benchlab bench calibrate`: it has no calibration, and is given less for that",
    )


def _check_numbers(plan: Plan, file: str | os.PathLike[str] | None) -> None:
    """Each tick has a pressure from 0 up, or a reference, and not both."""
    open_loop, closed = np.isfinite(plan.pressure_MPa), np.isfinite(plan.reference_deg)
    wrong = np.flatnonzero((open_loop == closed) | (plan.pressure_MPa < 0))
    if len(wrong):
        tick = int(wrong[0])
        what = f"tick {tick} asks for {plan.pressure_MPa[tick]:g} MPa and {plan.reference_deg[tick]:g}°"
        hint = "a tick needs a pressure from 0 up, or an angle"
        raise InputError(what, file=file, where=_place(plan, int(plan.step[tick])), hint=hint)


def _highest(plan: Plan) -> np.ndarray:
    """(S,) the highest pressure of each step, exact or at its ticks; 0 in closed loop."""
    exact = np.array([step.high_MPa or 0.0 for step in plan.steps], dtype=float)
    known = np.isfinite(plan.pressure_MPa)
    np.maximum.at(exact, plan.step[known], plan.pressure_MPa[known])
    return exact


def _place(plan: Plan, index: int) -> str:
    step = plan.steps[index]
    line = f"line {step.line}, " if step.line else ""
    return f"{line}step {index + 1} ({step.label})"
