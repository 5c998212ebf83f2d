"""Small effects and a noise in closed form, for tests of experiments: what they must do does not depend on the vocabulary."""

from __future__ import annotations

import numpy as np

from benchlab.discrepancy.effects.effect import Active, At, Effect, Parameter
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scene import Scene
from benchlab.discrepancy.separation import Rival, points
from benchlab.units import FloatArray


def number(name: str, low: float, high: float, neutral: float | None = 0.0) -> Parameter:
    return Parameter(name, "", low, high, low, neutral, (low,), "")


class Shift(Effect):
    name, shown_by = "shift", "a straight sample"
    parameters = (number("by_deg", -50, 50),)

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return angle_deg + at.values["by_deg"]


class Gain(Effect):
    name, shown_by = "camera_scale", "a scale bar"
    parameters = (number("factor", 0.5, 2, 1.0),)

    def camera(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return angle_deg / at.values["factor"]


class Caps(Effect):
    name, shown_by = "end_caps", "another length"
    parameters = (number("cap_mm", 0, 40),)

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return angle_deg * (1 - 2 * at.values["cap_mm"] / at.scene.length_mm)


class Weight(Effect):
    name, shown_by = "gravity", "another mounting"
    parameters = (number("sag_deg", 0, 30),)

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        mount = np.radians(np.nan_to_num(at.scene.orientation_deg))
        return angle_deg - at.values["sag_deg"] * np.sin(mount + np.radians(angle_deg) / 2)


class Lag(Effect):
    name, shown_by = "regulator_lag", "a step"
    parameters = (number("lag_s", 0, 2),)

    def inside(self, pressure_MPa: FloatArray, at: At) -> FloatArray:
        return at.scene.follow(pressure_MPa, at.values["lag_s"])


class Late(Effect):
    name, shown_by = "clock_offset", "a lamp"
    parameters = (number("ahead_s", -2, 2),)

    def camera(self, angle_deg: FloatArray, at: At) -> FloatArray:
        time = at.scene.time_s
        columns = [
            np.interp(time[:, run] - at.values["ahead_s"], time[:, run], angle_deg[:, run])
            for run in range(angle_deg.shape[1])
        ]
        return np.stack(columns, axis=1)


class Rub(Effect):
    name, shown_by = "friction", "a slow loop"
    parameters = (number("half_width_deg", 0, 20),)

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        return at.scene.play(angle_deg, at.values["half_width_deg"] * at.inside_MPa / 0.35)


class Creep(Effect):
    name, shown_by = "viscoelasticity", "a hold"
    parameters = (number("share", 0, 0.5), number("time_s", 0.05, 100, None))

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        share = at.values["share"]
        return (1 - share) * angle_deg + share * at.scene.follow(angle_deg, at.values["time_s"])


def rival(effect: Effect, covariance: float | None = None, **values: float) -> Rival:
    """covariance: the same variance for each parameter."""
    known = None if covariance is None else np.eye(len(values)) * covariance
    return Rival((Active(effect, values),), known)


def white(scene: Scene, sd_deg: float = 1.0) -> FloatArray:
    return np.eye(int(scene.real.sum())) * sd_deg**2


def of_samples(scene: Scene, samples: int = 5) -> FloatArray:
    """Of the mean over samples: gain 3 % and shift 0.2° of a sample, a drift of 0.3° over some seconds of a run, and 0.2° of a point."""
    angle = points(scene, predict(scene, ())["angle_deg"])
    time_s = points(scene, scene.time_s)
    run = points(scene, np.broadcast_to(np.arange(len(scene.design)), scene.time_s.shape))
    sample = points(scene, np.broadcast_to(scene.sample, scene.time_s.shape))
    alike = sample[:, None] == sample[None]
    drift = 0.3**2 * (run[:, None] == run[None]) * np.exp(-np.abs(time_s[:, None] - time_s[None]) / 2)
    return np.asarray(
        (alike * (0.03**2 * np.outer(angle, angle) + 0.2**2) + drift + 0.2**2 * np.eye(len(angle))) / samples
    )
