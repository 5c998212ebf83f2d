"""Which experiment is chosen: known pairs, each by what is known to separate it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchlab.discrepancy.effects.effect import At
from benchlab.discrepancy.experiment import BenchLimits, Experiment, Triangle
from benchlab.discrepancy.next_experiment import default_proposal, proposal
from benchlab.discrepancy.separation import Trial
from benchlab.discrepancy.trial import trial_scene
from benchlab.units import FloatArray
from tests.pace import cpu_s, slowness
from tests.unit.discrepancy.rivals import Caps, Creep, Gain, Lag, Late, Rub, Weight, of_samples, rival
from tests.unit.discrepancy.scenes import base

DESIGNS = ["tw3_slw10", "tw3_slw5", "tw3_slw20"]


def distance_at(rate_MPa_s: float, first: object, second: object) -> float:
    one = Experiment("a", "", (Triangle(0, 0.35, rate_MPa_s),))
    trial = Trial(trial_scene(one, base(3), DESIGNS), [first, second], of_samples)  # type: ignore[list-item]
    return float(trial.refitted()[0, 1])


def test_a_lag_and_a_clock_are_alike_in_slow_loading_and_not_in_fast() -> None:
    lag, clock = rival(Lag(), lag_s=0.1), rival(Late(), ahead_s=0.1)
    assert distance_at(0.007, lag, clock) < 1
    assert distance_at(0.7, lag, clock) > 20
    told = proposal(base(3), DESIGNS, [lag, clock], of_samples).told
    assert told.experiment is not None and told.expected_sd > 5 and not told.experiment.turned
    fastest = max(leg.rate_MPa_s for leg in told.experiment.legs if hasattr(leg, "rate_MPa_s"))
    assert fastest == 0.7


def test_friction_and_creep_of_one_rate_part_at_another() -> None:
    rub, creep = rival(Rub(), 1e-4, half_width_deg=3), rival(Creep(), 1e-4, share=0.1, time_s=5)
    told = proposal(base(3), DESIGNS, [rub, creep], of_samples).told
    assert told.expected_sd > 20
    assert told.separates == "friction from viscoelasticity"
    assert not told.setup and not told.cannot


def test_end_caps_and_scale_of_the_camera_are_separated_by_a_second_length_alone() -> None:
    caps, scale = rival(Caps(), 0.3**2, cap_mm=18), rival(Gain(), 0.004**2, factor=1.25)
    found = proposal(base(3), DESIGNS, [caps, scale], lambda scene: of_samples(scene, 25))
    assert found.told.experiment is not None and found.told.experiment.length_ratio != 1
    assert "times as long" in found.told.setup
    assert all(one.sd < 0.1 for one in found.considered if one.experiment.length_ratio == 1)
    kept = proposal(base(3), DESIGNS, [caps, scale], of_samples, BenchLimits(other_length=False))
    assert kept.told.experiment is None and kept.told.expected_sd < 0.1
    assert kept.told.cannot.startswith("cannot be separated on this bench: end_caps and camera_scale")
    assert "scale bar" in kept.told.cannot


def test_no_second_length_where_lengths_are_not_known() -> None:
    rivals = [rival(Gain(), factor=1.02), rival(Weight(), sag_deg=0.5)]
    found = proposal(base(3, known=False), DESIGNS, rivals, of_samples)
    assert any(one.experiment.turned for one in found.considered)
    assert all(one.experiment.length_ratio == 1 for one in found.considered)


def test_an_experiment_in_which_a_rival_says_nothing_is_left_out() -> None:
    class Hanging(Weight):
        """Knows the samples as they hang, and nothing else."""

        def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
            return np.where(np.nan_to_num(at.scene.orientation_deg) == 0, angle_deg - at.values["sag_deg"], np.nan)

    rivals = [rival(Hanging(), sag_deg=0.5), rival(Gain(), factor=1.01)]
    found = proposal(base(3), DESIGNS, rivals, of_samples)
    assert found.considered and not any(one.experiment.turned for one in found.considered)


def test_weight_is_shown_by_turning_the_sample() -> None:
    """A sag in one mounting is nearly a gain; turned, it changes its sign and a gain does not."""
    weight, scale = rival(Weight(), 0.05**2, sag_deg=0.4), rival(Gain(), 0.002**2, factor=1.003)
    found = proposal(base(3), DESIGNS, [weight, scale], of_samples)
    plain = max(one.sd for one in found.considered if not one.experiment.turned)
    turned = max(one.sd for one in found.considered if one.experiment.turned)
    assert turned > 2 * plain
    assert found.told.experiment is not None and found.told.experiment.turned
    assert found.told.setup.startswith("run it on each sample mounted at 0° then at ")


def test_of_those_as_good_the_shortest() -> None:
    rub, creep = rival(Rub(), 1e-4, half_width_deg=3), rival(Creep(), 1e-4, share=0.1, time_s=5)
    found = proposal(base(3), DESIGNS, [rub, creep], of_samples)
    best = found.considered[0].worth
    assert found.told.experiment is not None
    chosen = found.told.experiment.sample_s
    assert chosen == min(one.experiment.sample_s for one in found.considered if one.worth >= 0.9 * best)


def test_the_closest_pair_decides() -> None:
    rub, creep = rival(Rub(), half_width_deg=3), rival(Creep(), share=0.1, time_s=5)
    caps, scale = rival(Caps(), cap_mm=18), rival(Gain(), factor=1.25)
    bench = BenchLimits(other_length=False)
    found = proposal(base(3), DESIGNS, [rub, caps, creep, scale], of_samples, bench)
    assert found.told.experiment is None
    assert found.considered[0].pair == (1, 3)
    assert "end_caps and camera_scale" in found.told.cannot


def test_pressures_end_where_the_simulation_ends() -> None:
    rivals = [rival(Lag(), lag_s=0.1), rival(Late(), ahead_s=0.1)]
    found = proposal(base(3), DESIGNS, rivals, of_samples, BenchLimits(pressure_MPa=0.6))
    assert max(one.experiment.trace()[1].max() for one in found.considered) == pytest.approx(0.35)


def test_without_rivals_the_default_says_that_it_was_chosen_for_no_pair() -> None:
    told = proposal(base(3), DESIGNS, [], of_samples).told
    assert told.protocol == "two_rates_hold_cycles" == default_proposal().told.protocol
    assert math.isnan(told.expected_sd) and not told.cannot


def test_four_rivals_take_less_than_five_seconds() -> None:
    rivals = [
        rival(Rub(), half_width_deg=3),
        rival(Creep(), share=0.1, time_s=5),
        rival(Lag(), lag_s=0.2),
        rival(Late(), ahead_s=0.2),
    ]
    found = []
    took_s = cpu_s(lambda: found.append(proposal(base(5), list(base(5).designs), rivals, of_samples)))
    assert len(found[0].considered) >= 10
    assert took_s < 5 * slowness()
