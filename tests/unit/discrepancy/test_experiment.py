"""Experiments as data: their traces against closed forms, and what the bench allows."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchlab.discrepancy.experiment import BenchLimits, Experiment, Hold, Ramp, Triangle
from benchlab.discrepancy.experiments import default_experiment, family
from benchlab.discrepancy.trial import of_length, trial_scene
from tests.unit.discrepancy.scenes import base


def test_a_trace_goes_at_its_rates_and_takes_the_time_that_they_take() -> None:
    one = Experiment("a", "", (Ramp(0.3, 0.1), Hold(5), Ramp(0.0, 0.3), Triangle(0, 0.2, 0.1, 2)))
    time_s, pressure = one.trace()
    assert time_s[0] == pressure[0] == 0
    assert (np.diff(time_s) > 0).all()
    assert one.run_s == pytest.approx(3 + 5 + 1 + 2 * 4)
    slopes = np.abs(np.diff(pressure) / np.diff(time_s))
    assert {round(float(slope), 6) for slope in slopes} == {0.0, 0.1, 0.3}
    assert np.interp([3, 8, 9, 11, 13], time_s, pressure) == pytest.approx([0.3, 0.3, 0, 0.2, 0])


def test_the_time_of_a_sample_has_the_rests_between_runs() -> None:
    one = Experiment("a", "", (Hold(10),), mountings_deg=(math.nan,) * 3, rest_s=20)
    assert one.sample_s == 3 * 10 + 2 * 20
    assert one.setup == "run it 3 times on each sample; vent each sample for 20 s between its runs"


@pytest.mark.parametrize("limits", [BenchLimits(), BenchLimits(pressure_MPa=0.2, rate_MPa_s=0.1, sample_s=120)])
def test_the_family_stays_within_the_bench(limits: BenchLimits) -> None:
    experiments = family(limits)
    assert len(experiments) >= 8
    assert len({each.name for each in experiments}) == len(experiments)
    for each in (*experiments, default_experiment(limits)):
        time_s, pressure = each.trace()
        assert pressure.min() >= 0 and pressure.max() <= limits.pressure_MPa + 1e-12
        assert np.abs(np.diff(pressure) / np.diff(time_s)).max() <= limits.rate_MPa_s + 1e-9
        assert pressure[-1] == 0
    assert all(each.sample_s <= limits.sample_s for each in experiments)


def test_the_family_goes_over_two_decades_of_rate() -> None:
    (rates,) = (each for each in family(BenchLimits()) if each.name == "rates")
    used = [leg.rate_MPa_s for leg in rates.legs if isinstance(leg, Triangle)]
    assert max(used) / min(used) == pytest.approx(100)


def test_what_a_bench_cannot_is_not_asked_for() -> None:
    experiments = family(BenchLimits(can_turn=False, other_length=False))
    assert not any(each.turned or each.length_ratio != 1 for each in experiments)


def test_a_trial_has_each_design_once_for_each_run_in_order() -> None:
    one = Experiment("a", "", (Triangle(0, 0.3, 0.1),), mountings_deg=(0.0, 90.0), rest_s=5)
    scene = trial_scene(one, base(2), ["tw3_slw10", "tw3_slw5"])
    assert scene.design.tolist() == scene.sample.tolist() == [0, 0, 1, 1]
    assert scene.order.tolist() == [0, 1, 0, 1]
    assert scene.orientation_deg.tolist() == [0, 90, 0, 90]
    assert scene.start_s.tolist() == [0, 11, 0, 11]
    assert np.isnan(trial_scene(Experiment("a", "", (Hold(1),)), base(1), ["tw3_slw10"]).order).all()


def test_an_actuator_twice_as_long_bends_twice_as_far() -> None:
    longer = of_length(base(1), ["tw3_slw10"], 2.0).designs["tw3_slw10"]
    shorter = base(1).designs["tw3_slw10"]
    assert longer.shape is not None and longer.shape.length_mm == 360
    assert longer.curves["angle_deg"] == pytest.approx(2 * shorter.curves["angle_deg"])
    assert "force_N" not in longer.curves
