"""The response curve of a design for a run: simulated, and kept for the next run of this process."""

from __future__ import annotations

import functools

import numpy as np
from threadpoolctl import threadpool_limits

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError
from benchlab.io.layup_file import DEFAULT_LAYUP, read_layup
from benchlab.simulation.actuator_response import actuator_response
from benchlab.units import FloatArray

PRESSURES_MPa = tuple(round(0.0175 * i, 4) for i in range(1, 21))
"""Up to the paper's limit."""


@functools.cache
def simulated_curve(design: ShellDesign) -> tuple[FloatArray, FloatArray]:
    """Pressures (MPa) and angles (degrees), (P,) each, from 0 MPa to 0.35 MPa, free to bend, of the shipped material.

    InputError where the design has no stable state at the last pressure.
    """
    with threadpool_limits(1):
        found = actuator_response(design, read_layup(DEFAULT_LAYUP), PRESSURES_MPa, blocked=False)
    if len(found.pressure_MPa) < len(PRESSURES_MPa):
        last = found.pressure_MPa[-1] if len(found.pressure_MPa) else 0.0
        raise InputError(
            f"{design.name} has no stable state above {last:g} MPa, and a run may go to {PRESSURES_MPa[-1]:g} MPa",
            hint="take another design, or give its curve with --curve",
        )
    return np.concatenate([[0.0], found.pressure_MPa]), np.concatenate([[0.0], found.angle_deg])
