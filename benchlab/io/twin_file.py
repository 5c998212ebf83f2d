"""Twin files: curve, effects, faults, seed and camera of a simulated bench as strict YAML; and the twin that comes with benchlab.

    curve: tw9_slw10.h5          of `benchlab simulate`, beside this file, or tw3_slw10, the shipped one, by name; where it is left out the
                                 shipped one too, or that of `--design`
    model: model.yaml            of `benchlab explain`, in place of `curve`, beside this file: the curve of `design` with the model's
                                 structure, and its effects in place of those of the twin that comes with benchlab
    seed: 7
    effects:
      friction: {half_width_deg_per_MPa: 6}     other parameters keep their typical values
      softening: on                             with typical values
      viscoelasticity: off
    faults:
      burst: {at_s: 3}
    camera: {frames_per_s: 60}

Effects that are not named are as in the twin that comes with benchlab. Names, parameters, bounds: benchlab/twin/effects.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from importlib.resources import as_file, files
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field, create_model

from benchlab.errors import InputError, UsageError
from benchlab.io.response_file import read_response_curves
from benchlab.io.yaml_file import Document, read_document
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.effects.catalogue import EFFECTS, FAULTS
from benchlab.twin.effects.effect import Effect
from benchlab.twin.settings import Camera, TwinSettings, default_effects

SHIPPED_CURVE = "tw3_slw10"
LENGTH_MM = 180.0
CURVE_SUFFIXES = (".h5", ".csv")


def _switched(value: Any) -> Any:
    """`on` is an effect with typical values, `off` is none."""
    if value in ("on", "off"):
        return {} if value == "on" else None
    if not isinstance(value, dict):
        raise ValueError("its parameters, `on` or `off`")
    return value


def _parameters(kind: type[Effect]) -> Any:
    """The type of an effect's entry: its parameters within their bounds, or None where it is off."""
    bounds: dict[str, Any] = {
        each.name: (float, Field(default=each.default, ge=each.metadata["low"], le=each.metadata["high"]))
        for each in dataclasses.fields(kind)
    }
    return Annotated[create_model(f"_{kind.__name__}", __base__=Document, **bounds) | None, BeforeValidator(_switched)]


def _entries(names: list[str]) -> Any:
    entries: dict[str, Any] = {name: (_parameters(EFFECTS[name]), None) for name in names}
    return create_model("_Entries", __base__=Document, **entries)


_Effects: Any = _entries([name for name in EFFECTS if name not in FAULTS])
_Faults: Any = _entries(list(FAULTS))


class _Camera(Document):
    frames_per_s: float = Field(default=Camera.frames_per_s, ge=1, le=1000)
    width_px: int = Field(default=Camera.width_px, ge=320, le=4096)
    height_px: int = Field(default=Camera.height_px, ge=320, le=4096)
    markers: int = Field(default=Camera.markers, ge=3, le=30)


class _Twin(Document):
    curve: str | None = None
    model: str | None = None
    design: str | None = None
    length_mm: float | None = Field(default=None, ge=1, le=10_000)
    seed: int = Field(default=1, ge=0, lt=2**63)
    effects: _Effects = _Effects()
    faults: _Faults = _Faults()
    camera: _Camera = _Camera()


@dataclasses.dataclass(frozen=True)
class NamedModel:
    """The model that a twin file rests on: path of its file, and name or file of the design, None where that is not told."""

    path: Path
    design: str | None


def named_model(path: Path) -> NamedModel | None:
    """The model that a twin file names; None where it names none. Raises UsageError and InputError as `read_twin`."""
    if path.suffix.lower() in CURVE_SUFFIXES:
        return None
    found = read_document(path, _Twin)
    return None if found.model is None else NamedModel(path.parent / found.model, found.design)


