"""What a whole actuator does: angle, volume, moment and blocked force against pressure, from its one cell."""

from __future__ import annotations

import functools
import itertools
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError
from benchlab.simulation.cell import Cell
from benchlab.simulation.laws.law import FloatArray
from benchlab.simulation.layup import Layup
from benchlab.simulation.neighbour import Neighbour, follow_beside
from benchlab.simulation.response import Path, bending_stiffness_Nmm2

PUBLISHED_LEVER_ARM_MM = 4.5
"""Lever arm at which the published blocked force, 37.72 N at 0.35 MPa (tw 3, slw 10), is the simulated straight-held
moment, 169 N·mm with the film `from-FEM-angles`."""


@dataclass(frozen=True)
class Fixture:
    """How a blocked actuator meets the load cell: its moment at a lever arm, or its pressure on an area.

    The paper does not describe its fixture; every blocked force is true for the fixture stated beside it only.
    """

    lever_arm_mm: float | None = PUBLISHED_LEVER_ARM_MM
    contact_area_mm2: float | None = None

    def __post_init__(self) -> None:
        if (self.lever_arm_mm is None) == (self.contact_area_mm2 is None):
            raise UsageError("a fixture has a lever arm or a contact area", hint="give one of the two")
        for name, value in vars(self).items():
            if value is not None and not 0 < value < np.inf:
                raise UsageError(f"the fixture's {name} is {value}", hint="give a positive number")

    def force_N(self, pressure_MPa: FloatArray, moment_Nmm: FloatArray) -> FloatArray:
        """Blocked force of an actuator held straight."""
        if self.contact_area_mm2 is not None:
            return pressure_MPa * self.contact_area_mm2
        assert self.lever_arm_mm is not None
        return moment_Nmm / self.lever_arm_mm

    def __str__(self) -> str:
        if self.contact_area_mm2 is not None:
            return f"contact area {self.contact_area_mm2:g} mm²"
        return f"lever arm {self.lever_arm_mm:g} mm"


@dataclass(frozen=True)
class Curves(ABC):
    """Response curves of a simulated actuator; arrays are (P,), one value a pressure that was reached.

    angle_rad: between the two ends, k·(al − 2 cap). curvature_per_mm: 1/radius of the strip's line, so that the angle is
    curvature · stretch · length. axial_stretch: of the strip's line. moment_Nmm: on what holds the actuator straight,
    NaN where that state was not found. limit_pressure_MPa: None, or the last pressure with a stable state, where one
    asked for had none.
    """

    design: ShellDesign
    layup: Layup
    fixture: Fixture
    cap_mm: float
    pressure_MPa: FloatArray
    angle_rad: FloatArray
    curvature_per_mm: FloatArray
    axial_stretch: FloatArray
    volume_mm3: FloatArray
    moment_Nmm: FloatArray
    limit_pressure_MPa: float | None

    @property
    def angle_deg(self) -> FloatArray:
        return np.degrees(self.angle_rad)

    @property
    def volume_mL(self) -> FloatArray:
        return self.volume_mm3 / 1000

    @property
    def blocked_force_N(self) -> FloatArray:
        return self.fixture.force_N(self.pressure_MPa, self.moment_Nmm)

    @abstractmethod
    def bending_stiffness_Nmm2(self) -> FloatArray:
        """(P,): dM/dk at constant pressure where the actuator bends freely."""

    def columns(self) -> dict[str, FloatArray]:
        """The curves by the names that they have in files."""
        names = (
            "pressure_MPa",
            "angle_deg",
            "curvature_per_mm",
            "axial_stretch",
            "volume_mL",
            "moment_Nmm",
            "blocked_force_N",
        )
        return {name: getattr(self, name) for name in names}


@dataclass(frozen=True)
class ActuatorResponse(Curves):
    """Those of the shell cell. free, held: the states of the cell."""

    seconds: float
    cell: Cell
    free: Path
    held: Path | None

    def bending_stiffness_Nmm2(self) -> FloatArray:
        return np.array([bending_stiffness_Nmm2(self.cell, point) for point in self.free.points])


