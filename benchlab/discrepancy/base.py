"""The simulation that is compared with: curves of each design, and how they change when a piece of the structure changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.units import FloatArray

if TYPE_CHECKING:
    from benchlab.discrepancy.effects.effect import Active

KNOBS = {
    "film_modulus": (1.0, "factor on the film's stiffness"),
    "fabric_modulus": (1.0, "factor on the fabric's and the strip's modulus"),
    "seam_margin_mm": (0.0, "margin of the weld along each edge of a window, mm"),
    "bladder_N_per_mm": (0.0, "membrane stiffness E·h of a bladder inside, in parallel with the film, N/mm"),
    "ballooning": (0.0, "share of the windows' bulging that the model has: 0 none, 1 all"),
}
"""Structural knobs: neutral value, and what it is. `ballooning` is for the beam model alone: the shell cell has it."""


@dataclass(frozen=True)
class Knob:
    """How the curves of one design change with one knob. values: (K,), increasing, the neutral one among them.

    factor: of each quantity (angle_deg, volume_mL, force_N), (K, P) over the pressures of the design: curve at the value over curve at
    neutral.
    """

    values: FloatArray
    factor: Mapping[str, FloatArray]


def between(knob: str, values: FloatArray, logs: FloatArray, at: FloatArray | float) -> FloatArray:
    """Logarithms of a knob's factors (K, P) at `values` (K,), looked up at others: a cubic spline, in the factor itself for amounts that
    add up (in its logarithm a margin of 0.2 mm would be 1.1 % off, so it is 0.1 %), in the logarithm for moduli, which multiply.

    >>> float(np.exp(between("film_modulus", np.array([0.5, 1.0, 2.0]), np.log([[2.0], [1.0], [0.5]]), 1.0))[0])
    1.0
    """
    from scipy.interpolate import CubicSpline

    if KNOBS[knob][0] == 1.0:
        return np.asarray(CubicSpline(values, logs, axis=0)(at))
    return np.asarray(np.log(np.maximum(CubicSpline(values, np.exp(logs), axis=0)(at), 0.5 * np.exp(logs.min()))))


@dataclass(frozen=True)
class DesignBase:
    """Simulated curves of one design.

    pressure_MPa: (P,), increasing from 0. curves: angle_deg, and volume_mL, force_N, stiffness_Nmm2 where known, (P,) each; the last is the
    bending stiffness at constant pressure, dM/dk of k = θ/length.
    shape: the design, None where it is not known. knobs: by names of KNOBS, those that were computed.
    """

    name: str
    pressure_MPa: FloatArray
    curves: Mapping[str, FloatArray]
    shape: ShellDesign | None = None
    knobs: Mapping[str, Knob] = field(default_factory=dict)


@dataclass(frozen=True)
class Base:
    """Designs by name. kind: cell, beam or foreign. source: in words. error: of its numbers, relative (u_num of V&V 20).

    missing: designs that could not be simulated, each with its reason. warnings: curves and knobs that end early, a cache that was damaged.
    given: effects that are part of this model already, with their numbers: every prediction has them.
    """

    designs: Mapping[str, DesignBase]
    kind: str
    source: str
    error: float = 0.005
    missing: Mapping[str, str] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    given: tuple[Active, ...] = ()

    def largest_pressure_MPa(self, design: str) -> float:
        return float(np.max(self.designs[design].pressure_MPa))
