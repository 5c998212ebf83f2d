"""Effects in time against closed forms: viscoelasticity, lags of regulator and line, clocks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.effects.effect import Active, At
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scene import Scene
from tests.unit.discrepancy.scenes import KINDS, TOP_MPa, scene

EFFECTS = built_in()
RATE_MPa_s = TOP_MPa / 2.5


def inside(name: str, on: Scene, form: str = "plain", **values: float) -> np.ndarray:
    at = At(on, values, form, on.pressure_MPa, on.pressure_MPa)
    return EFFECTS[name].inside(on.pressure_MPa, at)


def angle(name: str, on: Scene, form: str = "plain", **values: float) -> np.ndarray:
    return predict(on, [Active(EFFECTS[name], values, form)])["angle_deg"]


@pytest.mark.parametrize("form", EFFECTS["regulator_lag"].forms)
def test_a_ramp_is_followed_a_lag_behind_in_every_form(form: str) -> None:
    on = scene(("slow",), 1)
    late = inside("regulator_lag", on, form, lag_s=1.0)
    far = (on.time_s > 8) & (on.time_s < 30)
    np.testing.assert_allclose((on.pressure_MPa - late)[far], TOP_MPa / 30 * 1.0, rtol=1e-3)


def test_first_order_lag_of_a_ramp_is_its_closed_form() -> None:
    on = scene(("fast",), 1)
    late, first = inside("regulator_lag", on, lag_s=0.4), on.time_s[:, 0] <= 2.5
    t = on.time_s[first, 0]
    np.testing.assert_allclose(late[first, 0], RATE_MPa_s * (t - 0.4 * (1 - np.exp(-t / 0.4))), atol=1e-12)


def test_second_order_lag_is_two_in_a_row() -> None:
    on = scene(("fast",), 1, points=20)
    row = on.follow(on.follow(on.pressure_MPa, 0.2), 0.1)
    np.testing.assert_allclose(inside("regulator_lag", on, "second order", lag_s=0.3), row, atol=2e-5)


def test_delay_is_the_pressure_of_before() -> None:
    on = scene(("fast",), 1)
    corners_s, corners_MPa, _ = KINDS["fast"]
    expected = np.interp(on.time_s - 0.25, corners_s, corners_MPa)
    np.testing.assert_allclose(inside("regulator_lag", on, "delay", lag_s=0.25), expected, atol=1e-12)


def test_what_lags_is_the_command_where_it_is_known() -> None:
    """A recorded pressure with an offset keeps it; the command's corners make the lag."""
    on = scene(("fast",), 1, command=True)
    shifted = replace(on, pressure_MPa=on.pressure_MPa + 0.02)
    np.testing.assert_allclose(
        inside("regulator_lag", shifted, lag_s=0.2), inside("regulator_lag", on, lag_s=0.2) + 0.02, atol=1e-12
    )
    steps = replace(on, command_MPa=np.full_like(on.pressure_MPa, 0.1))
    np.testing.assert_allclose(
        inside("regulator_lag", steps, lag_s=0.2), on.pressure_MPa, atol=1e-15, err_msg="a command at rest has no lag"
    )
    some = on.command_MPa.copy()
    some[3] = np.nan
    np.testing.assert_allclose(
        inside("regulator_lag", replace(on, command_MPa=some), lag_s=0.2), inside("regulator_lag", on, lag_s=0.2)
    )


def test_the_line_is_that_of_the_integrator() -> None:
    """R·dV/dp·dp/dt = p_reg − p by scipy, for two designs of other dV/dp."""
    on = scene(("fast",), 5)
    resistance = 0.02
    found = inside("line_resistance", on, resistance_MPa_s_per_mL=resistance)
    corners_s, corners_MPa, _ = KINDS["fast"]
    for run, (tw, t) in {0: (3, on.time_s[:, 0]), 4: (15, on.time_s[:, 4])}.items():

        def rate(now: float, p: np.ndarray, tw: float = tw) -> np.ndarray:
            slope = (4 + 0.2 * tw) / 0.15 * np.exp(-np.maximum(p, 0) / 0.15) + 5
            return (np.interp(now, corners_s, corners_MPa) - p) / (resistance * slope)

        truth = solve_ivp(rate, (0, t[-1]), [0.0], t_eval=t, max_step=0.02, rtol=1e-8, atol=1e-9).y[0]
        behind = np.abs(on.pressure_MPa[:, run] - truth).max()
        assert behind > 0.15 * TOP_MPa
        assert np.abs(found[:, run] - truth).max() < 0.03 * behind
    assert np.abs(found[:, 4] - found[:, 0]).max() > 0.05 * TOP_MPa


