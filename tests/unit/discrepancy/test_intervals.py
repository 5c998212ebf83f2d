import numpy as np
import pytest
from scipy import stats

from benchlab.discrepancy.fit import fit
from benchlab.discrepancy.intervals import estimates
from tests.unit.discrepancy.drawn import TRUE, active, problem, studies


def test_intervals_of_a_factor_hold_the_truth_as_often_as_they_should() -> None:
    found = [estimates(made, [fit(made, [TRUE])])[0]["factor"] for made in studies()]
    truth = TRUE.values["factor"]
    held = np.mean([one.low <= truth <= one.high for one in found])
    assert 0.88 <= held < 1
    error = np.std([one.value for one in found])
    half = np.median([one.high - one.low for one in found]) / 2 / stats.t.ppf(0.975, studies()[0].freedom)
    assert half == pytest.approx(error, rel=0.25)  # neither too wide


def test_an_interval_ends_at_the_bound_and_says_so() -> None:
    made = problem(1, [active("camera_scale", factor=0.97)], designs=2, protocol=("slow",))
    cap = estimates(made, [fit(made, [active("end_caps")])])[0]["cap_mm"]
    assert (cap.value, cap.low, cap.at_bound, cap.unit) == (0.0, 0.0, True, "mm")
    assert not estimates(made, [fit(made, [TRUE])])[0]["factor"].at_bound


def test_over_several_forms_it_covers_all_of_them_about_the_first_value() -> None:
    made = problem(1, [active("friction", half_width_deg=4)], designs=2, protocol=("slow",))
    fits = [fit(made, [active("friction", form)]) for form in active("friction").effect.forms[:2]]
    alone = [estimates(made, [one])[0]["half_width_deg"] for one in fits]
    both = estimates(made, fits)[0]["half_width_deg"]
    assert both.value == alone[0].value
    assert (both.low, both.high) == (min(one.low for one in alone), max(one.high for one in alone))
    assert alone[0].low != alone[1].low