def actuator_response(
    design: ShellDesign,
    layup: Layup,
    pressures_MPa: Sequence[float],
    fixture: Fixture | None = None,
    cap_mm: float = 0.0,
    blocked: bool = True,
    progress: Callable[[int, int], None] | None = None,
    beside: Neighbour | ActuatorResponse | None = None,
    **cell_options: Any,
) -> ActuatorResponse:
    """Simulate an actuator at growing pressures (MPa). cap_mm: rigid length at each end. blocked: also held straight.

    progress: called with states found and states wanted. beside: the response of the same design laminated a little otherwise, at these
    pressures among others: found beside its states in half the time. cell_options: `refine` and `terms` of Cell.of.
    Raises UsageError for impossible pressures or caps.

    >>> from benchlab.simulation.laws import Polynomial
    >>> layup = Layup("trial", "guessed", film=Polynomial(C10=1.5, C20=3.0))
    >>> actuator_response(ShellDesign(10, 3), layup, [0.1, 0.2], blocked=False).angle_deg.round(0)
    array([42., 78.])
    """
    check_cap(cap_mm, design)
    started = time.perf_counter()
    cell = Cell.of(design, layup, **cell_options)
    found = itertools.count(1)
    wanted = (1 + blocked) * len(pressures_MPa)
    reached = functools.partial(lambda tell: tell(next(found), wanted), progress) if progress else None
    free = follow_beside(cell, pressures_MPa, beside.free if beside else None, reached=reached)
    straight = [point.pressure_MPa for point in free.points]
    near = beside.held if beside else None
    held = follow_beside(cell, straight, near, held_k=0.0, reached=reached) if blocked and straight else None
    k, lam = (np.array([getattr(point.state, name) for point in free.points]) for name in ("k", "lam"))
    moment = np.full(len(k), np.nan)
    if held is not None:
        moment[: len(held.points)] = [point.moment_Nmm for point in held.points]
    active = design.length_mm - 2 * cap_mm
    section = np.array([cell.volume_mm3(point.state) for point in free.points]) / (2 * cell.half_length_mm)
    return ActuatorResponse(
        design=design,
        layup=layup,
        fixture=fixture or Fixture(),
        cap_mm=cap_mm,
        pressure_MPa=np.array([point.pressure_MPa for point in free.points]),
        angle_rad=k * active,
        curvature_per_mm=k / lam,
        axial_stretch=lam,
        volume_mm3=section * active + np.pi * cell.radius_mm**2 * 2 * cap_mm,
        moment_Nmm=moment,
        limit_pressure_MPa=free.limit_pressure_MPa,
        seconds=time.perf_counter() - started,
        cell=cell,
        free=free,
        held=held,
    )


def check_cap(cap_mm: float, design: ShellDesign) -> None:
    """Raises UsageError for a rigid length at each end that leaves nothing to bend."""
    if not 0 <= 2 * cap_mm < design.length_mm:
        raise UsageError(
            f"caps of {cap_mm} mm leave nothing of {design.length_mm:g} mm to bend", hint="give the length of one cap"
        )


def tip_force_N(moment_Nmm: FloatArray, angle_rad: FloatArray, length_mm: FloatArray | float) -> FloatArray:
    """Force with which the tip presses along the path on which it would move, F·|d tip/dθ| = M (virtual work of an arc
    of constant curvature). At θ = 0 the lever is half the length.

    >>> float(tip_force_N(np.array(90.0), np.array(0.0), 180.0))
    1.0
    """
    angle = np.asarray(angle_rad, dtype=float)
    small = np.abs(angle) < 1e-4
    safe = np.where(small, 1.0, angle)
    # tip = L·(1 − cos θ, sin θ)/θ; its derivative has the length below.
    across = np.sin(safe) / safe - (1 - np.cos(safe)) / safe**2
    along = np.cos(safe) / safe - np.sin(safe) / safe**2
    lever = np.where(small, 0.5, np.hypot(across, along)) * length_mm
    return np.asarray(moment_Nmm / lever)
