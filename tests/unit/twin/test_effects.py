"""Each effect of the twin against its closed form, or against scipy's integrator where there is none."""

from __future__ import annotations

import math
from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchlab.errors import InputError
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.effects.catalogue import DEFAULT, EFFECTS, FAULTS
from benchlab.twin.effects.effect import Effect
from benchlab.twin.effects.leakage import Leakage
from benchlab.twin.effects.line_resistance import ATMOSPHERE_MPa, LineResistance
from benchlab.twin.plant import Plant
from benchlab.twin.settings import TwinSettings

P = np.linspace(0, 0.4, 41)
LINEAR = ResponseCurve(P, 300 * P, 20 + 10 * P, np.ones(41), "straight lines")
BULGING = replace(LINEAR, volume_mL=20 + 8 * P + 30 * P**2)
GAIN = 300.0


def on(*effects: Effect, curve: ResponseCurve = LINEAR) -> Plant:
    return Plant(TwinSettings(curve, {effect.name: effect for effect in effects}))


def make(name: str, **parameters: float) -> Effect:
    return EFFECTS[name](**parameters)


def driven(plant: Plant, times: np.ndarray, pressure: np.ndarray) -> dict[str, np.ndarray]:
    """States of a plant of which each pressure is asked for from its time on."""
    rows = []
    for t, p in zip(times.tolist(), pressure.tolist()):
        plant.advance(t)
        rows.append((plant.regulator_MPa, plant.pressure_MPa, plant.angle_deg, plant.felt_deg))
        plant.ask(p)
    return dict(zip(("regulator", "pressure", "angle", "felt"), np.array(rows).T))


def irregular(end: float, n: int = 300) -> np.ndarray:
    return np.concatenate([[0.0], np.sort(np.random.default_rng(3).uniform(0, end, n)), [end]])


def triangle(peaks: list[float], per_leg: int) -> np.ndarray:
    """From 0 through each of the values, in equal steps of which the first and last of a leg are exact."""
    legs = [np.linspace(a, b, per_leg + 1)[1:] for a, b in zip([0.0, *peaks], peaks)]
    return np.concatenate([[0.0], *legs])


def test_without_effects_the_angle_is_the_curve() -> None:
    plant = on()
    plant.ask(0.2)
    assert plant.angle_deg == pytest.approx(60.0, abs=1e-12)


def test_the_regulator_s_step_response() -> None:
    times = irregular(0.3)
    found = driven(on(make("regulator_lag", lag_s=0.04, deadband_MPa=0)), times, np.full(len(times), 0.3))
    assert found["pressure"] == pytest.approx(0.3 * (1 - np.exp(-times / 0.04)), abs=1e-13)


def test_the_regulator_s_dead_band_is_ignored_and_stays_behind() -> None:
    plant = on(make("regulator_lag", lag_s=0, deadband_MPa=0.002))
    found = []
    for p in (0.1, 0.0999, 0.097, 0.095, 0.1, 0.0):
        plant.ask(p)
        found.append(plant.pressure_MPa)
    assert found == pytest.approx([0.098, 0.098, 0.098, 0.097, 0.098, 0.0], abs=1e-15)


def test_line_lag_is_in_proportion_to_dV_dp() -> None:
    """Far into a slow ramp the pressure is behind by rate · R · dV/dp."""
    rate, resistance = 0.01, 0.004
    times = np.arange(0, 30, 0.01)
    for curve, slope in ((LINEAR, lambda p: 10.0 + 0 * p), (BULGING, lambda p: 8 + 60 * p)):
        asked = rate * times
        found = driven(on(make("line_resistance", resistance_MPa_s_per_mL=resistance), curve=curve), times, asked)
        behind = found["regulator"] - found["pressure"]
        for at in (1000, 2900):
            # Steps of rate · 0.01 s, held: the mean lies half a step below what was last asked for.
            assert behind[at] == pytest.approx(rate * resistance * slope(found["pressure"][at]), abs=rate * 0.006)
        grown = behind[2900] - behind[1000]
        expected = rate * resistance * (slope(found["pressure"][2900]) - slope(found["pressure"][1000]))
        assert grown == pytest.approx(expected, abs=0.02 * rate * resistance * 10)


