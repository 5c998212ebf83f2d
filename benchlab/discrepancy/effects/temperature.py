"""temperature: the film is softer when it is warm.

    E → E·(1 − b·ΔT)          ΔT = T − 23 °C, or 10 K·(1 − exp(−t/τ)) (plain)

b `softer_per_K`; T: as measured; where it is not, the bench warms by 10 K (chosen: b is then an equivalent) over the
session, t: time since it began, τ `warming_s`. t is start_s + time_s; without start_s the runs of a sample, in their
order, follow one another without a pause. Where a temperature is given τ does nothing. Through the knob
`film_modulus` where the base has it, else on the angle as θ/(1 − b·ΔT). Forms: `on the angle`: that in any case;
`steady`: ΔT = 10 K·t/(2τ), no more than 10 K, which ends as the plain form does; `cooling`: the bench cools by as much.
By nature confounded: with softening where warming and cycles go together; a rest of the warm bench tells.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

REFERENCE_C = 23.0
"""Of the base: the standard climate of material tests."""

RISE_K = 10.0


class Temperature(Effect):
    name: ClassVar[str] = "temperature"
    acts_on: ClassVar[str] = "material"
    physics: ClassVar[str] = (
        "The modulus of a polyurethane above its glass transition falls with temperature, by about half a percent "
        "a kelvin (chosen). Lamps, valves and the day warm a bench in the course of a session, and the angle at "
        "one pressure drifts upwards."
    )
    looks_like: ClassVar[str] = (
        "later runs bend farther than earlier ones at one pressure, whatever was done in between"
    )
    shown_by: ClassVar[str] = "one protocol at the start and the end of a session, and after a rest, with a thermometer"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "softer_per_K",
            "1/K",
            0.0,
            0.04,
            0.005,
            0.0,
            (0.002, 0.006, 0.02),
            "share of the film's stiffness lost per kelvin",
        ),
        Parameter(
            "warming_s",
            "s",
            20.0,
            20000.0,
            900.0,
            None,
            (100.0, 900.0, 4000.0),
            "time in which the bench warms (63 % of it)",
        ),
    )
    forms: ClassVar[tuple[str, ...]] = ("plain", "on the angle", "steady", "cooling")

    def cannot_show(self, scene: Scene) -> str:
        if np.isfinite(scene.temperature_C).all():
            varies = np.ptp(scene.temperature_C) > 0.5
            return "" if varies else "the temperature was the same throughout"
        if scene.ordered or np.isfinite(scene.start_s).all():
            return ""
        return "neither the temperature, nor when the runs began, nor their order is known"

    def knobs(self, at: At) -> Mapping[str, FloatArray | float]:
        through_film = at.values["softer_per_K"] > 0 and self._through_film(at)
        return {"film_modulus": _stiffness(at)} if through_film else {}

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return angle_deg if self._through_film(at) else angle_deg / _stiffness(at)

    def _through_film(self, at: At) -> bool:
        return at.form != "on the angle" and at.scene.has_knob("film_modulus")


def _stiffness(at: At) -> FloatArray:
    """(T, R): factor on the modulus, not below 0.2."""
    return np.maximum(1 - at.values["softer_per_K"] * _warmer(at), 0.2)


def _warmer(at: At) -> FloatArray:
    """(T, R): ΔT in K."""
    scene, tau = at.scene, at.values["warming_s"]
    since = session_s(scene)
    guessed = np.minimum(since / (2 * tau), 1.0) if at.form == "steady" else -np.expm1(-since / tau)
    rise = -RISE_K if at.form == "cooling" else RISE_K
    return np.where(np.isfinite(scene.temperature_C), scene.temperature_C - REFERENCE_C, rise * guessed)


def session_s(scene: Scene) -> FloatArray:
    """(T, R): time since the session began."""
    began = np.where(np.isfinite(scene.start_s), scene.start_s, scene.sum_before(scene.time_s[-1]))
    return scene.time_s + began
