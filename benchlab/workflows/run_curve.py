"""The actuator on the bench: its response curve from a file, or of a design, simulated and kept for the next run of this process."""

from __future__ import annotations

import functools
from pathlib import Path

from threadpoolctl import threadpool_limits

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError
from benchlab.io.layup_file import DEFAULT_LAYUP, read_layup
from benchlab.io.twin_file import read_curve
from benchlab.simulation.actuator_response import actuator_response
from benchlab.twin.curve import ResponseCurve
from benchlab.workflows.open_bench import Actuator

PRESSURES_MPa = tuple(round(0.0175 * i, 4) for i in range(21))
"""Up to the paper's limit."""


def actuator_of(design: ShellDesign | None, curve: Path | None) -> Actuator | None:
    """The actuator of --design or --curve; None where neither is given. Raises UsageError and InputError."""
    if curve is not None:
        return Actuator(read_curve(curve), curve.stem)
    return None if design is None else Actuator(simulated_curve(design), design.name, design.length_mm)


@functools.cache
def simulated_curve(design: ShellDesign) -> ResponseCurve:
    """A design of the shipped material, free to bend, from 0 to 0.35 MPa.

    InputError where it has no stable state at the last pressure.
    """
    with threadpool_limits(1):
        found = actuator_response(design, read_layup(DEFAULT_LAYUP), PRESSURES_MPa, blocked=False)
    if len(found.pressure_MPa) < len(PRESSURES_MPa):
        last = found.pressure_MPa[-1] if len(found.pressure_MPa) else 0.0
        raise InputError(
            f"{design.name} has no stable state above {last:g} MPa, and a run may go to {PRESSURES_MPa[-1]:g} MPa",
            hint="take another design, or give its curve with --curve",
        )
    columns = found.columns()
    return ResponseCurve(
        found.pressure_MPa,
        found.angle_deg,
        columns["volume_mL"],
        columns["axial_stretch"],
        f"{design.name}, simulated with material {DEFAULT_LAYUP}",
    )
