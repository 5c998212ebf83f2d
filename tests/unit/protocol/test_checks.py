"""What a bench must not be asked for."""

from dataclasses import replace

import numpy as np
import pytest

from benchlab.bench import Bench
from benchlab.errors import InputError
from benchlab.protocol.checks import check_limits
from benchlab.protocol.curvature import AngleHold
from benchlab.protocol.overview import overview
from benchlab.protocol.segments import Hold, Ramp, Sine, Vent
from benchlab.protocol.unroll import unroll

CALIBRATED = Bench("metal", calibrated=True)


def test_a_plan_up_to_the_ceiling_passes() -> None:
    check_limits(
        unroll([Ramp(0.35, duration_s=2.5, line=3), AngleHold(20.0, 1.0), Vent(1.0)], "a", 100.0, 0.35), CALIBRATED
    )


def test_the_worst_step_is_named_with_line_value_limit_and_remedy() -> None:
    plan = unroll([Hold(1.0, 0.31, 4), Hold(1.0, 0.33, 5), Vent(1.0)], "a", 100.0, 0.35)
    with pytest.raises(InputError) as caught:
        check_limits(plan, replace(CALIBRATED, limit_MPa=0.3))
    assert str(caught.value) == (
        "line 5, step 2 (hold 0.33 MPa for 1 s): asks for 0.33 MPa, above 0.3 MPa, the ceiling of the bench metal; "
        "in all, 2 steps of 3 ask for too much; ask for less"
    )
    assert caught.value.exit_code == 3


def test_a_bench_without_a_calibration_is_given_less() -> None:
    plan = unroll([Ramp(0.35, duration_s=2.5)], "a", 100.0, 0.35)
    check_limits(plan, CALIBRATED)
    with pytest.raises(InputError, match=r"asks for 0.35 MPa.*benchlab bench calibrate"):
        check_limits(plan, Bench("new"))


def test_a_peak_between_two_ticks_is_seen() -> None:
    plan = unroll([Hold(1.0, 0.2), Sine(0.2, 0.1, 7.77, 1)], "a", 100.0, 0.35)
    highest_tick = float(plan.pressure_MPa.max())
    assert highest_tick < 0.2999
    with pytest.raises(InputError, match=r"step 2 .* asks for 0.3 MPa"):
        check_limits(plan, replace(CALIBRATED, limit_MPa=(highest_tick + 0.3) / 2))


def test_ticks_that_say_otherwise_than_their_step_are_seen() -> None:
    plan = unroll([Hold(1.0, 0.2), Vent(1.0)], "a", 100.0, 0.35)
    for value, words in ((0.36, r"step 2 .* asks for 0.36 MPa"), (-0.01, "tick 150"), (np.nan, "tick 150")):
        changed = plan.pressure_MPa.copy()
        changed[150] = value
        with pytest.raises(InputError, match=words):
            check_limits(replace(plan, pressure_MPa=changed), CALIBRATED)


def test_an_overview_tells_jumps_from_slopes() -> None:
    plan = unroll([Ramp(0.1, duration_s=1.0), Hold(1.0, 0.3), Vent(1.0), Hold(1.0, 0.05), Vent(1.0)], "a", 100.0, 0.35)
    found = overview(plan)
    assert (found.peak_MPa, found.slew_MPa_per_s) == (0.3, 0.1)
    assert (found.rises, found.largest_rise_MPa, found.falls, found.largest_fall_MPa) == (2, pytest.approx(0.2), 2, 0.3)
    assert [(one.label, one.times, one.jumps_MPa) for one in found.steps if one.kind == "vent"] == [
        ("vent for 1 s", 2, (-0.05, -0.3))
    ]


def test_an_overview_of_closed_loop_has_no_pressure() -> None:
    found = overview(unroll([AngleHold(20.0, 1.0), AngleHold(50.0, 1.0)], "a", 100.0, 0.35))
    assert (found.peak_MPa, found.slew_MPa_per_s, found.reference_deg) == (None, None, (20.0, 50.0))
