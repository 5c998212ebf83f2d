"""One protocol has one rate and one peak in words, whatever blunt turns and noise make of its segments."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.discrepancy.kinds import kinds_of
from benchlab.discrepancy.measured import Run


def run(corners_s: list[float], corners_MPa: list[float], step_s: float = 0.25) -> Run:
    time_s = np.arange(0.0, corners_s[-1] + 1e-9, step_s)
    pressure_MPa = np.interp(time_s, corners_s, corners_MPa)
    return Run("d", "s", "r", time_s, pressure_MPa, {"angle_deg": pressure_MPa})


def test_a_triangle_of_few_readings_has_its_true_peak_and_one_rate_for_all_its_ramps() -> None:
    kinds, _, (cut,) = kinds_of([run([0, 2, 4, 6, 8], [0, 0.36, 0, 0.36, 0])])
    assert {round(one.rate_MPa_s, 4) for one in cut} != {0.18}
    assert kinds[0].words == "to 0.36 MPa at 0.18 MPa/s, loaded 2 times"
    assert {kinds[0].told_rate(one.rate_MPa_s) for one in cut} == {0.18}


def test_rates_that_differ_stay_apart_and_a_hold_has_none() -> None:
    kinds, _, (cut,) = kinds_of([run([0, 30, 50, 53], [0, 0.3, 0.3, 0])])
    assert kinds[0].words == "to 0.3 MPa at 0.01 MPa/s, held 20 s"
    assert kinds[0].rates_MPa_s == pytest.approx((0.01, 0.1), rel=0.02)
    told = {one.direction: kinds[0].told_rate(one.rate_MPa_s) for one in cut}
    assert told["loading"] == 0.01 and told["unloading"] == 0.1 and np.isnan(told["hold"])
