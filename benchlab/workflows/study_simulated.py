"""What a design of a study should do, from the file or the number that the study names."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.actuator import DIMENSIONS, ShellDesign
from benchlab.errors import InputError
from benchlab.io.hdf5 import is_hdf5, open_hdf5
from benchlab.io.response_file import read_response_curves
from benchlab.io.study_file import StudyDesign
from benchlab.io.study_values import Simulated
from benchlab.io.sweep_file import SCHEMA as SWEEP
from benchlab.io.sweep_file import read_sweep_file
from benchlab.units import FloatArray


def simulated_of(design: StudyDesign, pressure_MPa: float) -> Simulated | None:
    """The simulated angle and, from a file, its curve; None where the study names neither.

    Between two simulated pressures the angle is interpolated; outside of them it is NaN. Raises UsageError or InputError, also for
    a file that is of another design.
    """
    given = design.simulated
    if given is None:
        return None
    if given.path is None:
        none = np.empty(0)
        return Simulated(math.nan if given.angle_deg is None else given.angle_deg, given.source, none, none)
    found, told = _from_sweep(given.path, design) if _is_sweep(given.path) else _from_response(given.path, design)
    pressure, angle = found
    known = np.isfinite(angle) & np.isfinite(pressure)
    pressure, angle = pressure[known], angle[known]
    at = math.nan
    if len(pressure):
        at = float(np.interp(pressure_MPa, pressure, angle, left=np.nan, right=np.nan))
    return Simulated(at, given.source or f"{told} ({given.file})", pressure, angle)


def _is_sweep(path: Path) -> bool:
    if not is_hdf5(path):
        return False
    with open_hdf5(path) as reader:
        return bool(reader.attribute("schema") == SWEEP.name)


def _from_response(path: Path, design: StudyDesign) -> tuple[tuple[FloatArray, FloatArray], str]:
    curves = read_response_curves(path)
    stated = curves.about.get("design")
    if stated is not None and design.shell is not None:
        made = {field: stated.get(field) for field in DIMENSIONS.values()}
        _check_same(path, made, design.shell)
    material = curves.about.get("material", {}).get("name")
    words = f"simulated with material {material}" if material else "simulated"
    return (curves.pressure_MPa, curves.angle_deg), words


def _from_sweep(path: Path, design: StudyDesign) -> tuple[tuple[FloatArray, FloatArray], str]:
    if design.shell is None:
        hint = f"give {design.name} its dimensions with `shell:`"
        raise InputError("a sweep of many designs, and the dimensions of this one are not told", file=path, hint=hint)
    sweep = read_sweep_file(path)
    wanted = [getattr(design.shell, DIMENSIONS[name]) for name in sweep.axes]
    for index, combination in enumerate(sweep.combinations()):
        if np.allclose(combination, wanted, rtol=1e-9):
            material = sweep.settings.get("material", {}).get("name", "not stated")
            return (sweep.pressure_MPa, sweep.curves["angle_deg"][index]), f"simulated with material {material}"
    listed = ", ".join(f"{name} {value:g}" for name, value in zip(sweep.axes, wanted))
    raise InputError(f"no design of this sweep has {listed}", file=path, hint="simulate it, with benchlab simulate")


def _check_same(path: Path, made: Mapping[str, Any], shell: ShellDesign) -> None:
    for name, field in DIMENSIONS.items():
        wanted, found = getattr(shell, field), made[field]
        if found is not None and not math.isclose(found, wanted, rel_tol=1e-9):
            what = f"was simulated with {name} {found:g}, the design in the study has {wanted:g}"
            raise InputError(what, file=path, hint="name the file of this design, or correct `shell:`")
