"""A sweep on disk: a table with a row a design and pressure, and HDF5 (NXdata) over what varies and the pressure.

/entry            NXentry   settings, provenance (JSON texts)
/entry/sweep      NXdata    angle_deg and the other curves over the fields that vary and pressure_MPa
/entry/designs    NXcollection  of each design: reason (why values are missing) and key (what they follow from)
"""

from __future__ import annotations

import csv
import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from benchlab.errors import BenchlabError
from benchlab.io.files import written_whole
from benchlab.io.hdf5 import Reader, add_numbers, add_texts, open_hdf5
from benchlab.io.nexus import Schema, nxdata, read_document, write_nexus
from benchlab.io.response_file import CURVES as RESPONSE_CURVES
from benchlab.io.response_file import EXTRAS
from benchlab.io.table import guarded

FloatArray = NDArray[np.float64]

SCHEMA = Schema("benchlab-sweep", 1, "benchlab sweep file")

CURVES = {
    **{name: words for name, words in RESPONSE_CURVES.items() if name != "pressure_MPa"},
    "peak_film_strain": EXTRAS["peak_film_strain"],
}
"""Unit and name of each curve of a design, in the order of the table."""

_DESIGN = {
    "tpu_area_mm2": ("mm2", "TPU area, Eq 6 (mm²)"),
    "limit_pressure_MPa": ("MPa", "last pressure with a stable state, where there is one without (MPa)"),
}


@dataclass(frozen=True)
class Sweep:
    """All combinations of `axes` (field, as slw_mm -> its values), D designs in the order of itertools.product, at
    `pressure_MPa` (P,).

    curves: (D, P) under the names of CURVES. designs: (D,) under tpu_area_mm2 and limit_pressure_MPa (NaN: none). NaN is
    no value; reason (D,) says why one is missing, "" where none is. key (D,): what a result follows from, "" where there
    is no result. settings and provenance hold what JSON can hold.
    """

    axes: Mapping[str, tuple[float, ...]]
    pressure_MPa: FloatArray
    curves: Mapping[str, FloatArray]
    designs: Mapping[str, FloatArray]
    reason: tuple[str, ...]
    key: tuple[str, ...]
    settings: Mapping[str, Any]
    provenance: Mapping[str, Any]
    partial: bool = False

    @property
    def varied(self) -> tuple[str, ...]:
        """The fields with more than one value."""
        return tuple(name for name, values in self.axes.items() if len(values) > 1)

    def combinations(self) -> list[tuple[float, ...]]:
        """(D) the values of the fields of each design."""
        return list(itertools.product(*self.axes.values()))


def write_sweep_csv(path: Path, sweep: Sweep) -> None:
    """The table, whole or not at all. Columns: the design's fields, tpu_area_mm2, pressure_MPa, the curves,
    limit_pressure_MPa, reason. An empty cell is no value. InputError where the disk refuses."""
    header = [*sweep.axes, "tpu_area_mm2", "pressure_MPa", *sweep.curves, "limit_pressure_MPa", "reason"]
    with (
        written_whole(path) as temporary,
        temporary.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(_rows(sweep))


def write_sweep_file(path: Path, sweep: Sweep) -> None:
    """The HDF5 file, whole or not at all. InputError where the disk refuses."""

    def fill(entry: h5py.Group) -> None:
        _write_data(entry, sweep)
        collection = entry.create_group("designs")
        collection.attrs["NX_class"] = "NXcollection"
        add_texts(collection, "reason", sweep.reason, "why values of the design are missing")
        add_texts(collection, "key", sweep.key, "what the result of the design follows from (SHA-256)")

    documents = {"settings": sweep.settings, "provenance": sweep.provenance}
    write_nexus(path, SCHEMA, "sweep", documents, fill, sweep.partial)


def read_sweep_file(path: Path) -> Sweep:
    """Read a sweep file. InputError for anything damaged, foreign, cut short or from a newer benchlab."""
    with open_hdf5(path, SCHEMA.kind) as reader:
        SCHEMA.check(reader)
        settings, provenance = (read_document(reader, name, SCHEMA) for name in ("settings", "provenance"))
        axes = {name: tuple(map(float, values)) for name, values in settings["axes"].items()}
        pressure = reader.numbers("/entry/sweep/pressure_MPa").astype(float)
        shape = tuple(len(values) for values in axes.values() if len(values) > 1)
        count = math.prod(shape)
        curves = {name: _numbers(reader, name, (*shape, len(pressure))).reshape(count, -1) for name in CURVES}
        designs = {name: _numbers(reader, name, shape).reshape(count) for name in _DESIGN}
        reason, key = (reader.texts(f"/entry/designs/{name}", count) for name in ("reason", "key"))
        partial = bool(reader.attribute("partial"))
    return Sweep(axes, pressure, curves, designs, reason, key, settings, provenance, partial)


def read_earlier_sweep(path: Path) -> Sweep | None:
    """The sweep in a file; None where there is no file, or none that can be read as one."""
    try:
        return read_sweep_file(path)
    except BenchlabError:
        return None


def _rows(sweep: Sweep) -> Iterator[list[str]]:
    for index, combination in enumerate(sweep.combinations()):
        before = [_cell(value) for value in (*combination, sweep.designs["tpu_area_mm2"][index])]
        after = [_cell(sweep.designs["limit_pressure_MPa"][index])]
        for at, pressure in enumerate(sweep.pressure_MPa):
            values = [_cell(curve[index, at]) for curve in sweep.curves.values()]
            missing = not math.isfinite(sweep.curves["angle_deg"][index, at])
            reason = guarded(sweep.reason[index]) if missing else ""
            yield [*before, _cell(float(pressure)), *values, *after, reason]


def _cell(value: float) -> str:
    return f"{value:.8g}" if math.isfinite(value) else ""


def _write_data(entry: h5py.Group, sweep: Sweep) -> None:
    varied, pressure = sweep.varied, sweep.pressure_MPa
    shape = tuple(len(sweep.axes[name]) for name in varied)
    group = nxdata(entry, "sweep", "angle_deg", [*varied, "pressure_MPa"], "simulated bending angle")
    for name, values in sweep.axes.items():
        data = np.array(values) if name in varied else np.array([values[0]])
        add_numbers(group, name, data, "mm", f"{name.removesuffix('_mm')} (mm)")
    add_numbers(group, "pressure_MPa", pressure, "MPa", "pressure (MPa)")
    for axis in (*varied, "pressure_MPa"):
        group[axis].make_scale(axis)
    for names, arrays, dims in (
        (CURVES, sweep.curves, (*varied, "pressure_MPa")),
        (_DESIGN, sweep.designs, varied),
    ):
        for name, (unit, words) in names.items():
            size = (*shape, len(pressure)) if names is CURVES else shape or (1,)
            dataset = add_numbers(group, name, arrays[name].reshape(size), unit, words)
            for dimension, axis in enumerate(dims):
                dataset.dims[dimension].attach_scale(group[axis])


def _numbers(reader: Reader, name: str, shape: tuple[int, ...]) -> FloatArray:
    return reader.numbers(f"/entry/sweep/{name}", shape or (1,)).astype(float)
