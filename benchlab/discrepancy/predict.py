"""Base + effects over a scene: what the bench would have recorded."""

from __future__ import annotations

from collections.abc import Sequence

from benchlab.discrepancy.base import KNOBS
from benchlab.discrepancy.effects.effect import Active, At, Effect
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


def predict(
    scene: Scene, actives: Sequence[Active], quantities: Sequence[str] = ("angle_deg",)
) -> dict[str, FloatArray]:
    """(T, R) of each quantity: angle_deg as the camera sees it, volume_mL, force_N, flex_V (here still the angle felt, deg).

    Effects that the base has already come first.
    Effects at one place act in the order given. Moduli of several effects multiply, other knobs add up.
    """
    pressure, places = _inside((*scene.base.given, *actives), scene)
    knobs = _knobs(places)
    found: dict[str, FloatArray] = {}
    if "volume_mL" in quantities:
        found["volume_mL"] = scene.curve("volume_mL", pressure, knobs)
    if "force_N" in quantities:
        found["force_N"] = scene.curve("force_N", pressure, knobs)
        for effect, at in places:
            found["force_N"] = effect.force(found["force_N"], at)
    if {"angle_deg", "flex_V"} & set(quantities):
        true = scene.curve("angle_deg", pressure, knobs)
        for effect, at in places:
            true = effect.angle(true, at)
        found["angle_deg"] = found["flex_V"] = true
        for effect, at in places:
            found["angle_deg"] = effect.camera(found["angle_deg"], at)
            found["flex_V"] = effect.flex(found["flex_V"], at)
    return {name: found[name] for name in quantities}


def _inside(actives: Sequence[Active], scene: Scene) -> tuple[FloatArray, list[tuple[Effect, At]]]:
    """The pressure that bends, and each effect with where it is asked from there on."""
    pressure = scene.pressure_MPa
    for active in actives:
        pressure = active.effect.gauge(pressure, At(scene, active.values, active.form, pressure, pressure))
    for active in actives:
        pressure = active.effect.inside(pressure, At(scene, active.values, active.form, pressure, pressure))
    inside = pressure
    for active in actives:
        pressure = active.effect.load(pressure, At(scene, active.values, active.form, inside, pressure))
    return pressure, [(active.effect, At(scene, active.values, active.form, inside, pressure)) for active in actives]


def _knobs(places: Sequence[tuple[Effect, At]]) -> dict[str, FloatArray | float]:
    """The settings that the effects give together."""
    knobs: dict[str, FloatArray | float] = {}
    for effect, at in places:
        for name, setting in effect.knobs(at).items():
            if name not in knobs:
                knobs[name] = setting
            else:
                knobs[name] = knobs[name] * setting if KNOBS[name][0] == 1.0 else knobs[name] + setting
    return knobs
