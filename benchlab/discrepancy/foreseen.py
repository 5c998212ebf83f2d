"""How means over samples will scatter in an experiment that has not been made: by the variance components of the data so far."""

from __future__ import annotations

import numpy as np

from benchlab.discrepancy.features import Feature
from benchlab.discrepancy.problem import THINNING, Problem
from benchlab.discrepancy.scatter import NAMES, components_of
from benchlab.discrepancy.scene import Scene
from benchlab.discrepancy.separation import Noise, points
from benchlab.units import FloatArray

READINGS = 10
"""That one point of an experiment will be the mean of (chosen)."""


def foreseen(problem: Problem, samples: int, quantity: str = "angle_deg") -> Noise:
    """Covariance of the mean over so many samples of each design, and of the model's systematic error, at the points of a scene."""
    sizes = np.array([problem.scatter.components[quantity][name] for name in NAMES])

    def noise(scene: Scene) -> FloatArray:
        mean = points(scene, scene.curve(quantity if scene.has(quantity) else "angle_deg", scene.pressure_MPa, {}))
        features = _points_as_features(scene, quantity)
        total = np.zeros((len(mean), len(mean)))
        for design in range(len(scene.names)):
            own = np.array([i for i, feature in enumerate(features) if feature.design == design], dtype=int)
            parts = components_of([features[i] for i in own], mean[own], np.full(len(own), float(READINGS)))
            total[np.ix_(own, own)] = np.tensordot(sizes**2, parts[quantity], 1) / samples
        return total + np.diag(np.full(len(mean), (THINNING * float(np.abs(mean).max())) ** 2 + 1e-12))

    return noise


def _points_as_features(scene: Scene, quantity: str) -> list[Feature]:
    steps = np.sign(np.round(np.diff(scene.pressure_MPa, axis=0, append=scene.pressure_MPa[-1:]), 9))
    columns = (scene.pressure_MPa, scene.time_s, np.maximum(scene.dt_s, 1e-3), steps)
    pressure, time, seconds, way = (points(scene, values) for values in columns)
    run = points(scene, np.broadcast_to(np.arange(len(scene.design)), scene.time_s.shape))
    words = {1: "loading", -1: "unloading", 0: "hold"}
    return [
        Feature(int(scene.design[r]), int(r), 0, quantity, 1, words[int(w)], 0, np.nan, float(p), float(t), float(s))
        for r, p, t, s, w in zip(run, pressure, time, seconds, way)
    ]
