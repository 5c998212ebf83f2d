"""Effects without a memory, against closed forms: sensors, camera, ends, dead pressure, weight, leaks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import least_squares, minimize_scalar

from benchlab.discrepancy.base import DesignBase
from benchlab.discrepancy.effects.camera_tilt import seen_over_true
from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.effects.effect import Active, At
from benchlab.discrepancy.effects.gravity import torque
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scene import Scene
from tests.unit.discrepancy.scenes import base, scene

EFFECTS = built_in()


def predicted(name: str, on: Scene, form: str = "plain", quantity: str = "angle_deg", **values: float) -> np.ndarray:
    return predict(on, [Active(EFFECTS[name], values, form)], (quantity,))[quantity]


def bare(on: Scene, quantity: str = "angle_deg") -> np.ndarray:
    return predict(on, [], (quantity,))[quantity]


def test_a_gauge_that_reads_too_much_had_less_pressure() -> None:
    on = scene(("slow",), 2)
    for quantity in ("angle_deg", "volume_mL", "force_N"):
        gain = predicted("pressure_gain", on, quantity=quantity, gain=1.25)
        np.testing.assert_allclose(gain, on.curve(quantity, on.pressure_MPa / 1.25, {}))
        offset = predicted("pressure_offset", on, quantity=quantity, offset_MPa=0.01)
        np.testing.assert_allclose(offset, on.curve(quantity, on.pressure_MPa - 0.01, {}))


def test_scale_and_ends_are_factors() -> None:
    on = scene(("slow",), 2)
    np.testing.assert_allclose(predicted("camera_scale", on, factor=1.05), bare(on) / 1.05)
    np.testing.assert_allclose(predicted("end_caps", on, cap_mm=9.0), bare(on) * 0.9)  # 2·9 of 180 mm


def test_markers_outside_see_an_arc_of_larger_radius() -> None:
    on = scene(("slow",), 2)
    bent = slice(1, 120)
    radius = 180.0 / np.radians(bare(on)[bent]) + 6.0
    np.testing.assert_allclose(predicted("marker_offset", on, distance_mm=6.0)[bent], np.degrees(180.0 / radius))


@pytest.mark.parametrize("form", EFFECTS["dead_pressure"].forms)
def test_far_above_the_dead_pressure_that_much_is_missing_in_every_form(form: str) -> None:
    on = scene(("slow",), 1)
    at = At(on, {"dead_MPa": 0.02}, form, on.pressure_MPa, on.pressure_MPa)
    left = EFFECTS["dead_pressure"].load(on.pressure_MPa, at)
    high, low = on.pressure_MPa > 0.2, on.pressure_MPa < 0.02
    np.testing.assert_allclose((on.pressure_MPa - left)[high], 0.02, atol=2e-4)
    assert np.all(left[low] < 0.4 * 0.02 + 1e-12)
    assert left[0] == 0
    assert np.all(np.diff(left[:61, 0]) >= 0)


@pytest.mark.parametrize("form", EFFECTS["dead_pressure"].forms)
def test_pressures_below_zero_pass_the_dead_pressure(form: str) -> None:
    on = scene(("slow",), 1)
    at = At(on, {"dead_MPa": 0.02}, form, on.pressure_MPa, on.pressure_MPa)
    below = np.full_like(on.pressure_MPa, -0.003)
    np.testing.assert_allclose(EFFECTS["dead_pressure"].load(below, at), below)


@pytest.mark.parametrize("angle", [3.0, 11.0, 12.0, 60.0, 130.0, 250.0])
@pytest.mark.parametrize("mount", [0.0, 90.0, -90.0, 180.0, 35.0])
def test_torque_of_the_weight_is_that_of_the_potential(angle: float, mount: float) -> None:
    """∂V/∂θ by differences of the height of the arc's middle, by quadrature; W = al = 1."""

    def potential(theta: float) -> float:
        def height(s: float) -> float:
            return quad(lambda r: -np.cos(np.radians(mount) + theta * r), 0, s)[0]

        return quad(height, 0, 1)[0]

    step = 1e-3
    at = np.radians(angle)
    slope = (potential(at + step) - potential(at - step)) / (2 * step)
    assert float(torque(np.array(angle), mount)) == pytest.approx(6 * slope, abs=2e-5)


def test_weight_pulls_down_by_attitude() -> None:
    def change(orientation_deg: float | None = None) -> np.ndarray:
        on = scene(("slow",), 2, orientation_deg=orientation_deg)
        return predicted("gravity", on, mass_g_per_m=80) - bare(on)

    hanging, standing = change(0), change(180)
    high = slice(20, 60)
    assert np.all(hanging[high] < 0), "hanging, it is held back"
    assert np.all(standing[high] > 0), "standing, the weight helps"
    assert np.all(np.abs(standing[high]) > np.abs(hanging[high])), "and the more, the farther it has bent"
    assert np.all(change(90)[:30] < 0), "bending upwards"
    assert np.all(change(-90)[:30] > 0), "bending downwards"
    assert np.array_equal(change(), hanging), "a model that is drawn hangs"