@pytest.mark.parametrize("gas_share", [0.0, 1.0])
def test_filling_through_the_line_against_scipy(gas_share: float) -> None:
    """R·C(p)·dp/dt = 0.35 − p with C from an exact parabola."""
    effect = LineResistance(resistance_MPa_s_per_mL=0.01, gas_share=gas_share)

    def slope(_: float, p: np.ndarray) -> np.ndarray:
        compliance = 8 + 60 * p + gas_share * (20 + 8 * p + 30 * p**2) / (p + ATMOSPHERE_MPa)
        return (0.35 - p) / (0.01 * compliance)

    times = irregular(1.0, 100)
    exact = solve_ivp(slope, (0, 1), [0.0], t_eval=times, rtol=1e-10, atol=1e-12, method="LSODA").y[0]
    found = driven(on(effect, curve=BULGING), times, np.full(len(times), 0.35))
    assert found["pressure"] == pytest.approx(exact, abs=1.5e-4)


def test_leak_costs_its_share_and_decays_with_the_valve_shut() -> None:
    times = irregular(5.0)
    found = driven(on(Leakage(share=0.1, decay_s=3.0), make("supply_shut", at_s=1.0)), times, np.full(len(times), 0.2))
    assert found["pressure"][(times > 0) & (times < 1)] == pytest.approx(0.18, abs=1e-15)
    late = times > 1.1
    decay = 0.18 * np.exp(-(times[late] - times[late][0]) / 3.0)
    assert found["pressure"][late] / found["pressure"][late][0] == pytest.approx(decay / 0.18, rel=1e-12)
    assert found["pressure"][late][0] == pytest.approx(0.18 * math.exp(-(times[late][0] - 1) / 3), rel=0.003)


def test_creep_after_a_step_is_the_prony_series() -> None:
    effect = make("viscoelasticity", share_1=0.2, time_1_s=0.3, share_2=0.1, time_2_s=5.0)
    times = irregular(20.0)
    found = driven(on(effect), times, np.full(len(times), 0.2))
    exact = 60 * (1 - 0.2 * np.exp(-times / 0.3) - 0.1 * np.exp(-times / 5))
    assert found["angle"][1:] == pytest.approx(exact[1:], abs=1e-10)


@pytest.mark.parametrize("omega", [0.5, 2.0, 8.0])
def test_the_loop_of_a_sine_has_the_area_of_the_loss_compliance(omega: float) -> None:
    """∮θ dp = π·P·U·Σ a·ωτ/(1 + ω²τ²): widest where ωτ = 1, here ω = 2."""
    share, time_constant, amplitude = 0.3, 0.5, 0.1
    effect = make("viscoelasticity", share_1=share, time_1_s=time_constant, share_2=0.0, time_2_s=1.0)
    times = np.linspace(0, 6 * 2 * np.pi / omega, 6 * 4000 + 1)
    asked = 0.2 + amplitude * np.sin(omega * times)
    found = driven(on(effect), times, asked)
    p, angle = found["pressure"][-4001:], found["angle"][-4001:]
    area = -np.trapezoid(angle, p)
    exact = np.pi * amplitude * GAIN * amplitude * share * omega * time_constant / (1 + (omega * time_constant) ** 2)
    assert abs(area) == pytest.approx(exact, rel=0.01)


def test_the_loop_of_friction_is_twice_its_half_width_and_knows_no_rate() -> None:
    effect = make("friction", half_width_deg=0.5, half_width_deg_per_MPa=10)
    asked = triangle([0.35, 0.0, 0.35], 350)
    slow, fast = (driven(on(effect), np.arange(len(asked)) * dt, asked) for dt in (0.5, 0.001))
    assert np.array_equal(slow["angle"], fast["angle"])
    up, down = slow["angle"][1:352], slow["angle"][351:702][::-1]
    p = slow["pressure"][1:352]
    middle = (p > 0.05) & (p < 0.28)
    assert (down - up)[middle] == pytest.approx(2 * (0.5 + 10 * p[middle]), abs=1e-9)
    assert up[middle] == pytest.approx(GAIN * p[middle] - 0.5 - 10 * p[middle], abs=1e-9)


def test_second_loading_is_softer_and_joins_the_first_at_the_largest() -> None:
    asked = triangle([0.2, 0.0, 0.3], 300)
    plant = on(make("softening", softer=0.1, growth=0.0, cycles=1))
    found = driven(plant, np.arange(len(asked)) * 0.01, asked)
    p, angle = found["pressure"], found["angle"]
    u = GAIN * p
    first, again = np.arange(1, 302), np.arange(602, len(asked))
    assert angle[first] == pytest.approx(u[first], abs=1e-9)
    below = again[u[again] < 60 - 1e-9]
    assert angle[below] == pytest.approx(u[below] * (1 + 0.1 * (1 - u[below] / 60)), abs=1e-9)
    beyond = again[u[again] >= 60 + 1e-9]
    assert len(beyond) > 50 and angle[beyond] == pytest.approx(u[beyond], abs=1e-9)