def test_the_air_inside_lags_alike_on_average_and_otherwise_over_pressure() -> None:
    on = scene(("fast",), 5, points=2)
    plain, air = (inside("line_resistance", on, form, resistance_MPa_s_per_mL=0.01) for form in ("plain", "with air"))
    behind = [float(np.mean(np.abs(on.pressure_MPa - late))) for late in (plain, air)]
    assert behind[1] == pytest.approx(behind[0], rel=0.2)
    assert np.abs(plain - air).max() > 0.01 * TOP_MPa


def test_a_step_creeps_by_the_late_share() -> None:
    """A jump within one reading: 1 − a at once, the rest with exp(−t/τ)."""
    on = scene(("hold",), 1)
    time = np.concatenate([[0.0, 1e-9], np.linspace(0.1, 20, 120)])[:, None]
    pressure = np.where(time < 1e-9, 0.0, 0.3)
    step = replace(
        on,
        time_s=time,
        pressure_MPa=pressure,
        command_MPa=np.full_like(time, np.nan),
        temperature_C=np.full_like(time, np.nan),
        real=np.ones(time.shape, bool),
    )
    full = predict(step, [])["angle_deg"][-1, 0]
    found = angle("viscoelasticity", step, late_share=0.2, time_s=3.0)[1:, 0]
    np.testing.assert_allclose(found, full * (1 - 0.2 * np.exp(-time[1:, 0] / 3.0)), rtol=1e-6)


@pytest.mark.parametrize("form", ["plain", "two times", "log time"])
def test_late_share_is_what_is_missing_at_once_and_time_its_middle(form: str) -> None:
    on = scene(("hold",), 1)
    long = replace(on, time_s=on.time_s * 1000)
    bare = predict(long, [])["angle_deg"]
    quick = angle("viscoelasticity", long, form, late_share=0.2, time_s=0.05)
    assert np.abs(quick - bare).max() < 0.05, "all has come where the run is slow"
    slow = angle("viscoelasticity", replace(on, time_s=on.time_s / 1000), form, late_share=0.2, time_s=200.0)
    np.testing.assert_allclose(slow[1:125], 0.8 * bare[1:125], rtol=0.002)


def test_log_time_creeps_alike_in_each_decade() -> None:
    """In a long hold after a quick rise, from τ/10 to τ and from τ to 10·τ."""
    on = scene(("hold",), 1)
    time = np.concatenate([[0, 1e-3], np.geomspace(1e-2, 1e3, 400)])[:, None]
    pressure = np.where(time < 1e-3, 0.0, 0.3)
    nan = np.full_like(time, np.nan)
    held = replace(
        on, time_s=time, pressure_MPa=pressure, command_MPa=nan, temperature_C=nan, real=np.ones(time.shape, bool)
    )
    found = angle("viscoelasticity", held, "log time", late_share=0.2, time_s=5.0)[:, 0]
    at = np.interp([0.5, 5.0, 50.0], time[:, 0], found)
    assert np.diff(at)[0] == pytest.approx(np.diff(at)[1], rel=0.05)


def test_creep_on_top_starts_from_the_base_and_ends_above() -> None:
    on = scene(("hold",), 1)
    bare = predict(on, [])["angle_deg"]
    found = angle("viscoelasticity", on, "creep on top", late_share=0.1, time_s=0.5)
    held = (on.time_s[:, 0] > 15) & (on.time_s[:, 0] < 25)
    np.testing.assert_allclose(found[held], 1.1 * bare[held], rtol=1e-4)
    assert np.array_equal(found[0], bare[0])


def test_a_camera_clock_ahead_shows_what_was_before() -> None:
    on = scene(("fast",), 1, points=4)
    corners_s, corners_MPa, _ = KINDS["fast"]
    for ahead in (0.2, -0.2):
        early = np.interp(on.time_s - ahead, corners_s, corners_MPa)
        expected = on.curve("angle_deg", early, {})
        found = angle("clock_offset", on, ahead_s=ahead)
        assert np.abs(found - expected).max() < 0.06
    rising = angle("clock_offset", on, ahead_s=0.2)[20, 0]
    assert rising < predict(on, [])["angle_deg"][20, 0], "ahead: while it rises the picture shows less"
