"""Simulated curves from any engine, as a table with a row a design and pressure.

    design, pressure_MPa, angle_deg or blocked_force_N or both, and volume_mL where it is; other units by their names, as of measurements

Designs are known by their names (`tw3_slw10`) or by columns tw_mm, slw_mm, which stand in for `design` too. The tables of
`benchlab simulate` and `benchlab sweep`, and the published one, are such tables.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import DesignBase
from benchlab.errors import InputError, counted, printable
from benchlab.io.designs_table import WANTED, designs_of_names, shapes_in
from benchlab.io.measured_cells import read_cells
from benchlab.io.measured_columns import find_columns
from benchlab.io.measured_frame import Rows, RunName, rows_of
from benchlab.units import FloatArray

if TYPE_CHECKING:
    import pandas

CURVES = ("angle_deg", "volume_mL", "force_N")
AT_ZERO = {"angle_deg": 0.0, "force_N": 0.0}
"""What a straight actuator has at no pressure. A volume it has too, but which one is not known."""

SAYS_NOTHING = ("fem", "simulated", "sim")
"""Words in a name of a column of simulated values that say no more than that they are."""


def read_simulated(
    path: Path, columns: Mapping[str, str] | None = None, told: list[str] | None = None
) -> Mapping[str, DesignBase]:
    """The curves of each design. columns: as of `read_measured`. told: takes what was assumed or left out.

    A table that begins above 0 MPa gets an angle and a force of 0 there, which is told. One pressure alone is taken as it is.
    Raises UsageError or InputError, with the line, for a pressure of a design that stands twice, a negative one, or no angle and no force.
    """
    told = [] if told is None else told
    cells = read_cells(path, lambda header: find_columns(header, str(path), columns, (), SAYS_NOTHING))
    if cells.frame.empty:
        raise InputError("no data rows", file=path, hint="the table holds only a header")
    rows = rows_of(cells, str(path), "line", (), RunName(), samples=False)
    _settle_force(rows)
    told += rows.warnings
    shapes = shapes_in(cells, str(path), told) if set(WANTED) <= set(cells.columns.read) else {}
    shapes = {**designs_of_names(map(str, rows.frame["design"].cat.categories)), **shapes}
    rows = _with_curve(rows, told)
    parts = rows.frame.groupby("design", observed=True, sort=True)
    found = {str(name): _design(rows, part, str(name), shapes.get(str(name)), told) for name, part in parts}
    _tell_single(found, told)
    return found


def _settle_force(rows: Rows) -> None:
    """The blocked force by its name among the curves."""
    if {"force_N", "blocked_force_N"} <= set(rows.frame):
        raise InputError(
            "two columns of the blocked force", file=rows.source, hint="keep one of force and blocked_force"
        )
    if "blocked_force_N" in rows.frame:
        rows.frame["force_N"] = rows.frame.pop("blocked_force_N")
    if not {"angle_deg", "force_N"} & set(rows.frame):
        hint = "name it angle_deg (or rad) or blocked_force_N, or say --columns angle_deg=NAME"
        raise InputError("no column of the angle, nor of the blocked force", file=rows.source, hint=hint)


def _with_curve(rows: Rows, told: list[str]) -> Rows:
    """The rows that have a pressure and an angle; where there is no column of the angle, a force."""
    wanted, word = ("angle_deg", "an angle") if "angle_deg" in rows.frame else ("force_N", "a force")
    known = np.isfinite(rows.frame["pressure_MPa"].to_numpy()) & np.isfinite(rows.frame[wanted].to_numpy())
    if not known.any():
        raise InputError(f"no row with a pressure and {word}", file=rows.source, hint="are the columns empty?")
    if not known.all():
        line = rows.frame.index[~known][0]
        told.append(
            f"{counted(int((~known).sum()), 'row')} without pressure or {word.split()[1]} left out, the first in line {line}"
        )
    frame = rows.frame[known]
    if (frame["pressure_MPa"] < 0).any():
        at = int(np.argmax((frame["pressure_MPa"] < 0).to_numpy()))
        what, hint = f"pressure of {frame['pressure_MPa'].iloc[at]:g} MPa", "give curves from 0 MPa on"
        raise InputError(what, file=rows.source, where=f"line {frame.index[at]}", hint=hint)
    return Rows(frame, rows.source)


def _design(rows: Rows, part: pandas.DataFrame, name: str, shape: ShellDesign | None, told: list[str]) -> DesignBase:
    part = part.sort_values("pressure_MPa", kind="stable")
    pressure = part["pressure_MPa"].to_numpy()
    again = np.flatnonzero(np.diff(pressure) == 0)
    if len(again):
        lines = sorted(part.index[[again[0], again[0] + 1]].tolist())
        what = f"{printable(name)} at {pressure[again[0]]:g} MPa stands twice, first in line {lines[0]}"
        raise InputError(what, file=rows.source, where=f"line {lines[1]}", hint="give one row a design and pressure")
    curves = {quantity: part[quantity].to_numpy() for quantity in CURVES if quantity in part}
    if len(pressure) > 1 and pressure[0] > 0:
        told.append(f"{printable(name)} begins at {pressure[0]:g} MPa: straight at 0 MPa, with no force, is assumed")
        pressure = np.append(0.0, pressure)
        curves = {quantity: np.append(AT_ZERO.get(quantity, np.nan), values) for quantity, values in curves.items()}
    return DesignBase(name, pressure, _complete(curves, name, told), shape)


def _complete(curves: Mapping[str, FloatArray], name: str, told: list[str]) -> dict[str, FloatArray]:
    """The curves with a value at each pressure; another one is left out, which is told unless it is empty."""
    whole = {quantity: values for quantity, values in curves.items() if np.isfinite(values).all()}
    for quantity, values in curves.items():
        if quantity not in whole and np.isfinite(values).any():
            told.append(f"{quantity} of {printable(name)} is missing at some pressures: not read")
    return whole


def _tell_single(found: Mapping[str, DesignBase], told: list[str]) -> None:
    single = [printable(name) for name, base in found.items() if len(base.pressure_MPa) == 1]
    if single:
        listed = ", ".join(single[:5]) + (" …" if len(single) > 5 else "")
        told.append(f"one pressure only of {listed}: nothing is known of it at others")
