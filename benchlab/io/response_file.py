"""Response curves of a simulated actuator on disk: HDF5 with states and provenance, and a CSV table of the curves alone.

    /entry             NXentry        design, material, simulation, provenance (JSON texts), warnings
    /entry/response    NXdata         angle_deg and the other curves over pressure_MPa
    /entry/states      NXcollection   fields (P, N, 6), k (P,), lam (P,): the cell, free to bend, at each pressure
    /entry/mesh        NXcollection   nodes_mm (N, 2), elements (E, 9) of the quarter cell

States and mesh are those of a simulated cell; a file of a model's curves is without them.
Both hold what was simulated, not measured; the HDF5 file says so in /entry/simulation.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError
from benchlab.io.delimited import open_table
from benchlab.io.files import written_whole
from benchlab.io.hdf5 import Reader, add_numbers, is_hdf5, open_hdf5
from benchlab.io.nexus import Schema, nxdata, read_document, read_provenance_of, write_nexus
from benchlab.io.numbers import NumberReader
from benchlab.simulation.actuator_response import ActuatorResponse
from benchlab.simulation.cell import FIELDS, State
from benchlab.simulation.laws.law import FloatArray

SCHEMA = Schema("benchlab-response", 1, "benchlab response file")

CURVES = {
    "pressure_MPa": ("MPa", "pressure (MPa)"),
    "angle_deg": ("deg", "bending angle θ (°)"),
    "curvature_per_mm": ("1/mm", "curvature of the strip's line (1/mm)"),
    "axial_stretch": ("", "axial stretch of the strip's line"),
    "volume_mL": ("mL", "volume (mL)"),
    "moment_Nmm": ("N.mm", "moment when held straight (N·mm)"),
    "blocked_force_N": ("N", "blocked force with the fixture stated (N)"),
}
"""Unit and name of each curve, in the order of the table."""

EXTRAS = {
    "tip_force_N": ("N", "force of the tip when held at an angle (N)"),
    "max_film_stretch": ("", "largest principal stretch of the film"),
    "peak_film_strain": ("", "largest principal strain of the film, but for 1 % of its area"),
    "max_fabric_stress_MPa": ("MPa", "largest von Mises stress of fabric and strip (MPa)"),
    "base_angle_deg": ("deg", "bending angle θ of the model's base alone (°)"),
}
"""Unit and name of what the HDF5 file may hold beside them."""

_DOCUMENTS = {"design": dict, "material": dict, "simulation": dict, "provenance": dict, "warnings": list}


@dataclass(frozen=True)
class ResponseCurves:
    """Curves against pressure, (P,) each, NaN where there is no value; what they are of, empty for a table.

    about: design, material, simulation, provenance, warnings.
    """

    pressure_MPa: FloatArray
    angle_deg: FloatArray
    curvature_per_mm: FloatArray
    axial_stretch: FloatArray
    volume_mL: FloatArray
    moment_Nmm: FloatArray
    blocked_force_N: FloatArray
    about: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class ResponseFile:
    """All that a response file holds. states: of the free cell, one a pressure, none of a model; extras: curves of EXTRAS."""

    curves: ResponseCurves
    extras: dict[str, FloatArray]
    states: tuple[State, ...]
    nodes_mm: FloatArray
    elements: NDArray[np.int64]


def write_response_file(
    path: Path,
    response: ActuatorResponse | Mapping[str, FloatArray],
    *,
    extras: Mapping[str, FloatArray],
    design: Mapping[str, Any],
    material: Mapping[str, Any],
    simulation: Mapping[str, Any],
    provenance: Mapping[str, Any],
    warnings: Sequence[str],
) -> None:
    """Write a response file whole or not at all. response: of a cell, or curves under the names of CURVES alone. extras: (P,) under names
    of EXTRAS. InputError where the disk refuses."""
    values = (design, material, simulation, provenance, list(warnings))

    def fill(entry: h5py.Group) -> None:
        _write_curves(entry, {**_columns(response), **extras})
        if isinstance(response, ActuatorResponse):
            _write_states(entry, response)

    write_nexus(path, SCHEMA, "response", dict(zip(_DOCUMENTS, values)), fill)


def write_response_csv(path: Path, response: ActuatorResponse | Mapping[str, FloatArray]) -> None:
    """Write the curves as a table, whole or not at all: the columns of CURVES, empty cells where there is no value."""
    columns = _columns(response)
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row in zip(*columns.values(), strict=True):
            writer.writerow([f"{value:.9g}" if math.isfinite(value) else "" for value in row])


def read_response_curves(path: Path) -> ResponseCurves:
    """The curves in a response file or in a table with its columns. Raises UsageError or InputError, with the line in a table."""
    return read_response_file(path).curves if is_hdf5(path) else _read_table(path)


def read_response_file(path: Path) -> ResponseFile:
    """Read a response file. InputError for anything damaged, foreign, cut short, outsize or from a newer benchlab."""
    with open_hdf5(path, SCHEMA.kind) as reader:
        SCHEMA.check(reader)
        about = {name: read_document(reader, name, SCHEMA, form) for name, form in _DOCUMENTS.items()}
        count = len(reader.numbers("/entry/response/pressure_MPa"))
        curves = {name: _column(reader, name, count) for name in CURVES}
        extras = {name: _column(reader, name, count) for name in EXTRAS if reader.find(f"/entry/response/{name}")}
        if not reader.find("/entry/states"):
            none = np.zeros((0, 2)), np.zeros((0, 9), dtype=np.int64)
            return ResponseFile(ResponseCurves(**curves, about=about), extras, (), *none)
        nodes = reader.numbers("/entry/mesh/nodes_mm").astype(float)
        elements = reader.numbers("/entry/mesh/elements").astype(np.int64)
        fields = reader.numbers("/entry/states/fields", (count, len(nodes), FIELDS)).astype(float)
        k, lam = (reader.numbers(f"/entry/states/{name}", (count,)).astype(float) for name in ("k", "lam"))
    states = tuple(State(f.ravel(), float(a), float(b)) for f, a, b in zip(fields, k, lam))
    return ResponseFile(ResponseCurves(**curves, about=about), extras, states, nodes, elements)


def read_response_provenance(path: Path) -> dict[str, Any] | None:
    """The provenance of a response file alone; None where there is none that can be read."""
    return read_provenance_of(path, SCHEMA)


def _columns(response: ActuatorResponse | Mapping[str, FloatArray]) -> Mapping[str, FloatArray]:
    return response.columns() if isinstance(response, ActuatorResponse) else response


def _write_curves(entry: h5py.Group, columns: Mapping[str, FloatArray]) -> None:
    group = nxdata(entry, "response", "angle_deg", ["pressure_MPa"], "simulated bending angle over pressure")
    group.attrs["auxiliary_signals"] = ["volume_mL", "moment_Nmm", "blocked_force_N"]
    for name, values in columns.items():
        add_numbers(group, name, np.asarray(values, dtype=float), *(CURVES | EXTRAS)[name])
    group["pressure_MPa"].make_scale("pressure_MPa")
    for name in columns:
        if name != "pressure_MPa":
            group[name].dims[0].attach_scale(group["pressure_MPa"])


def _write_states(entry: h5py.Group, response: ActuatorResponse) -> None:
    mesh = response.cell.mesh
    states = [point.state for point in response.free.points]
    group = entry.create_group("states")
    group.attrs["NX_class"] = "NXcollection"
    fields = np.stack([state.fields.reshape(-1, FIELDS) for state in states])
    add_numbers(group, "fields", fields, "", "x, y, t (mm) and director d_x, d_y, d_z of the nodes, per pressure")
    add_numbers(group, "k", np.array([s.k for s in states]), "rad/mm", "bending angle per unstretched length (rad/mm)")
    add_numbers(group, "lam", np.array([s.lam for s in states]), "", "axial stretch of the strip's line")
    group = entry.create_group("mesh")
    group.attrs["NX_class"] = "NXcollection"
    add_numbers(group, "nodes_mm", mesh.nodes_mm, "mm", "s and Z of the nodes of the quarter cell (mm)")
    add_numbers(group, "elements", mesh.elements, "", "nodes of the elements")


def _column(reader: Reader, name: str, count: int) -> FloatArray:
    return reader.numbers(f"/entry/response/{name}", (count,)).astype(float)


def _read_table(path: Path) -> ResponseCurves:
    with open_table(path) as table:
        missing = [name for name in CURVES if name not in table.header]
        if missing or len(set(table.header)) < len(table.header):
            what = f"without {', '.join(missing)}" if missing else "with a column twice"
            hint = "make it again with benchlab simulate"
            raise InputError(
                f"not a table of response curves: {what}", file=path, where=f"line {table.header_line}", hint=hint
            )
        reader = NumberReader(path, table.delimiter)
        rows = [[reader.read(cell, line) for cell in cells] for line, cells in table.rows]
        if reader.unreadable:
            line, text = reader.unreadable[0]
            raise InputError(f"not a number: {text!r}", file=path, where=f"line {line}")
        if table.warnings:
            raise InputError(table.warnings[0], file=path, hint="was the copy finished?")
    if not rows:
        raise InputError("a table without a row", file=path, hint="make it again with benchlab simulate")
    columns = dict(zip(table.header, np.array(rows).T))
    return ResponseCurves(**{name: columns[name] for name in CURVES})
