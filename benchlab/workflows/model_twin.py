"""A twin of a model: what is at rest becomes its response curve, what goes with time or direction its effects of the same name.

The vocabulary of discrepancies and the twin's effects are two rooms that do not see each other, with parameters of their own; here is the
one table of how the former become the latter. The twin keeps its electronics (steps of the DAC, noise of the sensors), and has no other
effect than the model's.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import Base
from benchlab.discrepancy.effects.effect import Active
from benchlab.errors import InputError
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.effects.camera_scale import CameraScale
from benchlab.twin.effects.catalogue import EFFECTS
from benchlab.twin.effects.clock_offset import ClockOffset
from benchlab.twin.effects.dac_steps import DacSteps
from benchlab.twin.effects.effect import Effect
from benchlab.twin.effects.flex_hysteresis import FlexHysteresis
from benchlab.twin.effects.friction import Friction
from benchlab.twin.effects.leakage import Leakage
from benchlab.twin.effects.line_resistance import LineResistance
from benchlab.twin.effects.marker_offset import MarkerOffset
from benchlab.twin.effects.pressure_gain import PressureGain
from benchlab.twin.effects.pressure_offset import PressureOffset
from benchlab.twin.effects.regulator_lag import RegulatorLag
from benchlab.twin.effects.sensor_noise import SensorNoise
from benchlab.twin.effects.softening import Softening
from benchlab.twin.effects.temperature import Temperature
from benchlab.twin.effects.viscoelasticity import Viscoelasticity
from benchlab.twin.settings import TwinSettings
from benchlab.units import FloatArray
from benchlab.workflows.model_curves import Model, model_base, model_provenance, modelled, slow_ramp
from benchlab.workflows.run_curve import PRESSURES_MPa

ELECTRONICS: tuple[type[Effect], ...] = (DacSteps, SensorNoise)
"""Of the twin's bench, whatever its actuator is."""

REFERENCE_MPa = 0.35
"""At which the model tells the width of a loop and the share of a leak."""

SLOWEST_DECAY_S = 1e6
SESSION_K = 10.0
"""Warming over a session that the model has where no temperature is given."""

PARABOLA = 1.5
"""Softening grows as d·(1 − x²) in the model, x = u/m, as s·(1 − x) in the twin: s/d at which both, times u, are closest,
∫ x²·(1 − x²)·(1 − x) dx / ∫ x²·(1 − x)² dx from 0 to 1."""


@dataclass(frozen=True)
class ModelTwin:
    """A twin; by name of an effect what of its model it has in another form, or not at all; and which model file it is of."""

    settings: TwinSettings
    notes: Mapping[str, str]
    about: dict[str, Any]

    def notes_for(self, twin: TwinSettings | None) -> tuple[str, ...]:
        """What is to be told of a twin, whose file may switch effects off or have its own; nothing of another bench."""
        if twin is None:
            return ()
        kept = {name for name, effect in self.settings.effects.items() if twin.effects.get(name) == effect}
        return tuple(note for name, note in self.notes.items() if name in kept or name not in EFFECTS)


def model_twin(
    model: Model, design: ShellDesign, pressures_MPa: Sequence[float] = PRESSURES_MPa, cache: Path | None = None
) -> ModelTwin:
    """The twin of a design as a model has it. pressures_MPa: of its response curve, from 0. UsageError, InputError as `model_base`."""
    base = model_base(model, {design.name: design}, pressures_MPa[-1], forces=False, cache=cache)
    if design.name not in base.designs:
        raise InputError(base.missing[design.name], hint="take another design")
    actives = model.file.actives
    largest = base.largest_pressure_MPa(design.name)
    reached = [pressure for pressure in pressures_MPa if pressure <= largest * (1 + 1e-9)]
    found = modelled(base, design.name, [active for active in actives if at_rest(active)], reached)
    if "volume_mL" not in found.curves:
        raise InputError(
            f"the model knows no volume of {design.name}, and a twin needs one", hint="give volume_mL in its curves"
        )
    effects, notes = twin_effects(actives, base, design.name)
    curve = ResponseCurve(
        found.pressure_MPa,
        found.curves["angle_deg"],
        np.maximum.accumulate(found.curves["volume_mL"]),
        np.ones(len(reached)),
        f"{design.name}, simulated with {model.words}",
    )
    settings = TwinSettings(curve, effects, design=design.name, length_mm=design.length_mm, own_curve=True)
    return ModelTwin(settings, notes, model_provenance(model))


def at_rest(active: Active) -> bool:
    """Whether an effect is in the twin's response curve: all that is not a twin's effect of its own, or is none on a slow way up."""
    if active.name == "leakage":
        return active.form != "plain"
    return active.name not in {*_TABLE, *_NOT_IN_A_TWIN} or active.name in _ALSO_AT_REST