def test_peaks_grow_from_cycle_to_cycle() -> None:
    asked = triangle([0.2, 0.0] * 6, 100)
    found = driven(on(make("softening", softer=0.1, growth=0.05, cycles=2)), np.arange(len(asked)) * 0.01, asked)
    peaks = found["angle"][101::200]
    assert peaks == pytest.approx([60 * (1 + 0.05 * (1 - math.exp(-n / 2))) for n in range(6)], abs=1e-9)


def test_small_effects_are_their_formulas() -> None:
    def angle(*effects: Effect, p: float = 0.2, time_s: float = 0.0) -> float:
        plant = on(*effects)
        plant.advance(time_s)
        plant.ask(p)
        return plant.angle_deg

    assert angle(make("end_caps", cap_mm=9)) == pytest.approx(60 * 0.9)
    assert angle(make("gravity", sag_deg=2, mount_deg=60)) == pytest.approx(58.0)
    assert angle(make("gravity", sag_deg=2, mount_deg=-30)) == pytest.approx(60.0)
    warm = make("temperature", per_K=0.01, rise_K=10, time_s=100)
    assert angle(warm, time_s=100) == pytest.approx(60 * (1 + 0.1 * (1 - 1 / math.e)))
    assert angle(make("dead_pressure", dead_MPa=0.05, smooth_MPa=0.0)) == pytest.approx(45.0)
    assert angle(make("dead_pressure", dead_MPa=0.05, smooth_MPa=0.0), p=0.04) == 0.0
    smooth = 300 * (0.15 + math.hypot(0.15, 0.02) + 0.05 - math.hypot(0.05, 0.02)) / 2
    assert angle(make("dead_pressure", dead_MPa=0.05, smooth_MPa=0.02)) == pytest.approx(smooth)

    plant = on(
        make("pressure_gain", gain=1.1), make("pressure_offset", offset_MPa=0.01), make("marker_offset", offset_mm=6)
    )
    assert plant.seen("monitor", 0.2) == pytest.approx(0.23)
    assert plant.seen("camera", 60.0) == pytest.approx(60 / (1 + math.radians(60) / 180 * 6))


def test_the_flex_sensor_s_own_loop_and_drift() -> None:
    asked = triangle([0.3, 0.0], 300)
    plant = on(make("flex_hysteresis", half_width_deg=2, drift_deg_per_min=6))
    times = np.arange(len(asked)) * 0.1
    found = driven(plant, times, asked)
    off = found["felt"] - found["angle"] - 0.1 * times
    assert off[50:300] == pytest.approx(-2, abs=1e-9) and off[400:] == pytest.approx(2, abs=1e-9)


def test_noise_is_quantised_averaged_and_without_bias() -> None:
    plant = on(make("sensor_noise", flex_sd_V=0.006, samples=16))
    step = 5 / 1024
    for volts in (1.2345, 3.0):
        read = np.array([plant.seen("flex_V", volts) for _ in range(20_000)])
        assert read.mean() == pytest.approx(volts, abs=1e-4)
        assert read.std() == pytest.approx(math.sqrt((0.006**2 + step**2 / 12) / 16), rel=0.03)
        assert (read * 16 / step) % 1 == pytest.approx(0, abs=1e-6)
    assert plant.seen("flex_V", 9.0) == pytest.approx(5 - step / 2) and plant.seen("flex_V", -1.0) == pytest.approx(
        step / 2
    )
    silent = on(make("sensor_noise", flex_sd_V=0, samples=16))
    assert abs(silent.seen("flex_V", 1.2345) - 1.2345) <= step / 2


@pytest.mark.parametrize("name", EFFECTS)
def test_each_effect_tells_its_numbers(name: str) -> None:
    kind = EFFECTS[name]
    page = __import__(kind.__module__, fromlist=["_"]).__doc__
    assert kind.name == name and name in page
    for each in fields(kind):
        meta = each.metadata
        assert meta["what"] and meta["low"] <= each.default <= meta["high"]
        assert f"`{each.name}`" in page or name in FAULTS, f"{name}: {each.name} is not in its docstring"
        for wrong in (meta["high"] + 1, meta["low"] - 1, math.nan):
            with pytest.raises(InputError, match=each.name):
                kind(**{each.name: wrong})


def test_what_is_on_by_default() -> None:
    assert set(DEFAULT) < set(EFFECTS) and not set(DEFAULT) & set(FAULTS)
    assert not {"softening", "leakage"} & set(DEFAULT)
