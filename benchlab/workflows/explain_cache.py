"""Simulated curves of earlier explanations, kept on disk: a file a design, layup and set of knobs, found again by a digest of all inputs.

`BENCHLAB_CACHE` names the folder, otherwise it is `explain` in the user's cache of benchlab: `$XDG_CACHE_HOME/benchlab` or
`~/.cache/benchlab`, on macOS `~/Library/Caches/benchlab`, on Windows `%LOCALAPPDATA%\\benchlab\\Cache`. All of it may be deleted.
"""

from __future__ import annotations

import functools
import hashlib
import json
import os
import sys
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import asdict, replace
from importlib.resources import files
from pathlib import Path

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import DesignBase, Knob
from benchlab.errors import BenchlabError
from benchlab.io.files import written_whole
from benchlab.io.layup_file import layup_document
from benchlab.units import FloatArray
from benchlab.workflows.explain_curves import Solved, Wanted
from benchlab.workflows.explain_structure import knob_values
from benchlab.workflows.simulated import code_digest

_DAMAGED = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error)


def default_cache(environment: Mapping[str, str] = os.environ, platform: str = sys.platform) -> Path:
    """The folder in which curves are kept.

    >>> default_cache({"BENCHLAB_CACHE": "kept"}).as_posix()
    'kept'
    """
    if named := environment.get("BENCHLAB_CACHE"):
        return Path(named).expanduser()
    if platform == "win32" and (local := environment.get("LOCALAPPDATA")):
        return Path(local) / "benchlab" / "Cache" / "explain"
    home = "~/Library/Caches" if platform == "darwin" else environment.get("XDG_CACHE_HOME") or "~/.cache"
    return Path(home).expanduser() / "benchlab" / "explain"


def key_of(design: ShellDesign, wanted: Wanted) -> str:
    """One number for all that the curves follow from: design but for its length, layup, pressures, fixture, knobs and the code that
    computes them."""
    document = layup_document(wanted.layup)
    whole = {
        "kind": wanted.kind,
        "design": {name: value for name, value in asdict(design).items() if name != "length_mm"},
        "layup": {name: value for name, value in document.items() if name not in ("name", "origin")},
        "pressures_MPa": wanted.pressures_MPa,
        "fixture": asdict(wanted.fixture),
        "forces": wanted.forces,
        "knobs": {knob: knob_values(knob, design, wanted.layup) for knob in wanted.knobs},
        "code": [code_digest(), _own_digest()],
    }
    return hashlib.sha256(json.dumps(whole, sort_keys=True).encode()).hexdigest()


def read_cached(folder: Path, name: str, design: ShellDesign, wanted: Wanted) -> tuple[Solved | None, str]:
    """Curves that were kept, and why there are none: empty where nothing was kept, or what is wrong with the file."""
    path = _path(folder, key_of(design, wanted))
    if not path.is_file():
        return None, ""
    try:
        with np.load(path, allow_pickle=False) as kept:
            arrays = {each: kept[each] for each in kept.files}
        return _solved(arrays, name, design, wanted, path.stem), ""
    except _DAMAGED as error:
        return None, f"{path}: damaged or not of benchlab, simulated anew and rewritten ({type(error).__name__})"


def write_cached(folder: Path, design: ShellDesign, wanted: Wanted, solved: Solved) -> str:
    """Keep curves, whole or not at all, also while others write the same. Returns why they were not kept, empty where they were."""
    key, found = key_of(design, wanted), solved.design
    arrays: dict[str, np.ndarray] = {"key": np.array(key), "pressure_MPa": found.pressure_MPa}
    arrays |= {f"curve:{q}": curve for q, curve in found.curves.items()}
    for knob, table in found.knobs.items():
        arrays |= {f"values:{knob}": table.values}
        arrays |= {f"factor:{knob}:{q}": factor for q, factor in table.factor.items()}
    named = [note.removeprefix(f"{found.name}: ") for note in solved.notes]
    arrays["length_mm"] = np.array(design.length_mm)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with written_whole(_path(folder, key)) as path:
            np.savez_compressed(path, allow_pickle=False, **arrays, notes=np.array(named, dtype=np.str_))
    except (OSError, BenchlabError) as error:
        return f"{folder}: curves are not kept there ({error})"
    return ""


def _solved(arrays: dict[str, np.ndarray], name: str, design: ShellDesign, wanted: Wanted, key: str) -> Solved:
    """Raises ValueError or KeyError where the arrays are not what was written under this key."""
    if str(arrays["key"]) != key:
        raise ValueError("another key")
    pressure = _finite(arrays["pressure_MPa"])
    curves = {
        each.split(":")[1]: _finite(array, pressure.shape)
        for each, array in arrays.items()
        if each.startswith("curve:")
    }
    knobs = {}
    for knob in wanted.knobs:
        if f"values:{knob}" in arrays:
            values = _finite(arrays[f"values:{knob}"])
            shape = (len(values), len(pressure))
            knobs[knob] = Knob(
                values, {q: _finite(arrays[f"factor:{knob}:{q}"], shape) for q in curves if q != "stiffness_Nmm2"}
            )
    notes = tuple(f"{name}: {note}" for note in arrays["notes"].tolist())
    if not {"angle_deg", "volume_mL", "stiffness_Nmm2"} <= set(curves):
        raise KeyError("curves")
    was = replace(design, length_mm=float(_finite(arrays["length_mm"], ())))
    return Solved(DesignBase(name, pressure, curves, was, knobs), notes).called(name, design)


def _finite(array: np.ndarray, shape: tuple[int, ...] | None = None) -> FloatArray:
    if array.dtype != np.float64 or not np.isfinite(array).all() or (shape is not None and array.shape != shape):
        raise ValueError("not what was written")
    return array


def _path(folder: Path, key: str) -> Path:
    return folder / f"{key}.npz"


@functools.cache
def _own_digest() -> str:
    """Of the code between the simulation and these files."""
    names = ("explain_cache.py", "explain_curves.py", "explain_structure.py")
    return hashlib.sha256(
        b"\0".join((files("benchlab") / "workflows" / name).read_bytes() for name in names)
    ).hexdigest()
