"""Base + effects over a scene: what the bench would have recorded."""

from __future__ import annotations

from collections.abc import Sequence

from benchlab.discrepancy.base import KNOBS
from benchlab.discrepancy.effects.effect import Active, At
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


def predict(
    scene: Scene, actives: Sequence[Active], quantities: Sequence[str] = ("angle_deg",)
) -> dict[str, FloatArray]:
    """(T, R) of each quantity: angle_deg as the camera sees it, volume_mL, force_N, flex_V (here still the angle felt, deg).

    Effects that the base has already come first.
    Effects at one place act in the order given. Moduli of several effects multiply, other knobs add up.
    """
    actives = (*scene.base.given, *actives)
    pressure = scene.pressure_MPa
    for active in actives:
        pressure = active.effect.gauge(pressure, At(scene, active.values, active.form, pressure, pressure))
    for active in actives:
        pressure = active.effect.inside(pressure, At(scene, active.values, active.form, pressure, pressure))
    inside = pressure
    for active in actives:
        pressure = active.effect.load(pressure, At(scene, active.values, active.form, inside, pressure))
    places = [(active.effect, At(scene, active.values, active.form, inside, pressure)) for active in actives]
    knobs: dict[str, FloatArray | float] = {}
    for effect, at in places:
        for name, setting in effect.knobs(at).items():
            multiplies = KNOBS[name][0] == 1.0
            knobs[name] = (
                setting if name not in knobs else knobs[name] * setting if multiplies else knobs[name] + setting
            )
    found: dict[str, FloatArray] = {}
    if "volume_mL" in quantities:
        found["volume_mL"] = scene.curve("volume_mL", pressure, knobs)
    if "force_N" in quantities:
        force = scene.curve("force_N", pressure, knobs)
        for effect, at in places:
            force = effect.force(force, at)
        found["force_N"] = force
    if {"angle_deg", "flex_V"} & set(quantities):
        angle = scene.curve("angle_deg", pressure, knobs)
        for effect, at in places:
            angle = effect.angle(angle, at)
        if "flex_V" in quantities:
            felt = angle
            for effect, at in places:
                felt = effect.flex(felt, at)
            found["flex_V"] = felt
        for effect, at in places:
            angle = effect.camera(angle, at)
        found["angle_deg"] = angle
    return {name: found[name] for name in quantities}
