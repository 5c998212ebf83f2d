"""clock_offset: the camera's clock runs Δt ahead of the pressure's.

    what is stamped t was taken at t − Δt by the clock of the pressure: θ_seen(t) = θ(t − Δt)

Δt `ahead_s`; negative: behind.
By nature confounded: with a regulator's delay in the angle (volume, force and flex sensor are read by the clock of
the pressure and tell), with regulator_lag where the rates are few.
"""

from __future__ import annotations

from typing import ClassVar

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


class ClockOffset(Effect):
    name: ClassVar[str] = "clock_offset"
    acts_on: ClassVar[str] = "sensor"
    physics: ClassVar[str] = (
        "Film and pressure log are started by hand or by two computers, and a trigger is late by some frames. A "
        "time that is read wrong is a pressure that is read wrong by rate times Δt, with the sign of the "
        "direction."
    )
    looks_like: ClassVar[str] = "a loop that widens with the rate, of either sense: unloading may lie below loading"
    shown_by: ClassVar[str] = "triangles at two rates; a flash or a tap in film and log"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            "ahead_s",
            "s",
            -3.0,
            3.0,
            0.1,
            0.0,
            (-0.4, -0.1, 0.05, 0.15, 0.5),
            "time by which the camera's clock is ahead",
        ),
    )
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg",)

    def cannot_show(self, scene: Scene) -> str:
        return scene.shows_time

    def camera(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return at.scene.delayed(angle_deg, at.values["ahead_s"])