def read_twin(path: Path | None, start: TwinSettings | None = None) -> TwinSettings:
    """The twin of a file, or where None the one that comes with benchlab: tw 3 mm, slw 10 mm, typical effects, seed 1.

    A file of `benchlab simulate` (.h5, .csv) is that twin with another curve. start: of a model, whose curve and effects take the place
    of those that come with benchlab; then the file has no curve.
    Raises UsageError and InputError, with the line of everything that is wrong.

    >>> list(read_twin(None).effects)[:3]
    ['dac_steps', 'regulator_lag', 'line_resistance']
    """
    if path is None:
        return start or TwinSettings(shipped_curve(), design=SHIPPED_CURVE)
    if path.suffix.lower() in CURVE_SUFFIXES:
        if start is not None:
            raise UsageError("is a curve, and a model has its own", file=path, hint="leave the file or the model out")
        curve, told = _curve(path)
        return TwinSettings(curve, design=path.stem, length_mm=told.get("length_mm", LENGTH_MM), own_curve=True)
    found = read_document(path, _Twin)
    if start is not None:
        return _of_model(path, found, start)
    if found.model is not None:
        raise InputError("rests on a model, which this command does not read", file=path, hint="use benchlab run")
    if found.curve in (None, SHIPPED_CURVE):
        curve, told = shipped_curve(), {"length_mm": LENGTH_MM}
    else:
        curve, told = _curve(path.parent / found.curve)
    try:
        return TwinSettings(
            curve=curve,
            effects=_effects(found, default_effects()),
            seed=found.seed,
            design=found.design or (SHIPPED_CURVE if found.curve is None else Path(found.curve).stem),
            length_mm=_length_mm(found.length_mm, told.get("length_mm")),
            camera=Camera(**found.camera.model_dump()),
            own_curve=found.curve is not None,
        )
    except InputError as error:
        raise InputError(error.what, file=path, where=error.where, hint=error.hint) from None


def shipped_curve() -> ResponseCurve:
    """The curve of tw 3 mm, slw 10 mm in benchlab/curves: simulated, not measured."""
    with as_file(files("benchlab") / "curves" / f"{SHIPPED_CURVE}.csv") as file:
        return dataclasses.replace(read_curve(file), source=f"{SHIPPED_CURVE}, simulated (benchlab/curves)")


def read_curve(path: Path) -> ResponseCurve:
    """The curve in a file of `benchlab simulate`, HDF5 or table. Rows without an angle are left out. UsageError or InputError."""
    return _curve(path)[0]


def _curve(path: Path) -> tuple[ResponseCurve, dict[str, Any]]:
    """The curve and the design that the file tells, empty where it is a table."""
    curves = read_response_curves(path)
    known = np.isfinite(curves.angle_deg)
    pressure, angle = curves.pressure_MPa[known], curves.angle_deg[known]
    volume, stretch = curves.volume_mL[known], curves.axial_stretch[known]
    stretch = np.where(np.isfinite(stretch), stretch, 1.0)  # a model's curves are without it, and no effect needs it
    try:
        return ResponseCurve(pressure, angle, volume, stretch, source=path.name), curves.about.get("design", {})
    except InputError as error:
        raise InputError(error.what, file=path, hint=error.hint) from None


def _of_model(path: Path, found: Any, start: TwinSettings) -> TwinSettings:
    """The twin of a model with what a file says beside it."""
    if found.curve is not None:
        hint = "leave `curve` or the model out"
        raise InputError("gives a curve, and a model has its own", file=path, where="curve", hint=hint)
    try:
        return dataclasses.replace(
            start,
            effects=_effects(found, start.effects),
            seed=found.seed,
            length_mm=_length_mm(found.length_mm, start.length_mm),
            camera=Camera(**found.camera.model_dump()),
        )
    except InputError as error:
        raise InputError(error.what, file=path, where=error.where, hint=error.hint) from None


def _effects(found: Any, otherwise: Mapping[str, Effect]) -> dict[str, Effect]:
    """Those that the file names, as it says, and the others as they are otherwise."""
    on = dict(otherwise)
    for part in (found.effects, found.faults):
        for name in part.model_fields_set:
            given = getattr(part, name)
            on.pop(name, None)
            if given is not None:
                on[name] = EFFECTS[name](**given.model_dump())
    return {name: on[name] for name in EFFECTS if name in on}


def _length_mm(given: float | None, told: float | None) -> float:
    if given is not None and told is not None and not math.isclose(given, told, rel_tol=1e-9):
        hint = "leave length_mm out, or simulate the curve for this length"
        raise InputError(f"length_mm is {given:g}, and the curve was simulated for {told:g}", hint=hint)
    return given or told or LENGTH_MM