def twin_effects(actives: Sequence[Active], base: Base, design: str) -> tuple[Mapping[str, Effect], dict[str, str]]:
    """The twin's effects of a model, with its electronics, by name; and by name what is otherwise in the twin, in words."""
    effects: dict[str, Effect] = {kind.name: kind() for kind in ELECTRONICS}
    notes = {}
    for active in actives:
        if active.name in _TABLE:
            try:
                effects[active.name] = _TABLE[active.name](active, base, design)
            except InputError as error:
                raise InputError(
                    f"the twin cannot have {active.name} as the model has it: {error.what}", hint=error.hint
                ) from None
            if active.form not in _SAME.get(active.name, ("plain",)):
                notes[active.name] = (
                    f"{active.name} ({active.form}) is in the twin in its own form: {_OWN_FORM[active.name]}"
                )
        elif active.name in _NOT_IN_A_TWIN:
            notes[active.name] = f"{active.name} is not in the twin: {_NOT_IN_A_TWIN[active.name]}"
    return MappingProxyType({name: effects[name] for name in EFFECTS if name in effects}), notes


def _viscoelasticity(active: Active, base: Base, design: str) -> Effect:
    late, time = active.values["late_share"], active.values["time_s"]
    if active.form == "creep on top":  # whose curve at rest is larger by 1 + a
        late = late / (1 + late)
    if active.form in ("two times", "log time"):
        apart = 10**0.5 if active.form == "two times" else 10.0
        return Viscoelasticity(late / 2, time / apart, late / 2, time * apart)
    return Viscoelasticity(late, time, 0.0, time)


def _friction(active: Active, base: Base, design: str) -> Effect:
    half, grows = active.values["half_width_deg"], active.values["grows"]
    return Friction(half * (1 - grows), half * grows / REFERENCE_MPa)


def _softening(active: Active, base: Base, design: str) -> Effect:
    lost, cycles = active.values["softer"], active.values["cycles"]
    farther = _angle_ratio(base, design, 1 - lost) - 1
    if active.form == "plain":
        return Softening(PARABOLA * farther, 0.0, max(cycles, 0.1))
    if active.form == "largest so far":  # the way up is in the curve
        return Softening(farther, 0.0, max(cycles, 0.1))
    if active.form == "run in":  # the first loading, which is stiffer, is in the curve
        farther = 1 / _angle_ratio(base, design, 1 + lost) - 1
    return Softening(0.0, farther, max(cycles, 0.1))


def _leakage(active: Active, base: Base, design: str) -> Effect:
    fall = active.values["fall_per_min"]
    decay = min(60 / fall, SLOWEST_DECAY_S) if fall > 0 else SLOWEST_DECAY_S
    return Leakage(active.values["share"] if active.form == "plain" else 0.0, decay)


def _temperature(active: Active, base: Base, design: str) -> Effect:
    farther = _angle_ratio(base, design, 1 - active.values["softer_per_K"] * SESSION_K) - 1
    return Temperature(farther / SESSION_K, SESSION_K, active.values["warming_s"])


def _flex(active: Active, base: Base, design: str) -> Effect:
    return FlexHysteresis(active.values["half_width_deg"], active.values["drift_deg_per_min"])


_TABLE: dict[str, Callable[[Active, Base, str], Effect]] = {
    "viscoelasticity": _viscoelasticity,
    "friction": _friction,
    "softening": _softening,
    "leakage": _leakage,
    "temperature": _temperature,
    "flex_hysteresis": _flex,
    "regulator_lag": lambda active, base, design: RegulatorLag(active.values["lag_s"], 0.0),
    "line_resistance": lambda active, base, design: LineResistance(active.values["resistance_MPa_s_per_mL"]),
    "pressure_gain": lambda active, base, design: PressureGain(active.values["gain"]),
    "pressure_offset": lambda active, base, design: PressureOffset(active.values["offset_MPa"]),
    "camera_scale": lambda active, base, design: CameraScale(active.values["factor"]),
    "marker_offset": lambda active, base, design: MarkerOffset(active.values["distance_mm"]),
    "clock_offset": lambda active, base, design: ClockOffset(active.values["ahead_s"]),
}
"""How effects of the vocabulary become the twin's."""

_ALSO_AT_REST = ("viscoelasticity", "softening")
"""Of those, what some forms change on a slow way up already; the twin's effect is what comes beside it."""

_SAME: dict[str, tuple[str, ...]] = {
    "viscoelasticity": ("plain", "two times", "creep on top"),
    "friction": ("spread",),
    "softening": ("cycle by cycle", "run in"),
    "leakage": ("plain", "orifice"),
}
"""Forms that the twin has too; `plain` where nothing stands here."""

_OWN_FORM = {
    "viscoelasticity": "two times, τ/10 and 10·τ",
    "friction": "three plays of half, one and one and a half times the width",
    "softening": "at once, by a share in proportion to the way below the largest angle",
    "temperature": "as the angle's growth, exponentially",
    "regulator_lag": "one lag",
    "line_resistance": "dV/dp alone",
}

_NOT_IN_A_TWIN = {
    "camera_tilt": "its camera looks square at the plane of bending",
    "frame_compliance": "it presses on no load frame",
}


def _angle_ratio(base: Base, design: str, film_modulus: float) -> float:
    """How much farther the design bends at its largest pressure with the film's modulus times this; 1/modulus where it is not simulated."""
    scene = slow_ramp(base, design, np.array([base.largest_pressure_MPa(design)]))
    if not scene.has_knob("film_modulus"):
        return 1 / film_modulus
    angles: list[FloatArray] = [
        scene.curve("angle_deg", scene.pressure_MPa, {"film_modulus": setting})[-1] for setting in (film_modulus, 1.0)
    ]
    return float(angles[0][0] / angles[1][0])
