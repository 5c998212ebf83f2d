"""The run file: everything that was seen in one recording, as HDF5 that NeXus viewers draw and xarray opens.

    /entry                   NXentry   settings, provenance, recording, scale, warnings as JSON texts
    /entry/curvature         NXdata    angle_deg over time_s, and all that is known per frame
    /entry/angle_over_pressure NXdata  the same angle over pressure_MPa, where a pressure is known
    /entry/tracks            NXdata    markers_px (T, N, 2), used (T, N), centroid_sd_px (T,)
    /entry/fit               NXdata    centre_px (T, 2), radius_px, curvature_per_px (T,)

Stills have no time: there the axis is `frame`, the picture number from 0. Every number is under a Fletcher-32 checksum,
every text beside its SHA-256, and HDF5's own structures under theirs (file format 1.10).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError
from benchlab.io.hdf5 import Reader, add_numbers, add_texts, open_hdf5
from benchlab.io.nexus import Schema, nxdata, read_document, read_provenance_of, write_nexus
from benchlab.vision.picture import FloatArray
from benchlab.vision.series import CurvatureSeries

SCHEMA = Schema("benchlab-run", 1, "benchlab run file")
_DOCUMENTS = ("settings", "provenance", "recording", "scale", "warnings")
_XY = ("x", "y")


@dataclass(frozen=True)
class RunFile:
    """What a run file holds. partial: the recording was not gone through to its end."""

    series: CurvatureSeries
    settings: dict[str, Any]
    provenance: dict[str, Any]
    recording: dict[str, Any]
    scale: dict[str, Any]
    warnings: list[str]
    partial: bool


def write_run_file(
    path: Path,
    series: CurvatureSeries,
    *,
    settings: Mapping[str, Any],
    provenance: Mapping[str, Any],
    recording: Mapping[str, Any],
    scale: Mapping[str, Any],
    warnings: Sequence[str],
    partial: bool,
) -> None:
    """Write a run file whole or not at all. The dictionaries hold what JSON can hold, paths and numpy numbers too.

    Numbers in them that are not finite become None. Raises InputError where the disk refuses.
    """
    documents = dict(zip(_DOCUMENTS, (dict(settings), dict(provenance), dict(recording), dict(scale), list(warnings))))

    def fill(entry: h5py.Group) -> None:
        axis = _write_curvature(entry, series)
        _write_tracks(entry, series, axis)
        _write_fit(entry, series, axis)
        _write_over_pressure(entry, axis)

    write_nexus(path, SCHEMA, "curvature", documents, fill, partial)


def read_run_file(path: Path) -> RunFile:
    """Read a run file. InputError for anything damaged, foreign, cut short, outsize or from a newer benchlab."""
    with open_hdf5(path, SCHEMA.kind) as reader:
        SCHEMA.check(reader)
        series = _read_series(reader)
        read: dict[str, Any] = {
            name: read_document(reader, name, SCHEMA, list if name == "warnings" else dict) for name in _DOCUMENTS
        }
        partial = bool(reader.file.attrs["partial"])
    return RunFile(series, **read, partial=partial)


def read_provenance(path: Path) -> dict[str, Any] | None:
    """The provenance of a run file, read alone and quickly; its key `partial` tells a run that was not finished.

    None where there is no file, no run file of this schema, or an unreadable one.
    """
    return read_provenance_of(path, SCHEMA)


def _write_curvature(entry: h5py.Group, series: CurvatureSeries) -> str:
    """Write the main group; returns the name of the axis that all other arrays share."""
    timed = bool(np.isfinite(series.time_s).all()) and series.time_s.size > 0
    axis = "time_s" if timed else "frame"
    group = nxdata(entry, "curvature", "angle_deg", [axis], "bending angle of the actuator")
    group.attrs["auxiliary_signals"] = ["curvature_per_mm"]
    frame = np.arange(len(series.time_s), dtype=np.int64)
    add_numbers(group, "frame", frame, "", "frame number from 0" if timed else "picture number from 0")
    if timed:
        add_numbers(group, "time_s", series.time_s, "s", "time (s)")
    group[axis].make_scale(axis)
    degrees = np.degrees(series.angle_rad), np.degrees(series.angle_sd_rad)
    add_numbers(group, "angle_deg", degrees[0], "deg", "bending angle θ (°)")
    add_numbers(group, "angle_deg_errors", degrees[1], "deg", "standard deviation of θ (°)")
    add_numbers(group, "curvature_per_mm", series.curvature_per_mm, "1/mm", "curvature κ (1/mm)")
    add_numbers(group, "curvature_per_mm_errors", series.curvature_sd_per_mm, "1/mm", "standard deviation of κ (1/mm)")
    add_numbers(group, "radius_mm", series.radius_mm, "mm", "radius (mm)")
    add_numbers(group, "fit_rms_px", series.fit_rms_px, "px", "residual of the circle, rms (px)")
    add_numbers(group, "n_markers", series.n_markers.astype(np.int32), "", "markers in the fit")
    if series.pressure_MPa is not None:
        add_numbers(group, "pressure_MPa", series.pressure_MPa, "MPa", "pressure (MPa)")
    add_texts(group, "flag", series.flag, "what is to be said about the frame")
    if series.names:
        add_texts(group, "name", series.names, "file name")
    _attach(group, axis)
    return axis


def _write_tracks(entry: h5py.Group, series: CurvatureSeries, axis: str) -> None:
    group = nxdata(entry, "tracks", "markers_px", [axis, "marker", "xy"], "markers along the body, fixed end first")
    group[axis] = entry["curvature"][axis]
    add_numbers(group, "marker", np.arange(1, series.used.shape[1] + 1), "", "marker, 1 at the fixed end")
    add_texts(group, "xy", _XY, "x to the right, y down")
    group["marker"].make_scale("marker")
    group["xy"].make_scale("xy")
    add_numbers(group, "markers_px", series.markers_px, "px", "marker position (px)")
    add_numbers(group, "used", series.used.astype(np.uint8), "", "1 where the marker entered the fit")
    add_numbers(group, "centroid_sd_px", series.centroid_sd_px, "px", "noise of one marker coordinate (px)")
    _attach(group, axis, "marker", "xy")


def _write_fit(entry: h5py.Group, series: CurvatureSeries, axis: str) -> None:
    group = nxdata(entry, "fit", "curvature_per_px", [axis], "fitted circle in the picture")
    group[axis] = entry["curvature"][axis]
    add_texts(group, "xy", _XY, "x to the right, y down")
    group["xy"].make_scale("xy")
    add_numbers(group, "curvature_per_px", series.curvature_per_px, "1/px", "curvature (1/px)")
    add_numbers(group, "radius_px", series.radius_px, "px", "radius (px)")
    add_numbers(group, "centre_px", series.centre_px, "px", "centre (px)")
    _attach(group, axis, "xy")


def _write_over_pressure(entry: h5py.Group, axis: str) -> None:
    source = entry["curvature"]
    if "pressure_MPa" not in source:
        return
    group = nxdata(entry, "angle_over_pressure", "angle_deg", ["pressure_MPa"], "bending angle over pressure")
    for name in ("angle_deg", "angle_deg_errors", "pressure_MPa", axis):
        group[name] = source[name]  # hard links: the same data, under a second name


def _attach(group: h5py.Group, *axes: str) -> None:
    """Dimension scales for every dataset whose first dimensions they fit, so that xarray knows them by name."""
    for name, dataset in group.items():
        if name in axes or name == "title":
            continue
        names = {"centre_px": (axes[0], "xy")}.get(name, axes)
        for dimension, axis in zip(range(dataset.ndim), names):
            dataset.dims[dimension].attach_scale(group[axis])


def _read_series(reader: Reader) -> CurvatureSeries:
    main, tracks, fit = "/entry/curvature", "/entry/tracks", "/entry/fit"
    frame = reader.numbers(f"{main}/frame")
    marker = reader.numbers(f"{tracks}/marker")
    if frame.ndim != 1 or marker.ndim != 1:
        raise InputError("frames and markers are not lists", file=reader.path, hint=f"not a {SCHEMA.kind}")
    t, n = len(frame), len(marker)

    def column(name: str, *shape: int) -> FloatArray:
        return reader.numbers(name, (t, *shape)).astype(float)

    def optional(name: str) -> FloatArray | None:
        return None if reader.find(f"{main}/{name}") is None else column(f"{main}/{name}")

    time_s = optional("time_s")
    used: NDArray[np.bool_] = reader.numbers(f"{tracks}/used", (t, n)).astype(bool)
    return CurvatureSeries(
        time_s=np.full(t, np.nan) if time_s is None else time_s,
        markers_px=column(f"{tracks}/markers_px", n, 2),
        used=used,
        angle_rad=np.radians(column(f"{main}/angle_deg")),
        angle_sd_rad=np.radians(column(f"{main}/angle_deg_errors")),
        curvature_per_mm=column(f"{main}/curvature_per_mm"),
        curvature_sd_per_mm=column(f"{main}/curvature_per_mm_errors"),
        radius_mm=column(f"{main}/radius_mm"),
        centre_px=column(f"{fit}/centre_px", 2),
        radius_px=column(f"{fit}/radius_px"),
        curvature_per_px=column(f"{fit}/curvature_per_px"),
        fit_rms_px=column(f"{main}/fit_rms_px"),
        centroid_sd_px=column(f"{tracks}/centroid_sd_px"),
        flag=reader.texts(f"{main}/flag", t),
        names=() if reader.find(f"{main}/name") is None else reader.texts(f"{main}/name", t),
        pressure_MPa=optional("pressure_MPa"),
    )
