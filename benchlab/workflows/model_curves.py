"""A model at work: the base of a design with the model's structure, and the curves that it predicts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import KNOBS, Base, DesignBase, Knob
from benchlab.discrepancy.effects.effect import Active, At
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scene import Scene
from benchlab.errors import InputError
from benchlab.io.files import sha256
from benchlab.io.layup_file import DEFAULT_LAYUP, read_layup
from benchlab.io.model_file import ModelFile, check_source, model_document, read_model
from benchlab.io.simulated_table import read_simulated
from benchlab.simulation.actuator_response import Fixture
from benchlab.simulation.layup import Layup
from benchlab.units import FloatArray
from benchlab.workflows.explain_base import base_pressures, beam_base, cell_base, foreign_base
from benchlab.workflows.explain_structure import CELL_KNOBS

RAMP_S_PER_MPa = 1e9
"""Of the ramp on which curves are predicted: so slow that all that is late has come."""

NOT_AT_REST = {
    "temperature": "warming over a session: the curve is that of a session's start",
    "clock_offset": "the camera's clock: the curve has no time",
    "flex_hysteresis": "the flex sensor's own loop: the curve is the angle as the camera sees it",
}
"""Effects that a curve at rest leaves out, and why."""

ONLY_AT_REST = {
    "viscoelasticity": "creep: the curve is that at rest",
    "regulator_lag": "the regulator's lag: the curve is that at rest",
    "line_resistance": "the line's lag: the curve is that at rest",
    "friction": "the loop of friction: the curve is the way up",
    "softening": "softening by cycles: the curve is the first loading",
    "leakage": "decay with the valve shut: the curve is that while air is fed",
}
"""Effects of which a curve has one branch only."""


@dataclass(frozen=True)
class Model:
    """A model file that was read. path: of it, by which it finds what it rests on."""

    path: Path
    file: ModelFile

    def as_json(self) -> dict[str, Any]:
        """What results say of it: its name, and all that it says."""
        return {"file": self.path.name, **model_document(self.file)}

    @property
    def words(self) -> str:
        """What it is, for captions."""
        names = ", ".join(effect.name for effect in self.file.effects) or "no effect"
        return f"model {self.path.name}: {self.file.base.kind} {Path(self.file.base.source).name} with {names}"


@dataclass(frozen=True)
class Modelled:
    """(P,) each over pressure_MPa: curves of the base alone, and with the effects; by angle_deg, volume_mL, force_N where known.

    notes: what of the model a curve at rest cannot show.
    """

    pressure_MPa: FloatArray
    bare: dict[str, FloatArray]
    curves: dict[str, FloatArray]
    notes: tuple[str, ...]


def open_model(path: Path) -> Model:
    """A model file, and what it rests on checked. Raises UsageError and InputError."""
    model = Model(path, read_model(path))
    check_source(path, model.file)
    return model


def model_provenance(model: Model) -> dict[str, Any]:
    """Which model a result was made with: its name and SHA-256."""
    return {"file": model.path.name, "sha256": sha256(model.path)}


def model_layup(model: Model) -> Layup:
    """The layup of a model, that of `benchlab simulate` where its base is foreign. Raises as `check_source`."""
    source = check_source(model.path, model.file)
    return read_layup(DEFAULT_LAYUP if model.file.base.kind == "foreign" else source)


def model_base(
    model: Model,
    designs: Mapping[str, ShellDesign],
    largest_MPa: float,
    *,
    forces: bool = True,
    fixture: Fixture | None = None,
    jobs: int = 1,
    cache: Path | None = None,
) -> Base:
    """The base of a model up to a pressure, without its effects, with those knobs that they turn; as `benchlab explain` has it.

    Raises UsageError and InputError, also for a design that foreign curves do not have.
    """
    kind, knobs = model.file.base.kind, knobs_of(model.file.actives)
    source, layup, pressures = check_source(model.path, model.file), model_layup(model), base_pressures(largest_MPa)
    make = beam_base if kind == "beam" else cell_base
    if kind != "beam":
        knobs = tuple(knob for knob in knobs if knob in CELL_KNOBS)

    def simulated() -> Base:
        return make(designs, layup, pressures, forces=forces, knobs=knobs, fixture=fixture, jobs=jobs, cache=cache)

    if kind != "foreign":
        return simulated()
    foreign = read_simulated(Path(source))
    if missing := [name for name in designs if name not in foreign]:
        what = f"it has no design {', '.join(missing)}, and the model knows no others"
        raise InputError(what, file=source, hint=f"it has {', '.join(foreign)}")
    curves = {name: foreign[name] for name in designs}
    needed = {quantity for active in model.file.actives for quantity in active.effect.needs}
    lacking = any(not needed <= set(design.curves) for design in curves.values())
    return foreign_base(curves, designs, simulated() if knobs or lacking else None, source=Path(source).name)


def modelled(base: Base, name: str, actives: Sequence[Active], pressures_MPa: Sequence[float]) -> Modelled:
    """What a model predicts for a design of its base, loaded slowly for the first time. pressures_MPa: as recorded, growing.

    The same prediction as `benchlab explain` makes. Raises InputError for pressures beyond the base, and knobs beyond their range.
    """
    if name not in base.designs:
        raise InputError(base.missing.get(name, f"the model's base has no design {name}"), hint="take another design")
    check_range(base, name, actives)
    design = base.designs[name]
    quantities = [each for each in ("angle_deg", "volume_mL", "force_N") if each in design.curves]
    wanted = np.asarray(pressures_MPa, dtype=float)
    scene = slow_ramp(base, name, wanted)
    shown = [active for active in actives if active.name not in NOT_AT_REST]
    first = len(scene.pressure_MPa) - len(wanted)
    bare, with_effects = (predict(scene, some, quantities) for some in ((), shown))
    notes = {**NOT_AT_REST, **ONLY_AT_REST}
    return Modelled(
        wanted,
        {each: values[first:, 0] for each, values in bare.items()},
        {each: values[first:, 0] for each, values in with_effects.items()},
        tuple(f"not shown: {notes[active.name]}" for active in actives if active.name in notes),
    )


def slow_ramp(base: Base, name: str, pressures_MPa: FloatArray) -> Scene:
    """One run of a virgin sample from 0 MPa through these pressures, so slow that it is at rest at each."""
    largest = base.largest_pressure_MPa(name)
    if pressures_MPa[-1] > largest * (1 + 1e-9):
        what = f"{name} is simulated up to {largest:.4g} MPa, and {pressures_MPa[-1]:g} MPa is asked for"
        raise InputError(what, hint=f"ask for pressures up to {largest:.4g} MPa")
    pressure = pressures_MPa if pressures_MPa[0] == 0 else np.concatenate(([0.0], pressures_MPa))
    pressure = pressure[:, None]
    unknown = np.full_like(pressure, np.nan)
    return Scene(
        base=base,
        names=(name,),
        design=np.zeros(1, dtype=np.int64),
        sample=np.zeros(1, dtype=np.int64),
        order=np.full(1, np.nan),
        time_s=pressure * RAMP_S_PER_MPa,
        pressure_MPa=pressure,
        command_MPa=unknown,
        temperature_C=unknown,
        real=np.ones(pressure.shape, dtype=bool),
        start_s=np.full(1, np.nan),
        orientation_deg=np.full(1, np.nan),
    )


def knobs_of(actives: Sequence[Active]) -> tuple[str, ...]:
    """The structural knobs that these effects turn, in the order of KNOBS."""
    scene = slow_ramp(_any_base(), "any", np.linspace(0.0, 0.35, 8))
    turned = {knob for active in actives for knob in _settings(scene, active)}
    return tuple(knob for knob in KNOBS if knob in turned)


def knob_settings(actives: Sequence[Active]) -> dict[str, float]:
    """At which value each structural knob stands with all of these effects together, as `predict` has it; without those that change
    in a run."""
    scene = slow_ramp(_any_base(), "any", np.linspace(0.0, 0.35, 8))
    found: dict[str, float] = {}
    for active in actives:
        for knob, setting in _settings(scene, active).items():
            if np.ptp(setting) == 0:
                value = float(np.ravel(setting)[0])
                before = found.get(knob, KNOBS[knob][0])
                found[knob] = before * value if KNOBS[knob][0] == 1.0 else before + value
    return found


def check_range(base: Base, name: str, actives: Sequence[Active]) -> None:
    """Raises InputError where an effect needs a curve that the base lacks, or a knob farther turned than it was simulated."""
    knobs = base.designs[name].knobs
    for active in actives:
        if lacking := [q for q in active.effect.needs if q not in base.designs[name].curves]:
            what = f"{name} has no {', '.join(lacking)}, which {active.name} needs ({base.source})"
            raise InputError(what, hint="leave the effect out of the model, or give it a base that has it")
    scene = slow_ramp(_any_base(), "any", np.linspace(0.0, 0.35, 8))
    for active in actives:
        for knob, setting in _settings(scene, active).items():
            if knob not in knobs:
                what = f"{name} was not simulated with another {knob}, which {active.name} needs ({base.source})"
                raise InputError(what, hint="leave the effect out of the model")
            low, high = knobs[knob].values[0], knobs[knob].values[-1]
            if not (np.min(setting) >= low - 1e-9 and np.max(setting) <= high + 1e-9):
                turned = np.max(np.abs(setting))
                what = (
                    f"{active.name} sets {knob} to {turned:.3g}, and {name} is simulated from {low:.3g} to {high:.3g}"
                )
                raise InputError(what, hint="take another design, or a smaller effect")


def _settings(scene: Scene, active: Active) -> dict[str, FloatArray | float]:
    at = At(scene, active.values, active.form, scene.pressure_MPa, scene.pressure_MPa)
    return dict(active.effect.knobs(at))


def _any_base() -> Base:
    """A base of one design that knows all knobs, to ask effects which of them they turn."""
    pressure = np.linspace(0.0, 0.35, 8)
    ones = {each: np.ones((2, 8)) for each in ("angle_deg", "volume_mL", "force_N")}
    knobs = {knob: Knob(np.array([0.0, 1.0]), ones) for knob in KNOBS}
    curves = {"angle_deg": 300 * pressure, "volume_mL": 20 + 10 * pressure, "force_N": 100 * pressure}
    design = DesignBase("any", pressure, curves, ShellDesign(10, 3), knobs)
    return Base({"any": design}, "beam", "any")
