"""Time and pressure out of an HDF5 file: a run file, or any group with time_s and pressure_MPa."""

from __future__ import annotations

from pathlib import Path

import h5py

from benchlab.errors import InputError
from benchlab.io.hdf5 import DAMAGE, Reader, open_hdf5
from benchlab.vision.picture import FloatArray

_MAX_GROUPS = 10_000


def read_pressure_group(path: Path) -> tuple[list[int], FloatArray, FloatArray, list[str]]:
    """Row numbers from 1, time in s and pressure in MPa, and warnings (none), of the one group that has both."""
    with open_hdf5(path) as reader:
        groups = _groups(reader)
        if len(groups) > 1 and "/entry/curvature" in groups:
            groups = ["/entry/curvature"]
        if not groups:
            hint = "a group with the datasets time_s and pressure_MPa is looked for"
            raise InputError("no pressure in this HDF5 file", file=path, hint=hint)
        if len(groups) > 1:
            hint = "keep one of them in the file"
            raise InputError(f"{len(groups)} pressure records: {groups[0]} and {groups[1]}", file=path, hint=hint)
        name = groups[0].rstrip("/")
        time_s = reader.numbers(f"{name}/time_s").astype(float)
        if time_s.ndim != 1:
            raise InputError("time_s is not a list of numbers", file=path, where=groups[0])
        pressure = reader.numbers(f"{name}/pressure_MPa", time_s.shape).astype(float)
    return list(range(1, len(time_s) + 1)), time_s, pressure, []


def _groups(reader: Reader) -> list[str]:
    """Names of the groups that hold both datasets, found along hard links, each object visited once."""
    found: list[str] = []
    waiting: list[tuple[str, h5py.Group]] = [("/", reader.file["/"])]
    seen: set[object] = set()
    try:
        while waiting and len(seen) < _MAX_GROUPS:
            name, group = waiting.pop()
            address = h5py.h5o.get_info(group.id).addr
            if address in seen:
                continue
            seen.add(address)
            hard = [key for key in group if isinstance(group.get(key, getlink=True), h5py.HardLink)]
            if "time_s" in hard and "pressure_MPa" in hard:
                found.append(name)
            waiting += [(f"{name.rstrip('/')}/{key}", group[key]) for key in hard if isinstance(group[key], h5py.Group)]
    except DAMAGE as error:
        raise InputError("damaged HDF5 file", file=reader.path, hint="copy it again, or make it again") from error
    return sorted(found)