@pytest.mark.parametrize("orientation_deg", [0.0, 90.0, 180.0])
def test_weight_rests_where_the_energy_is_least(orientation_deg: float) -> None:
    """Of bending, B·(θ − θ0)²/2al, and of height, by quadrature: 80 g/m on 180 mm."""
    on = scene(("still",), 1, orientation_deg=orientation_deg)
    rest, length, weight = float(bare(on)[0, 0]), 180.0, 80e-6 * 9.81
    stiffness = float(on.curve("stiffness_Nmm2", on.pressure_MPa, {})[0, 0])

    def energy(angle_deg: float) -> float:
        theta, mount = np.radians(angle_deg), np.radians(orientation_deg)

        def fallen(r: float) -> float:
            return quad(lambda q: np.cos(mount + theta * q), 0, r)[0]

        return stiffness * np.radians(angle_deg - rest) ** 2 / (2 * length) - weight * length**2 * quad(fallen, 0, 1)[0]

    found = minimize_scalar(energy, bounds=(rest - 30, rest + 30), method="bounded", options={"xatol": 1e-6}).x
    assert predicted("gravity", on, mass_g_per_m=80)[0, 0] == pytest.approx(found, abs=2e-3)


def test_half_the_length_bends_an_eighth_where_it_lies_straight() -> None:
    """Half the weight at half the lever, over half the length to bend."""
    flat = base(1)
    still = {n: replace(d, curves={**d.curves, "angle_deg": np.zeros(36)}) for n, d in flat.designs.items()}
    short = {n: replace(d, shape=replace(d.shape, length_mm=90.0)) for n, d in still.items() if d.shape}

    def change(designs: dict[str, DesignBase]) -> np.ndarray:
        runs = scene(("slow",), 1, on=replace(flat, designs=designs), orientation_deg=90)
        return predicted("gravity", runs, mass_g_per_m=1.0)

    np.testing.assert_allclose(change(short), change(still) / 8, rtol=1e-4)


def test_a_leak_takes_its_share_and_an_orifice_more_of_small_pressures() -> None:
    on = scene(("slow",), 1)

    def share(form: str) -> np.ndarray:
        at = At(on, {"share": 0.1, "fall_per_min": 0.0}, form, on.pressure_MPa, on.pressure_MPa)
        return (1 - EFFECTS["leakage"].inside(on.pressure_MPa, at)[1:60, 0] / on.pressure_MPa[1:60, 0]).round(12)

    np.testing.assert_allclose(share("plain"), 0.1)
    orifice = share("orifice")
    assert orifice[-1] == pytest.approx(0.1, abs=0.01)
    assert np.all(np.diff(orifice) < 0)
    inside = on.pressure_MPa[1:60, 0] * (1 - orifice)
    np.testing.assert_allclose(inside + 0.1 * np.sqrt(0.35 * inside), on.pressure_MPa[1:60, 0])


def test_the_pressure_falls_in_a_hold_with_the_valve_shut_only() -> None:
    def inside(command: bool) -> np.ndarray:
        on = scene(("hold",), 1, command=command)
        at = At(on, {"share": 0.0, "fall_per_min": 1.0}, "plain", on.pressure_MPa, on.pressure_MPa)
        return EFFECTS["leakage"].inside(on.pressure_MPa, at)[:, 0]

    fed, shut, time = inside(True), inside(False), scene(("hold",), 1).time_s[:, 0]
    assert np.array_equal(fed, scene(("hold",), 1).pressure_MPa[:, 0])
    held = (time >= 5.2) & (time <= 25)
    np.testing.assert_allclose(np.diff(np.log(shut[held])), -0.2 / 60, rtol=1e-6)
    assert np.array_equal(shut[time < 4.8], fed[time < 4.8])
    assert np.array_equal(shut[time > 25.4], fed[time > 25.4])


def test_a_tilted_camera_sees_what_a_fitted_circle_sees() -> None:
    """Against a geometric fit by scipy, 21 markers, for angles up to 270°."""
    tilt = 15.0
    for across in (False, True):
        for angle in (20.0, 70.0, 130.0, 200.0, 270.0):
            along = np.radians(angle) * np.linspace(0, 1, 21)
            squeeze = np.cos(np.radians(tilt))
            x, z = 1 - np.cos(along), np.sin(along)
            x, z = (x * squeeze, z) if across else (x, z * squeeze)
            fit = least_squares(lambda c, x=x, z=z: np.hypot(x - c[0], z - c[1]) - c[2], [1.0, 0.0, 1.0])
            found = float(seen_over_true(np.array([angle]), tilt, across=across)[0])
            assert found == pytest.approx(1 / fit.x[2], rel=0.012), (across, angle)


def test_small_arcs_are_seen_as_closed_forms_say() -> None:
    squeeze = np.cos(np.radians(20.0))
    small = np.array([2.0])
    assert float(seen_over_true(small, 20.0, across=False)[0]) == pytest.approx(1 / squeeze**2, rel=1e-3)
    assert float(seen_over_true(small, 20.0, across=True)[0]) == pytest.approx(squeeze, rel=1e-3)


def test_a_circle_all_round_is_seen_alike_from_both_sides() -> None:
    full = np.array([360.0 * 10 / 11])  # the markers are then even around the circle
    along, across = (float(seen_over_true(full, 20.0, across=side)[0]) for side in (False, True))
    assert along == pytest.approx(across, rel=1e-9)


def test_tilt_turns_with_the_sign_of_the_angle() -> None:
    tilt = EFFECTS["camera_tilt"]
    on = scene(("slow",), 1)
    at = At(on, {"tilt_deg": 10.0}, "plain", on.pressure_MPa, on.pressure_MPa)
    angle = np.linspace(-100, 100, 21)[:, None]
    np.testing.assert_allclose(tilt.camera(angle, at), -tilt.camera(-angle, at))


def test_the_frame_takes_from_the_force_alone() -> None:
    on = scene(("slow",), 2)
    np.testing.assert_allclose(
        predicted("frame_compliance", on, quantity="force_N", share=0.2), 0.8 * bare(on, "force_N")
    )
    assert np.array_equal(predicted("frame_compliance", on, share=0.2), bare(on))
