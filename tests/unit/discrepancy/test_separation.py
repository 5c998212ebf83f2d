"""Distances of rivals against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.discrepancy.experiment import Experiment, Hold, Ramp, Triangle
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scene import Scene
from benchlab.discrepancy.separation import Rival, Trial, points
from benchlab.discrepancy.trial import trial_scene
from benchlab.units import FloatArray
from tests.unit.discrepancy.rivals import Caps, Creep, Gain, Shift, of_samples, rival, white
from tests.unit.discrepancy.scenes import base

DESIGNS = ["tw3_slw10", "tw3_slw5"]


def scene_of(*legs: Ramp | Hold | Triangle) -> Scene:
    return trial_scene(Experiment("a", "", legs or (Triangle(0, 0.3, 0.1),)), base(2), DESIGNS)


def test_a_shift_in_white_noise_is_root_n_shifts_away_from_none() -> None:
    scene = scene_of()
    nothing = Rival(())
    found = Trial(scene, [nothing, rival(Shift(), by_deg=0.5)], lambda s: white(s, 2.0)).refitted()
    assert found[0, 1] == found[1, 0] == pytest.approx(np.sqrt(scene.real.sum()) * 0.5 / 2.0)
    assert found[0, 0] == 0


def test_half_the_noise_is_twice_the_distance() -> None:
    rivals = [rival(Shift(), 1e-12, by_deg=2), rival(Gain(), 1e-12, factor=1.05)]
    loud, soft = (Trial(scene_of(), rivals, lambda s, sd=sd: white(s, sd)).linear()[0, 1] for sd in (2.0, 1.0))
    assert soft == pytest.approx(2 * loud, rel=1e-3)


def test_a_gain_hides_in_the_gains_of_samples() -> None:
    """d² = δ²·x/(1 + g²·x), x = Σf²/σ²: Sherman and Morrison; not above (δ/g)² a design however little white noise there is."""

    def noise(scene: Scene) -> FloatArray:
        angle = points(scene, predict(scene, ())["angle_deg"])
        owner = points(scene, np.broadcast_to(scene.design, scene.time_s.shape))
        return white(scene, 0.5) + 0.03**2 * np.outer(angle, angle) * (owner[:, None] == owner[None])

    scene = scene_of()
    share = 1 / 1.05 - 1
    squares = np.array([(predict(scene, ())["angle_deg"][:, d] ** 2).sum() for d in range(2)]) / 0.5**2
    expected = np.sqrt((share**2 * squares / (1 + 0.03**2 * squares)).sum())
    found = Trial(scene, [Rival(()), rival(Gain(), factor=1.05)], noise).linear()[0, 1]
    assert found == pytest.approx(expected, rel=1e-6)
    assert found < np.sqrt(2) * abs(share) / 0.03


def test_two_gains_of_one_length_look_alike_and_not_of_another() -> None:
    rivals = [rival(Caps(), cap_mm=9), rival(Gain(), factor=1 / 0.9)]
    here = Trial(scene_of(), rivals, of_samples).refitted()[0, 1]
    assert here == pytest.approx(0, abs=1e-6)
    short = trial_scene(Experiment("a", "", (Triangle(0, 0.3, 0.1),), length_ratio=0.5), base(2), DESIGNS)
    known = [rival(Caps(), 0.1**2, cap_mm=9), rival(Gain(), 0.001**2, factor=1 / 0.9)]
    assert Trial(short, known, of_samples).refitted()[0, 1] > 4


def test_what_is_known_of_a_parameter_keeps_it_from_looking_like_another() -> None:
    """Shift 0 to 2 at σ_θ: d² = N·2²/(1 + N·σ_θ²), one rival fitted at the other's place."""
    scene = scene_of()
    count = scene.real.sum()

    class Other(Shift):
        name = "other"

    rivals = [rival(Shift(), 0.3**2, by_deg=2), rival(Other(), 0.3**2, by_deg=0)]
    found = Trial(scene, rivals, white)
    expected = np.sqrt(count * 4 / (1 + count * 0.3**2))
    assert found.linear()[0, 1] == pytest.approx(expected, rel=1e-6)
    assert found.refitted()[0, 1] == pytest.approx(expected, rel=1e-6)


def test_refitting_stays_within_the_bounds() -> None:
    class Small(Shift):
        name = "small"

        def angle(self, angle_deg: FloatArray, at: object) -> FloatArray:
            return angle_deg + 0.02 * at.values["by_deg"]  # type: ignore[attr-defined]

    scene = scene_of()
    rivals = [rival(Shift(), 1e-12, by_deg=3), rival(Small(), 1e12, by_deg=0)]
    away = np.sqrt(scene.real.sum()) * (3 - 0.02 * 50)
    assert Trial(scene, rivals, white).refitted()[0, 1] == pytest.approx(away, rel=1e-2)


def test_refitting_finds_what_the_tangent_alone_does_not() -> None:
    """The same effect far from where it was fitted: refitted, the two are one."""

    class Other(Creep):
        name = "other"

    rivals = [rival(Creep(), share=0.1, time_s=5), rival(Other(), share=0.06, time_s=8)]
    trial = Trial(scene_of(Ramp(0.3, 0.6), Hold(20)), rivals, lambda s: white(s, 0.05))
    apart = np.linalg.norm(trial.predicted[0] - trial.predicted[1])
    assert trial.refitted()[0, 1] < 0.05 * apart


def test_one_that_has_all_effects_of_another_is_judged_where_it_is_true() -> None:
    """Otherwise it could always look like the smaller one, and nothing would ever separate them."""
    more = Rival((*rival(Shift(), by_deg=1).actives, *rival(Creep(), share=0.2, time_s=5).actives))
    trial = Trial(scene_of(Ramp(0.3, 0.6), Hold(20)), [rival(Shift(), by_deg=1), more], white)
    assert trial.refitted()[0, 1] > 10


def test_points_are_the_real_ones_run_by_run() -> None:
    scene = scene_of()
    assert points(scene, scene.pressure_MPa) == pytest.approx(np.concatenate(list(scene.pressure_MPa.T)))
